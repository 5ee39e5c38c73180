"""A TechDraw page at 1:1."""

from __future__ import annotations

from typing import Any

import FreeCADGui
from PySide import QtCore

from ...brace import children
from ...page import make_page
from ...pattern import Pattern
from ...scripted import is_scripted
from .command import Command

SHOWN_MS = 300
"""Until the window of a page has its size."""


class Page(Command):
    """Makes the page as one step of undo and opens it."""

    name = "Wovenfit_Page"
    picture = "Page"
    text = "Page at 1:1"
    tip = "Make a TechDraw page that shows the pattern at true size"

    def run(self, brace: Any) -> None:
        pattern = next((c for c in children(brace) if is_scripted(c, Pattern)), None)
        if pattern is None:
            raise ValueError(f"{brace.Label} has no pattern: use Flatten first")
        document = brace.Document
        document.openTransaction("Page at 1:1")
        try:
            page = make_page(pattern)
        except Exception:
            document.abortTransaction()
            raise
        document.recompute()
        document.commitTransaction()
        page.ViewObject.show()
        # The sheet as a whole, when its window stands.
        QtCore.QTimer.singleShot(SHOWN_MS, lambda: FreeCADGui.SendMsgToActiveView("ViewFit"))
