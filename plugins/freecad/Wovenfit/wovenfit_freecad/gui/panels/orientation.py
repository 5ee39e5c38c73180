"""Orientation: two clicks that stand above each other in the pattern."""

from __future__ import annotations

from typing import Any

from ... import edits
from .. import coin_nodes
from ..picking import Picker, Trace
from .panel import EditPanel


class OrientationPanel(EditPanel):
    """The panel."""

    def __init__(self, brace: Any) -> None:
        super().__init__(brace, "Orientation", "Orientation")
        self.tell(
            "Click two places on the limb, the first near the body. In the pattern they stand "
            "above each other: the direction of the weft."
        )
        self.said = self.tell("")
        self.button("Automatic: along the limb", self.automatic)
        self._places: list[Any] = []
        self._trace = Trace(brace, coin_nodes.WEFT)
        self._picker = Picker(brace, self.add)
        self._say()

    def add(self, place: Any) -> None:
        """Takes a place; a third begins anew."""
        self._places = [place] if len(self._places) == 2 else [*self._places, place]
        self._trace.show(self._places)
        if len(self._places) == 2:
            edits.set_orientation(self.brace, *self._places)
        self._say()

    def automatic(self) -> None:
        """Leaves it to the limb."""
        self._places = []
        self._trace.show([])
        edits.clear_orientation(self.brace)
        self._say()

    def end(self) -> None:
        self._picker.end()
        self._trace.end()

    def _say(self) -> None:
        if len(self._places) == 1:
            self.said.setText("Now the place away from the body.")
        else:
            chosen = len(self.brace.Orientation) == 2
            self.said.setText("Two places are chosen." if chosen else "Automatic.")
