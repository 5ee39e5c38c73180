"""How a reason is shown to the designer."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtGui


def complain(title: str, text: str) -> None:
    """Shows why something cannot be done."""
    FreeCAD.Console.PrintError(f"{title}: {text}\n")
    QtGui.QMessageBox.warning(FreeCADGui.getMainWindow(), title, text)


def complain_if_invalid(title: str, brace: Any) -> None:
    """Shows why a brace has no pattern, if it has none."""
    if not brace.isValid():
        complain(title, f"{brace.Label} has no pattern: {brace.getStatusString()}")
