"""What the task panels share."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from ..resources import icon
from ..telling import complain_if_invalid


def only_close() -> int:
    """The standard button of a panel that changes nothing when it is closed."""
    button = QtGui.QDialogButtonBox.Close
    # A number in Qt 5, an enumeration in Qt 6.
    return int(getattr(button, "value", button))


def show(panel: Any) -> Any:
    """Opens a task panel, if no other is open; whether it was."""
    if FreeCADGui.Control.activeDialog():
        FreeCAD.Console.PrintWarning("wovenfit: close the open task panel first\n")
        return False
    FreeCADGui.Control.showDialog(panel)
    _widen(panel.form)
    return True


def _widen(form: Any) -> None:
    """Makes the dock of a panel wide enough, if it is not."""
    dock = form.parent()
    while dock is not None and not isinstance(dock, QtGui.QDockWidget):
        dock = dock.parent()
    if dock is not None and dock.width() < WIDTH:
        FreeCADGui.getMainWindow().resizeDocks([dock], [WIDTH], QtCore.Qt.Horizontal)


WIDTH = 390
"""Least width of a panel in pixels; below it columns of a table are cut."""


class EditPanel:
    """A panel whose changes of a brace are one step of undo: OK keeps them, Cancel takes them back.

    Args:
        brace: that is changed.
        title: of the panel, and of the step in the list of undo.
        picture: name of the icon.
    """

    def __init__(self, brace: Any, title: str, picture: str) -> None:
        self.brace = brace
        self._title = title
        self._document = brace.Document
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(f"{title}: {brace.Label}")
        self.form.setWindowIcon(QtGui.QIcon(icon(picture)))
        self.column = QtGui.QVBoxLayout(self.form)
        self._document.openTransaction(title)

    def tell(self, text: str) -> Any:
        """A paragraph."""
        words = QtGui.QLabel(text)
        words.setWordWrap(True)
        self.column.addWidget(words)
        return words

    def button(self, text: str, pressed: Any) -> Any:
        """A button."""
        made = QtGui.QPushButton(text)
        made.setAutoDefault(False)
        made.clicked.connect(lambda *_: pressed())
        self.column.addWidget(made)
        return made

    def end(self) -> None:
        """Ends what listens to the view."""

    def accept(self) -> bool:
        """OK."""
        self.end()
        FreeCADGui.Control.closeDialog()
        self._document.recompute()
        self._document.commitTransaction()
        complain_if_invalid(self._title, self.brace)
        return True

    def reject(self) -> bool:
        """Cancel, Esc."""
        self.end()
        FreeCADGui.Control.closeDialog()
        self._document.abortTransaction()
        return True
