"""What is kept with the limb of a check and of a pattern: plain data that survives in a file."""

from __future__ import annotations

import json
import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from .wording import in_host_words

if TYPE_CHECKING:
    from ..wovenfit import Check, Note, Pattern

    Record = dict[str, Any]

GIRTHS_SHOWN = 14
"""Girths that are listed; in a wrong unit a limb has thousands."""


def of_check(check: Check) -> Record:
    """What is found on the surface. Lengths in mm."""
    report = check.report
    kept = {
        key: report[key]
        for key in ("shape", "unit", "vertices", "triangles", "size_mm", "area_mm2", "length_mm")
        if key in report
    }
    girths = report.get("girths") or []
    kept["girths"] = [[one["at_mm"], one["girth_mm"]] for one in girths[:GIRTHS_SHOWN]]
    kept["more_girths"] = max(0, len(girths) - GIRTHS_SHOWN)
    kept["openings"] = [one["length_mm"] for one in report.get("loops") or []]
    kept["warnings"] = [_note(note) for note in check.warnings]
    kept["defects"] = [_note(note) for note in check.defects]
    return kept


def of_pattern(pattern: Pattern, remarks: list[str], unit: float) -> Record:
    """The figures, warnings and table of a pattern, beginning with our own remarks.

    `unit` is the millimetres in one unit of the flat mesh.
    """
    figures = pattern.figures
    return {
        "unit_mm": unit,
        "width_mm": figures.width_mm,
        "height_mm": figures.height_mm,
        "area_mm2": figures.area_mm2,
        "curvature_radius_mm": figures.curvature_radius_mm,
        "converged": figures.converged,
        "steps": figures.steps,
        "warnings": [
            *({"message": text, "at": None, "code": "addon"} for text in remarks),
            *(_note(note) for note in pattern.warnings),
        ],
        "seams": [[seam.left_mm, seam.right_mm] for seam in pattern.seams],
        # Where the sides of each seam have their middle, to write its number there.
        "seam_middles": [
            [list(pattern.coordinates[side[len(side) // 2]]) for side in (seam.left, seam.right)]
            for seam in pattern.seams
        ],
        "pressures": [
            {
                "at": list(row.at),
                "asked_kpa": _known(row.asked_kpa),
                "got_kpa": _known(row.got_kpa),
                "warp_strain": _known(row.warp_strain),
                "met": row.met,
                "reason": None if row.reason is None else _note(row.reason)["message"],
            }
            for row in pattern.pressures
        ],
    }


def written(record: Record) -> str:
    """The record as text."""
    return json.dumps(record, allow_nan=False)


@lru_cache(maxsize=32)
def read(text: str) -> Record:
    """A record from its text; not to be changed. Panels ask at every redraw."""
    record: Record = json.loads(text)
    return record


def _note(note: Note) -> Record:
    at = None if note.at is None else list(note.at)
    return {"code": note.code, "message": in_host_words(note.message), "at": at}


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value
