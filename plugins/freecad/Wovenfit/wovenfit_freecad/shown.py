"""What the objects that show a brace's result have in common."""

from __future__ import annotations

from typing import Any

import wovenfit

from . import looks
from .brace import is_brace
from .scripted import HIDDEN, OUTPUT, READ_ONLY, Scripted, ensure


class Shown(Scripted):
    """The proxy of what shows a brace's result: empty and invalid when the brace is."""

    def __init__(self, obj: Any, brace: Any) -> None:
        obj.Proxy = self
        self.add_properties(obj)
        obj.Brace = brace

    def add_properties(self, obj: Any) -> None:
        """Adds the properties that the object lacks."""
        ensure(obj, "App::PropertyLink", "Brace", "Brace", "The brace that this shows.")
        secret = READ_ONLY | OUTPUT | HIDDEN
        ensure(obj, "App::PropertyString", "ShownFor", "Brace", "What is shown.", secret)

    def onDocumentRestored(self, obj: Any) -> None:
        """After opening or pasting."""
        self.add_properties(obj)
        looks.opened(obj)

    def execute(self, obj: Any) -> None:
        """Shows the brace's result.

        Raises:
            RuntimeError: if there is none, with the reason.
        """
        brace = obj.Brace
        try:
            if brace is None or not is_brace(brace):
                raise RuntimeError("no Brace: this shows the result of one")
            wanted = f"{brace.ComputedFor} {self.options(obj)}"
            if brace.ComputedFor and obj.ShownFor == wanted:
                return
            self.show(obj, brace.Proxy.recomputed(brace))
            obj.ShownFor = wanted
        except Exception:
            obj.ShownFor = ""
            self.empty(obj)
            raise

    def options(self, obj: Any) -> str:
        """The object's own properties on which what it shows depends, as a text."""
        raise NotImplementedError

    def show(self, obj: Any, pattern: wovenfit.Pattern) -> None:
        """Shows a pattern."""
        raise NotImplementedError

    def empty(self, obj: Any) -> None:
        """Shows nothing."""
        raise NotImplementedError
