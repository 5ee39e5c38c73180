"""Small scenes of Coin, FreeCAD's 3D library: labels, marks and lines that no click hits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from pivy import coin

RGB = tuple[float, float, float]

INK: RGB = (0.05, 0.05, 0.05)
MET: RGB = (0.72, 0.93, 0.72)
MISSED: RGB = (1.0, 0.62, 0.55)
UNKNOWN: RGB = (0.90, 0.90, 0.90)
SEAM: RGB = (0.85, 0.10, 0.55)
WEFT: RGB = (0.05, 0.25, 0.85)


def scene() -> Any:
    """An empty scene that is drawn and never picked."""
    root = coin.SoSeparator()
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    root.addChild(style)
    return root


def label(place: Sequence[float], text: str, background: RGB, size: int = 11) -> Any:
    """A framed text at a place, of the same size from near and far, in front of everything."""
    root = coin.SoAnnotation()
    move = coin.SoTranslation()
    move.translation = tuple(place)
    root.addChild(move)
    kind = coin.SoType.fromName("SoFrameLabel")
    if kind.isBad():
        # A FreeCAD without its framed labels.
        ink = coin.SoBaseColor()
        ink.rgb = INK
        words = coin.SoText2()
        words.string = text
        root.addChild(ink)
        root.addChild(words)
        return root
    framed = kind.createInstance()
    for field, value in (
        ("string", f'"{text}"'),
        ("backgroundColor", " ".join(map(str, background))),
        ("textColor", " ".join(map(str, INK))),
        ("name", "sans"),
        ("size", str(size)),
        ("frame", "TRUE"),
    ):
        framed.getField(field).set(value)
    root.addChild(framed)
    return root


def ball(place: Sequence[float], colour: RGB, radius: float = 1.5) -> Any:
    """A small ball; radius in mm."""
    root = coin.SoSeparator()
    move = coin.SoTranslation()
    move.translation = tuple(place)
    paint = coin.SoMaterial()
    paint.diffuseColor = colour
    sphere = coin.SoSphere()
    sphere.radius = radius
    for node in (move, paint, sphere):
        root.addChild(node)
    return root


def line(places: Iterable[Sequence[float]], colour: RGB, width: float = 4.0) -> Any:
    """A line through places, `width` pixels wide; dotted where something hides it."""
    points = [tuple(p) for p in places]
    hidden = coin.SoAnnotation()
    hidden.addChild(_line(points, colour, width / 2, 0x3333))
    root = coin.SoSeparator()
    root.addChild(_line(points, colour, width, 0xFFFF))
    root.addChild(hidden)
    return root


def _line(points: list[Any], colour: RGB, width: float, pattern: int) -> Any:
    root = coin.SoSeparator()
    plain = coin.SoLightModel()
    plain.model = coin.SoLightModel.BASE_COLOR
    paint = coin.SoBaseColor()
    paint.rgb = colour
    style = coin.SoDrawStyle()
    style.lineWidth, style.linePattern = width, pattern
    corners = coin.SoCoordinate3()
    corners.point.setValues(0, points)
    for node in (plain, paint, style, corners, coin.SoLineSet()):
        root.addChild(node)
    return root
