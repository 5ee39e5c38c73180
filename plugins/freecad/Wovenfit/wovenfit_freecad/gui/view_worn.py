"""The view of the worn brace: colours on the mesh, and their scale at the window's left edge."""

from __future__ import annotations

from typing import Any

import numpy as np
from pivy import coin

from .. import colours
from ..scripted import Scripted
from ..worn import QUANTITIES
from . import coin_nodes, later
from .resources import icon
from .view_brace import mmhg

STEPS = 48
"""Strips of the scale."""

PAPER = (1.0, 1.0, 1.0)


class WornView(Scripted):
    """The proxy of the worn surface's view provider."""

    attached = False
    _scale: Any = None

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self
        vobj.OpenEdges = True
        vobj.Lighting = "Two side"

    def attach(self, vobj: Any) -> None:
        """Called when the view comes to be, also after opening."""
        self.attached = True
        # Just in front of the scan, which lies in the same place.
        offset = coin.SoPolygonOffset()
        offset.factor, offset.units = -1.0, -1.0
        vobj.RootNode.insertChild(offset, 0)
        self._scale = coin_nodes.scene()
        # It takes no part in "fit all".
        kind = coin.SoType.fromName("SkipBoundingGroup")
        outer = kind.createInstance() if not kind.isBad() else coin.SoSeparator()
        outer.addChild(self._scale)
        vobj.RootNode.addChild(outer)
        self._draw(vobj.Object)
        # A document that is being opened has its colours only later.
        later.recolour_soon(vobj.Object)

    def recolour(self, obj: Any) -> None:
        """Shows the object's colours on its mesh, and their scale."""
        if len(obj.VertexColors) == obj.Mesh.CountPoints > 0:
            # Off and on: FreeCAD takes new colours when it is switched.
            obj.ViewObject.Coloring = False
            obj.ViewObject.Coloring = True
        self._draw(obj)

    def getIcon(self) -> str:
        return icon("Worn")

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object has changed."""
        if name == "VertexColors":
            self.recolour(obj)

    def onChanged(self, vobj: Any, name: str) -> None:
        """A property of the view has changed."""
        if name == "Visibility":
            self._draw(vobj.Object)

    def _draw(self, obj: Any) -> None:
        if self._scale is None or "VertexColors" not in obj.PropertiesList:
            return
        while self._scale.getNumChildren() > 1:
            self._scale.removeChild(1)
        if obj.VertexColors and obj.ViewObject.Visibility:
            for node in _scale(obj):
                self._scale.addChild(node)


def _scale(obj: Any) -> list[Any]:
    """A bar with its numbers, fixed to the window whose height is 2."""
    camera = coin.SoOrthographicCamera()
    camera.viewportMapping = coin.SoCamera.LEAVE_ALONE
    camera.position = (1.0, 0.0, 1.0)
    camera.height, camera.nearDistance, camera.farDistance = 2.0, 0.1, 10.0
    camera.aspectRatio = 1.0
    plain = coin.SoLightModel()
    plain.model = coin.SoLightModel.BASE_COLOR
    nodes = [camera, plain]
    left, right, bottom, top = 0.06, 0.10, -0.5, 0.5
    edges = np.linspace(bottom, top, STEPS + 1)
    low, high = obj.Least, obj.Most
    shades = colours.colours(np.linspace(low, high, STEPS), low, high)
    paint, points, faces = coin.SoMaterial(), coin.SoCoordinate3(), coin.SoFaceSet()
    corners = []
    for a, b in zip(edges[:-1], edges[1:]):
        corners += [(left, a, 0), (right, a, 0), (right, b, 0), (left, b, 0)]
    points.point.setValues(0, corners)
    paint.diffuseColor.setValues(0, [tuple(map(float, rgb)) for rgb in shades])
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.PER_FACE
    faces.numVertices.setValues(0, [4] * STEPS)
    bar = coin.SoSeparator()
    for node in (paint, binding, points, faces):
        bar.addChild(node)
    nodes.append(bar)
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        value = low + share * (high - low)
        place = (right + 0.01, bottom + share * (top - bottom), 0.0)
        nodes.append(coin_nodes.label(place, _number(obj, value), PAPER))
    nodes.append(coin_nodes.label((left, top + 0.15, 0.0), f"{obj.Show}, by the model", PAPER))
    return nodes


def _number(obj: Any, value: float) -> str:
    if QUANTITIES[obj.Show][1] == "kPa":
        return f"{_plain(value, 2)} kPa  {_plain(mmhg(value), 1)} mmHg"
    return _plain(value, 3)


def _plain(value: float, decimals: int) -> str:
    """Decimals, and no minus before a zero."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}"
