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
    if is_brace(obj):
        BraceView(obj.ViewObject)
    elif is_scripted(obj, Pattern):
        PatternView(obj.ViewObject)
    elif is_scripted(obj, Worn):
        WornView(obj.ViewObject)
