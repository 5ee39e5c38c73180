"""Region: two clicks between which the brace lies, as planes that can be moved afterwards."""

from __future__ import annotations

from typing import Any

from ... import edits
from .. import coin_nodes
from ..picking import Picker, Trace
from .panel import EditPanel


class RegionPanel(EditPanel):
    """The panel."""

    def __init__(self, brace: Any) -> None:
        super().__init__(brace, "Region", "Region")
        self.tell(
            "Click where the brace begins and where it ends. Each becomes a plane that faces the "
            "other; move and turn the planes as any object. The brace lies on the side to which "
            "their z axes point."
        )
        self.said = self.tell("")
        self.button("All of the limb: remove all planes", self.whole)
        self._places: list[Any] = []
        self._trace = Trace(brace, coin_nodes.INK)
        self._picker = Picker(brace, self.add)
        self._say()

    def add(self, place: Any) -> None:
        """Takes a place; the second makes the planes."""
        self._places.append(place)
        self._trace.show(self._places)
        if len(self._places) == 2:
            edits.add_region_between(self.brace, *self._places)
            self._places = []
        self._say()

    def whole(self) -> None:
        """Takes the planes away."""
        edits.clear_region(self.brace)
        self._places = []
        self._trace.show([])
        self._say()

    def end(self) -> None:
        self._picker.end()
        self._trace.end()

    def _say(self) -> None:
        if self._places:
            self.said.setText("Now where it ends.")
        else:
            count = len(self.brace.RegionPlanes)
            self.said.setText(f"{count} planes." if count else "The whole limb is covered.")
