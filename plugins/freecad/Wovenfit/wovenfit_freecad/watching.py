"""Sees what FreeCAD does not tell a brace: that its source's mesh was replaced, or a wish removed.

In a window, `after` is set to what recomputes the document a moment later.
"""

from __future__ import annotations

from typing import Any, Callable

import FreeCAD

from . import looks

after: Callable[[Any], None] | None = None
"""Called with a document whose brace has become out of date."""


class _Watcher:
    """An observer of all documents."""

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """A property has changed."""
        # While a document is opened, everything in it changes.
        if name != "Mesh" or obj.Document.Restoring:
            return
        from .brace import is_brace

        for brace in obj.InList:
            if is_brace(brace):
                brace.touch()
                if after is not None:
                    after(brace.Document)

    def slotAppendDynamicProperty(self, obj: Any, name: str) -> None:
        """A property was added, or is there again after an undo."""
        self._came_or_went(obj, name)

    def slotRemoveDynamicProperty(self, obj: Any, name: str) -> None:
        """A property was removed; FreeCAD does not touch its object then."""
        self._came_or_went(obj, name)

    def _came_or_went(self, obj: Any, name: str) -> None:
        from .brace import is_brace

        if name.startswith(("Pressure", "Seam")) and is_brace(obj):
            obj.touch()
            looks.redraw(obj)

    def slotUndoDocument(self, document: Any) -> None:
        """Something was undone."""
        self._travelled(document)

    def slotRedoDocument(self, document: Any) -> None:
        """Something was done again."""
        self._travelled(document)

    def _travelled(self, document: Any) -> None:
        from .brace import is_brace

        if after is not None and any(is_brace(obj) for obj in document.Objects):
            after(document)


_watcher: _Watcher | None = None


def begin() -> None:
    """Begins to watch, once."""
    global _watcher  # FreeCAD has one list of observers
    if _watcher is None:
        _watcher = _Watcher()
        FreeCAD.addDocumentObserver(_watcher)
