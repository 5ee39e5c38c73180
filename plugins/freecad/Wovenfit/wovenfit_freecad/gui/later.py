"""Recomputes a document a moment later, when what changed it has ended."""

from __future__ import annotations

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


def _now(name: str) -> None:
    _waiting.discard(name)
    document = FreeCAD.listDocuments().get(name)
    if document is None:
        return
    if any(is_brace(obj) and obj.Automatic for obj in document.Objects):
        document.recompute()
