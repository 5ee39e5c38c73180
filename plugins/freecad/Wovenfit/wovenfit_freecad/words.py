"""Texts of the library in the words of FreeCAD: names of properties instead of keys of a file."""

from __future__ import annotations

import re
from typing import Any

from . import places, properties

_FIXED = (
    (r'write "mmhg": ([\d.]+)', r"write \1 Torr"),
    (
        r"the coordinates are probably in (\w+); set `units` to `\w+`",
        r"the scan is probably in \1, and FreeCAD took its numbers for mm: scale the mesh to mm "
        r"(Meshes > Scale)",
    ),
    (
        r"set `units` to its unit, for example `\w+`",
        r"scale the mesh to mm (Meshes > Scale)",
    ),
    (r"\bregion_faces\b", "RegionFacets"),
    (r"`region\b", "`RegionPlanes"),
    (r"`orientation\b", "`Orientation"),
    (r"\blimits\.bony\b", "BonyPlaces"),
)
"""Patterns and what they become; a text that none of them fits stays as it is."""


def in_words_of_the_host(obj: Any, text: str) -> str:
    """A text of the library about a brace with the names that FreeCAD shows."""
    for pattern, words in _FIXED:
        text = re.sub(pattern, words, text)
    for row in properties.parameters():
        hyphens = row.key.replace("_", "-")
        text = text.replace(f"`{row.key}`", f"`{row.name}`").replace(
            f"`{hyphens}`", f"`{row.name}`"
        )
        if "-" in hyphens:
            text = re.sub(rf"(?<![\w-])(?:--)?{hyphens}(?![\w-])", row.name, text)
    for row in properties.wishes():
        if "." in row.key:
            text = re.sub(rf"(?<![\w.]){re.escape(row.key)}(?![\w.])", row.name, text)
        else:
            text = text.replace(f"`{row.key}`", f"`{row.name}`")
    return _numbered(obj, text)


def _numbered(obj: Any, text: str) -> str:
    """Names pressures and seams: the library counts them in their order, and the numbers of a
    brace's properties have gaps where one was removed."""
    seams = dict(enumerate(places.seams(obj)))
    text = re.sub(r"\bseams\[(\d+)\]", lambda m: f"Seam{seams.get(int(m[1]), m[1])}", text)
    try:
        numbers = dict(enumerate(places.pressures(obj)))
    except ValueError:
        return text
    text = re.sub(
        r"pressures\[(\d+)\]\.(kpa|at)",
        lambda m: (
            ("PressurePlace" if m[2] == "at" else "Pressure") + str(numbers.get(int(m[1]), m[1]))
        ),
        text,
    )
    # From 1 here. What is followed by a unit is a value.
    return re.sub(
        r"\b[Pp]ressures? (\d+(?:(?:, | and )\d+)*)(?![\d.]*\d| ?(?:kPa|mmHg))",
        lambda m: re.sub(r"\d+", lambda k: f"Pressure{numbers.get(int(k[0]) - 1, k[0])}", m[1]),
        text,
    )
