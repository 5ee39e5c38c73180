"""Add pressure."""

from __future__ import annotations

from typing import Any

from ..panels.panel import show
from ..panels.pressures import PressuresPanel
from .command import Command


class AddPressure(Command):
    """Opens the panel with the table of pressures."""

    name = "Wovenfit_AddPressure"
    picture = "AddPressure"
    text = "Add pressure"
    tip = "Click on the limb where the brace shall press, and type how much"

    def run(self, brace: Any) -> None:
        show(PressuresPanel(brace))
