"""A TechDraw page that shows the pattern at 1:1."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD

SHEETS = {
    "A4": (297.0, 210.0),
    "A3": (420.0, 297.0),
    "A2": (594.0, 420.0),
    "A1": (841.0, 594.0),
    "A0": (1189.0, 841.0),
}
"""Sheets from small to large, with their sides in mm (ISO 216)."""

MARGIN = 15.0
"""Kept free on every side, in mm."""


def make_page(pattern: Any) -> Any:
    """Makes a page at 1:1 on the smallest sheet that holds the pattern.

    Args:
        pattern: a pattern's object.

    Raises:
        ValueError: if it is empty, or larger than the largest sheet.
    """
    if not pattern.isValid() or not pattern.ShownFor:
        raise ValueError(f"{pattern.Label} is invalid or empty: recompute the brace first")
    box = pattern.Shape.BoundBox
    found = _sheet_for(box.XLength + 2 * MARGIN, box.YLength + 2 * MARGIN)
    if found is None:
        raise ValueError(
            f"{pattern.Label} is {box.XLength:.0f} mm by {box.YLength:.0f} mm: no sheet up to "
            f"{list(SHEETS)[-1]} holds it at 1:1. Export it, and print the "
            "tiles of pattern-a4.pdf"
        )
    template, turned = found
    document = pattern.Document
    page = document.addObject("TechDraw::DrawPage", "PatternPage")
    page.Label = f"{pattern.Label} 1:1"
    sheet = document.addObject("TechDraw::DrawSVGTemplate", "Sheet")
    sheet.Template = template
    page.Template = sheet
    page.Scale = 1.0
    page.KeepUpdated = True
    view = document.addObject("TechDraw::DrawViewPart", "PatternView")
    page.addView(view)
    view.Source = [pattern]
    view.Direction = FreeCAD.Vector(0, 0, 1)
    view.XDirection = FreeCAD.Vector(1, 0, 0)
    view.ScaleType = "Custom"
    view.Scale = 1.0
    view.Rotation = 90 if turned else 0
    view.X, view.Y = sheet.Width / 2, sheet.Height / 2
    if hasattr(view, "Caption"):
        view.Caption = f"{pattern.Label}, 1:1 in mm, print at 100 %"
    return page


def _sheet_for(width: float, height: float) -> tuple[str, bool] | None:
    """TechDraw's empty template of the smallest sheet for an area in mm, and whether the area must
    be turned on it."""
    blank = _blank_templates()
    for sheet, (long, short) in SHEETS.items():
        upright, across = (
            blank.get(f"{sheet}_{way}_blank.svg") for way in ("Portrait", "Landscape")
        )
        if across and width <= long and height <= short:
            return across, False
        if upright and width <= short and height <= long:
            return upright, False
        if across and width <= short and height <= long:
            return across, True
    return None


def _blank_templates() -> dict[str, str]:
    """The empty templates by their names; the folder below differs between versions of FreeCAD."""
    templates = os.path.join(FreeCAD.getResourceDir(), "Mod", "TechDraw", "Templates")
    return {
        name: os.path.join(folder, name)
        for folder, _, names in sorted(os.walk(templates))
        for name in names
        if name.endswith("_blank.svg")
    }
