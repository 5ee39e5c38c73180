"""The view of a brace: its wishes on the limb, and its results below it in the tree."""

from __future__ import annotations

from typing import Any

from .. import places
from ..brace import children
from ..quantities import PRESSURE, number, quantity
from ..scripted import Scripted
from . import coin_nodes
from .resources import icon


class BraceView(Scripted):
    """The proxy of a brace's view provider."""

    Object: Any = None
    attached = False
    _marks: Any = None

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Called when the view comes to be, also after opening."""
        self.attached = True
        self.Object = vobj.Object
        self._marks = coin_nodes.scene()
        vobj.addDisplayMode(self._marks, "Marks")
        self._draw(vobj.Object)

    def getDisplayModes(self, vobj: Any) -> list[str]:
        return ["Marks"]

    def getDefaultDisplayMode(self) -> str:
        return "Marks"

    def setDisplayMode(self, mode: str) -> str:
        return mode

    def getIcon(self) -> str:
        return icon("Brace")

    def claimChildren(self) -> list[Any]:
        """What the tree shows below the brace."""
        if self.Object is None:
            return []
        return [*children(self.Object), *self.Object.RegionPlanes]

    def updateData(self, obj: Any, name: str) -> None:
        """A property has changed."""
        if name.startswith(("Pressure", "Seam", "Orientation", "Warnings", "ComputedFor")):
            self._draw(obj)

    def redraw(self, obj: Any) -> None:
        """Draws the wishes anew."""
        self._draw(obj)

    def doubleClicked(self, vobj: Any) -> bool:
        """Opens the panel to flatten."""
        from .panels.flatten import FlattenPanel
        from .panels.panel import show

        show(FlattenPanel(vobj.Object))
        return True

    def onDelete(self, vobj: Any, names: Any) -> bool:
        """With a brace goes what shows its result."""
        del names
        for child in children(vobj.Object):
            child.Document.removeObject(child.Name)
        return True

    def _draw(self, obj: Any) -> None:
        if self._marks is None:
            return
        root = self._marks
        while root.getNumChildren() > 1:
            root.removeChild(1)
        if "Orientation" in obj.PropertiesList and len(obj.Orientation) == 2:
            root.addChild(coin_nodes.line(obj.Orientation, coin_nodes.WEFT))
            for place, text in zip(obj.Orientation, ("body", "away")):
                root.addChild(coin_nodes.ball(place, coin_nodes.WEFT))
                root.addChild(coin_nodes.label(place, text, coin_nodes.UNKNOWN))
        for n in places.seams(obj):
            course = getattr(obj, f"Seam{n}")
            if course:
                root.addChild(coin_nodes.line(course, coin_nodes.SEAM))
        try:
            numbers = places.pressures(obj)
        except ValueError:
            # Half of a pressure is there while it is added or taken out.
            numbers = []
        for n in numbers:
            self._draw_pressure(obj, n)

    def _draw_pressure(self, obj: Any, n: int) -> None:
        wanted = number(getattr(obj, f"Pressure{n}"), PRESSURE)
        computed = number(getattr(obj, f"PressureComputed{n}", 0.0), PRESSURE)
        place = getattr(obj, f"PressurePlace{n}")
        text, colour = f"{n}: {mmhg(wanted):.1f} mmHg", coin_nodes.UNKNOWN
        if "ComputedFor" in obj.PropertiesList and obj.Width.Value > 0 and computed > 0:
            missed = any(said.startswith(f"Pressure{n}:") for said in obj.Warnings)
            colour = coin_nodes.MISSED if missed else coin_nodes.MET
            if missed:
                text += f" (computed {mmhg(computed):.1f})"
        self._marks.addChild(coin_nodes.ball(place, coin_nodes.INK))
        self._marks.addChild(coin_nodes.label(place, text, colour))


def mmhg(kpa: float) -> float:
    """A pressure in mmHg, as FreeCAD converts it (1 Torr is 1 mmHg to a ten-millionth)."""
    return float(quantity(kpa, PRESSURE).getValueAs("Torr"))
