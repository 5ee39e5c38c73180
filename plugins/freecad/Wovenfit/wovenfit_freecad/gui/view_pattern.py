"""The view of a pattern."""

from __future__ import annotations

from typing import Any

from ..scripted import Scripted
from .resources import icon


class PatternView(Scripted):
    """The proxy of a pattern's view provider."""

    attached = False

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self
        vobj.LineWidth = 2.0
        vobj.LineColor = (0.0, 0.0, 0.0)
        # Every corner of the outline would be a dot.
        vobj.PointSize = 1.0

    def attach(self, vobj: Any) -> None:
        """Called when the view comes to be."""
        self.attached = True

    def updateData(self, obj: Any, name: str) -> None:
        """A property has changed: FreeCAD draws the wires itself."""

    def getIcon(self) -> str:
        return icon("Pattern")
