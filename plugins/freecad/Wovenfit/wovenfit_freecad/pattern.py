"""The pattern as wires in the XY plane, in mm, x along warp and y along weft."""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
import numpy.typing as npt
import Part
import wovenfit

from .scripted import ensure
from .shown import Shown

CROSS = 3.0
"""Half the size of a mark, in mm."""


NO_PATTERN = 10.0
"""Half the size of the cross that stands for a pattern that is not there, in mm."""


class Pattern(Shown):
    """The proxy of the pattern's feature.

    Its shape is a compound: the outline's closed wire, a closed wire for each cut-out, then, if
    wanted, the two sides of every seam, which are made of the outline's own edges, and the marks.
    """

    def add_properties(self, obj: Any) -> None:
        super().add_properties(obj)
        for name, text in (
            (
                "Seams",
                "Whether the seams' sides are wires of their own; their edges are the outline's.",
            ),
            (
                "Marks",
                "Whether crosses stand where pressures are wanted, and an arrow along the weft.",
            ),
        ):
            if ensure(obj, "App::PropertyBool", name, "Pattern", text):
                setattr(obj, name, True)

    def options(self, obj: Any) -> str:
        return f"{obj.Seams} {obj.Marks}"

    def show(self, obj: Any, pattern: wovenfit.Pattern) -> None:
        placement = obj.Placement
        obj.Shape = compound(pattern, seams=obj.Seams, marks=obj.Marks)
        # It may be moved on the table.
        obj.Placement = placement

    def empty(self, obj: Any) -> None:
        placement = obj.Placement
        # Not nothing: TechDraw keeps the earlier drawing of a shape that is gone.
        obj.Shape = Part.Compound(_cross(np.zeros(2), NO_PATTERN))
        obj.Placement = placement


def compound(pattern: wovenfit.Pattern, *, seams: bool, marks: bool) -> Any:
    """The wires of a pattern."""
    wires, edges = [], {}
    for loop, vertices in zip(pattern.outlines, pattern.outline_vertices):
        wire = _closed(loop)
        wires.append(wire)
        for k, edge in enumerate(wire.OrderedEdges):
            ends = int(vertices[k]), int(vertices[(k + 1) % len(vertices)])
            edges[frozenset(ends)] = edge
    if seams:
        for seam in pattern.seams:
            for side in (seam.left, seam.right):
                pairs = [frozenset(map(int, pair)) for pair in zip(side[:-1], side[1:])]
                wires.append(Part.Wire([edges[pair] for pair in pairs]))
    if marks:
        for point in pattern.pressure_points:
            wires += _cross(point)
        wires.append(_arrow(*pattern.orientation_markers))
    return Part.Compound(wires)


def _closed(points: npt.NDArray[np.float64]) -> Any:
    corners = [FreeCAD.Vector(x, y, 0) for x, y in points]
    return Part.Wire([Part.makeLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])])


def _cross(point: npt.NDArray[np.float64], size: float = CROSS) -> list[Any]:
    """Two lines of twice `size` mm that cross at a point."""
    x, y = point
    return [
        Part.makePolygon([FreeCAD.Vector(x - dx, y - dy, 0), FreeCAD.Vector(x + dx, y + dy, 0)])
        for dx, dy in ((size, 0), (0, size))
    ]


def _arrow(first: npt.NDArray[np.float64], second: npt.NDArray[np.float64]) -> Any:
    """From the marker away from the body to the one near it."""
    tip, tail = FreeCAD.Vector(*first, 0), FreeCAD.Vector(*second, 0)
    along = (tip - tail).normalize() * CROSS
    across = FreeCAD.Vector(-along.y, along.x, 0) * 0.5
    back = tip - along
    return Part.makePolygon([tail, tip, back + across, tip, back - across])
