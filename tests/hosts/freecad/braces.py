"""A brace on the prism, and what must hold of a right and of an invalid one."""

from __future__ import annotations

import FreeCAD
import limbs
import wovenfit_freecad as tools
from harness import close

STRAIN = 2e-3 * limbs.RADIUS / 0.5
"""Laplace's law for 2 kPa, 0.5 N/mm and the prism's radius."""


def on_prism(pressure: str = "2 kPa"):
    """A brace on the prism, recomputed."""
    document = FreeCAD.newDocument("Checks")
    scan = limbs.add_mesh(document, limbs.prism())
    brace = tools.new_brace(document, scan)
    tools.add_pressure(brace, limbs.on_prism(2.0, 45.0), pressure)
    document.recompute()
    return document, brace, document.Pattern, document.Worn


def is_nothing(pattern, worn) -> None:
    """Demands that no result is shown, and that this is marked."""
    # A cross of two lines of 20 mm stands for no pattern, on drawings of it, too.
    assert [edge.Length for edge in pattern.Shape.Edges] == [20.0, 20.0], "an old pattern is shown"
    assert worn.Mesh.CountFacets == 0, "an old worn surface is shown"
    assert "Invalid" in pattern.State and not pattern.isValid(), pattern.State
    assert "Invalid" in worn.State, worn.State


def is_right(document, brace, strain: float) -> None:
    """Demands a valid brace as wide as the girth over one plus the strain."""
    assert brace.State == ["Up-to-date"], (brace.State, brace.getStatusString())
    box = document.Pattern.Shape.BoundBox
    close(box.XLength, limbs.girth() / (1 + strain), 0.01 * limbs.girth())
    close(brace.Width.Value, box.XLength, 1e-6)
    close(brace.Height.Value, box.YLength, 1e-6)
