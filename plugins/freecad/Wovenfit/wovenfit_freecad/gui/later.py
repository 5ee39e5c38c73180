"""Recomputes a document a moment later, when what changed it has ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
from PySide import QtCore

from .. import watching
from ..brace import is_brace

_waiting: set[str] = set()


def begin() -> None:
    """A replaced source and an undone change recompute the document from now on."""
    watching.after = _soon
    watching.begin()


def _soon(document: Any) -> None:
    name = document.Name
    if name not in _waiting:
        _waiting.add(name)
        QtCore.QTimer.singleShot(0, lambda: _now(name))


def dress_soon(obj: Any) -> None:
    """Gives an object its view when it is opened wholly and still has none."""
    _soon_on(obj, lambda there: there.ViewObject.Proxy in (0, 1, None) and _dress(there))


def redraw_soon(brace: Any) -> None:
    """Draws the wishes of a brace anew, when the change is complete."""
    _soon_on(brace, lambda there: there.ViewObject.Proxy.redraw(there))


def recolour_soon(worn: Any) -> None:
    """Shows the colours of a worn surface, when it is there wholly."""
    _soon_on(worn, lambda there: there.ViewObject.Proxy.recolour(there))


def _soon_on(obj: Any, do: Callable[[Any], Any]) -> None:
    document, name = obj.Document.Name, obj.Name

    def now() -> None:
        # Both may be gone by then.
        there = document in FreeCAD.listDocuments() and FreeCAD.getDocument(document).getObject(
            name
        )
        if there:
            do(there)

    QtCore.QTimer.singleShot(0, now)


def _dress(obj: Any) -> None:
    from .views import dress

    dress(obj)


def _now(name: str) -> None:
    _waiting.discard(name)
    document = FreeCAD.listDocuments().get(name)
    if document is None or document.Restoring or document.Recomputing:
        return
    if any(is_brace(obj) and obj.Automatic for obj in document.Objects):
        document.recompute()
