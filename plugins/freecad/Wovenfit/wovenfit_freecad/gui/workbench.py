"""What the workbench does when FreeCAD opens it."""

from __future__ import annotations

from . import later
from .commands import register


def begin() -> list[str]:
    """Registers the commands and begins to watch; the commands' names."""
    later.begin()
    return register()
