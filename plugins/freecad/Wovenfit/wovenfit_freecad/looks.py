"""The way from an object to its view, if there is a window: the console never imports one."""

from __future__ import annotations

from typing import Any

import FreeCAD


def dress(obj: Any) -> None:
    """Gives a new object its view."""
    if FreeCAD.GuiUp:
        from .gui.views import dress as give

        give(obj)


def opened(obj: Any) -> None:
    """An object was opened or pasted: if it was made in the console it has no view yet."""
    if FreeCAD.GuiUp:
        from .gui.later import dress_soon

        dress_soon(obj)


def redraw(brace: Any) -> None:
    """What the view of a brace shows has changed in a way that FreeCAD does not tell a view."""
    if FreeCAD.GuiUp:
        from .gui.later import redraw_soon

        redraw_soon(brace)
