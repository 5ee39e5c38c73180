"""Seam: clicks along the limb where it is cut open, or left to the library."""

from __future__ import annotations

from typing import Any

from ... import edits, places
from .. import coin_nodes
from ..picking import Picker, Trace
from .panel import EditPanel


class SeamPanel(EditPanel):
    """The panel."""

    def __init__(self, brace: Any) -> None:
        super().__init__(brace, "Seam", "Seam")
        self.tell(
            "Click along the limb where it shall be cut open, from one edge of the brace to the "
            "other. Between two clicks the cut runs the short way over the surface."
        )
        self.said = self.tell("")
        self.button("Take back the last point", self.back)
        self.button("Begin another seam", self.another)
        self.button("Automatic: remove all seams", self.automatic)
        self._points: list[Any] = []
        self._trace = Trace(brace, coin_nodes.SEAM)
        self._picker = Picker(brace, self.add)
        self._say()

    def add(self, place: Any) -> None:
        """Takes a point."""
        self._points.append(place)
        self._changed()

    def back(self) -> None:
        """Takes the last point back."""
        if self._points:
            self._points.pop()
        self._changed()

    def another(self) -> None:
        """Keeps the seam and begins another."""
        self._keep()
        self._changed()

    def automatic(self) -> None:
        """Leaves the seam to the library."""
        self._points = []
        edits.clear_seams(self.brace)
        self._changed()

    def accept(self) -> bool:
        self._keep()
        return super().accept()

    def end(self) -> None:
        self._picker.end()
        self._trace.end()

    def _keep(self) -> None:
        # One point alone is no seam.
        if len(self._points) > 1:
            edits.add_seam(self.brace, self._points)
        self._points = []

    def _changed(self) -> None:
        self._trace.show(self._points)
        self._say()

    def _say(self) -> None:
        there = len(places.seams(self.brace))
        seams = (
            f"{there} seam{'s' if there > 1 else ''} drawn." if there else "The seam is automatic."
        )
        points = f" {len(self._points)} point{'s' if len(self._points) != 1 else ''} of a new one."
        self.said.setText(seams + (points if self._points else ""))
