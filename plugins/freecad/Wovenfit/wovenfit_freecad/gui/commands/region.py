"""Region."""

from __future__ import annotations

from typing import Any

from ..panels.panel import show
from ..panels.region import RegionPanel
from .command import Command


class Region(Command):
    """Opens the panel for the region."""

    name = "Wovenfit_Region"
    picture = "Region"
    text = "Region"
    tip = "Click where the brace begins and where it ends on the limb"

    def run(self, brace: Any) -> None:
        show(RegionPanel(brace))
