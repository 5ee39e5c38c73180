"""Clicks on the limb: the place on the surface under the mouse, and what was clicked so far."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD
import FreeCADGui
from pivy import coin
from PySide import QtCore

from ..brace import children
from . import coin_nodes


class Picker:
    """Hears clicks of the left button on a brace's limb until it is ended.

    Args:
        brace: whose source, or worn surface, is clicked.
        picked: called with the place in mm.
    """

    def __init__(self, brace: Any, picked: Callable[[Any], None]) -> None:
        self._names = {brace.Source[0].Name, *(child.Name for child in children(brace))}
        self._picked = picked
        self._taken = False
        self._view = FreeCADGui.getDocument(brace.Document.Name).activeView()
        self._kind = coin.SoMouseButtonEvent.getClassTypeId()
        self._heard = self._view.addEventCallbackPivy(self._kind, self._mouse)

    def end(self) -> None:
        """Hears no more."""
        if self._heard is not None:
            self._view.removeEventCallbackPivy(self._kind, self._heard)
            self._heard = None

    def _mouse(self, callback: Any) -> None:
        event = callback.getEvent()
        if event.getButton() != coin.SoMouseButtonEvent.BUTTON1:
            return
        if event.getState() != coin.SoMouseButtonEvent.DOWN:
            if self._taken:
                callback.setHandled()
            self._taken = False
            return
        if event.wasCtrlDown() or event.wasShiftDown() or event.wasAltDown():
            return
        place = tuple(event.getPosition().getValue())
        for hit in self._view.getObjectsInfo(place) or ():
            if hit["Object"] in self._names:
                # Or the click would select, too.
                callback.setHandled()
                self._taken = True
                # FreeCAD selects what is clicked all the same.
                QtCore.QTimer.singleShot(0, FreeCADGui.Selection.clearSelection)
                self._picked(FreeCAD.Vector(hit["x"], hit["y"], hit["z"]))
                return


class Trace:
    """Balls, and a line through them, that show what was clicked, until it is ended."""

    def __init__(self, brace: Any, colour: coin_nodes.RGB) -> None:
        view = FreeCADGui.getDocument(brace.Document.Name).activeView()
        self._scene, self._colour = view.getSceneGraph(), colour
        self._root = coin_nodes.scene()
        self._scene.addChild(self._root)

    def show(self, places: Sequence[Any]) -> None:
        """Shows these places instead of those before."""
        while self._root.getNumChildren() > 1:
            self._root.removeChild(1)
        for place in places:
            self._root.addChild(coin_nodes.ball(place, self._colour))
        if len(places) > 1:
            self._root.addChild(coin_nodes.line(places, self._colour))

    def end(self) -> None:
        """Takes it away."""
        if self._root is not None:
            self._scene.removeChild(self._root)
            self._root = None
