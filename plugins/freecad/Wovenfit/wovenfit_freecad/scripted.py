"""What scripted objects share: their state is in their properties, and a proxy saves none."""

from __future__ import annotations

from typing import Any

READ_ONLY, HIDDEN, OUTPUT = 1, 4, 8
"""Attributes of a property (`App::PropertyType`). An output does not touch its object."""


class Scripted:
    """The proxy of an object or of its view. Attributes of a proxy are gone after a reopening."""

    def dumps(self) -> None:
        """What is saved: nothing. Asked by FreeCAD 1.0."""
        return

    def loads(self, state: Any) -> None:
        """Takes back what was saved: nothing. Asked by FreeCAD 1.0."""
        del state

    # Asked by FreeCAD 0.20.
    def __getstate__(self) -> None:
        return None

    def __setstate__(self, state: Any) -> None:
        del state


def ensure(obj: Any, kind: str, name: str, group: str, text: str, attributes: int = 0) -> bool:
    """Adds a property unless it is there; whether it was added."""
    if name in obj.PropertiesList:
        return False
    obj.addProperty(kind, name, group, text, attributes)
    return True


def is_scripted(obj: Any, proxy: type) -> bool:
    """Whether an object of a document has a proxy of this class."""
    return isinstance(getattr(obj, "Proxy", None), proxy)
