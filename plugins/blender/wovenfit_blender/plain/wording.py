"""Words for a narrow panel: numbers with units, wrapped lines, the host's names of things."""

from __future__ import annotations

import re
import textwrap

from ..wovenfit import KPA_PER_MMHG, JobStage
from .fields import design_fields, parameter_fields

MMHG, KPA = "mmHg", "kPa"

STAGES = {
    JobStage.WAITING: "Waiting",
    JobStage.SURFACE: "Checking the surface",
    JobStage.REGION: "Keeping the region",
    JobStage.CUT: "Cutting it open",
    JobStage.PARAMETERIZATION: "Laying it flat",
    JobStage.CURVATURE: "Reading curvature",
    JobStage.FIT: "Fitting the fabric",
    JobStage.MAPPING: "Mapping the fabric",
    JobStage.REPORT: "Judging the pattern",
}
"""What a stage does, for the progress bar."""


def mmhg(kpa: float) -> float:
    """Pressure in mmHg."""
    return kpa / KPA_PER_MMHG


def pressure(kpa: float | None, unit: str) -> str:
    """A pressure with its unit; a dash for one that is not known."""
    if kpa is None:
        return "–"
    return f"{mmhg(kpa):.1f} mmHg" if unit == MMHG else f"{kpa:.2f} kPa"


def percent(strain: float | None) -> str:
    """A strain in per cent."""
    return "–" if strain is None else f"{100 * strain:.1f} %"


def millimetres(length: float) -> str:
    """A length with its unit."""
    return f"{length:.1f} mm"


def wrapped(text: str, width: int) -> list[str]:
    """Lines of at most so many characters; line breaks of the text stay."""
    lines = []
    for line in text.splitlines():
        lines += textwrap.wrap(line, max(width, 20)) or [""]
    return lines


_REMEDIES = (
    ("give `orientation`", "set the orientation by two vertices"),
    ("draw a seam", "mark another chain of edges as seam"),
    (
        "give two region planes, one across the limb at each end of the brace",
        "select the faces between the two ends of the brace and switch on Selected faces only, or "
        "delete what lies beyond its ends",
    ),
    (
        "the design must give a region, two planes across the limb between which the brace lies",
        "select the faces between the two ends of the brace and switch on Selected faces only, or "
        "delete what lies beyond its ends",
    ),
    ("by region planes", "by Selected faces only"),
)
"""What the library advises that has another name here, or is done another way."""


def first_clause(text: str) -> str:
    """What a note says before it says where and what to do."""
    return re.split(r": |; ", text, maxsplit=1)[0]


def in_host_words(text: str) -> str:
    """The library's text, with the panels' names where it names options and keys of files."""
    text = re.sub(r"set `units` to its unit, for example `([a-z]+)`", r"set Units to \1", text)
    text = re.sub(
        r"set (?:`units`|Units) to `?([a-z]+)`?", r"set Units to \1 in the panel Surface", text
    )
    text = re.sub(
        r"`?pressures\[(\d+)\](\.kpa)?`?", lambda match: f"pressure {int(match[1]) + 1}", text
    )
    text = re.sub(r" Then write \"mmhg\": [0-9.]+;", " Then set it in mmHg;", text)
    for theirs, ours in _REMEDIES:
        text = text.replace(theirs, ours)
    return re.sub(r"`(?:--)?([a-z][a-z_.-]+)`|\b([a-z]+\.[a-z_]+)\b", _place_of, text)


def _place_of(match: re.Match[str]) -> str:
    """Where a setting or a wish stands in the panels; other words stay as they are."""
    name = (match[1] or match[2]).replace("-", "_")
    for fields, panel in ((parameter_fields(), "Settings"), (design_fields(), "Piece and Limits")):
        for field in fields:
            if field.name == name:
                panel = "the panel Fabric" if field.section == "fabric" else panel
                return f"{field.label.partition(' (')[0]} in {panel}"
    return match[0]
