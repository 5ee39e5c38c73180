"""Seam."""

from __future__ import annotations

from typing import Any

from ..panels.panel import show
from ..panels.seam import SeamPanel
from .command import Command


class Seam(Command):
    """Opens the panel for seams."""

    name = "Wovenfit_Seam"
    picture = "Seam"
    text = "Seam"
    tip = "Click along the limb where it is cut open, or leave it to the program"

    def run(self, brace: Any) -> None:
        show(SeamPanel(brace))
