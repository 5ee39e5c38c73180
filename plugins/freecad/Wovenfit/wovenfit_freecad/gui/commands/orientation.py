"""Orientation."""

from __future__ import annotations

from typing import Any

from ..panels.orientation import OrientationPanel
from ..panels.panel import show
from .command import Command


class Orientation(Command):
    """Opens the panel for the weft direction."""

    name = "Wovenfit_Orientation"
    picture = "Orientation"
    text = "Orientation"
    tip = "Click two places that stand above each other in the pattern: the weft direction"

    def run(self, brace: Any) -> None:
        show(OrientationPanel(brace))
