"""Flatten."""

from __future__ import annotations

from typing import Any

from ..panels.flatten import FlattenPanel
from ..panels.panel import show
from .command import Command


class Flatten(Command):
    """Opens the panel with parameters, progress and cancel."""

    name = "Wovenfit_Flatten"
    picture = "Flatten"
    text = "Flatten"
    tip = "Compute the pattern, with every parameter at hand, progress and cancel"

    def run(self, brace: Any) -> None:
        show(FlattenPanel(brace))
