"""Which object has which view."""

from __future__ import annotations

from typing import Any

from ..brace import is_brace
from ..pattern import Pattern
from ..scripted import is_scripted
from ..worn import Worn
from .view_brace import BraceView
from .view_pattern import PatternView
from .view_worn import WornView


def dress(obj: Any) -> None:
    """Gives an object its view; one made in the console has none until a window opens it."""
    view = obj.ViewObject
    if is_brace(obj):
        proxy: Any = BraceView(view)
    elif is_scripted(obj, Pattern):
        proxy = PatternView(view)
    elif is_scripted(obj, Worn):
        proxy = WornView(view)
    else:
        return
    if not proxy.attached:
        # FreeCAD does it for an object that is new, and not for one that it has opened.
        proxy.attach(view)
        view.Visibility = True
        if is_brace(obj):
            # Its only mode; the list of modes was made before it had one.
            view.SwitchNode.whichChild = view.SwitchNode.getNumChildren() - 1
        proxy.updateData(obj, "VertexColors")
