"""Numbers of the library as FreeCAD's quantities, and back.

FreeCAD keeps a stiffness in N/m and a pressure in kPa; here both cross in N/mm and kPa.
"""

from __future__ import annotations

from typing import Any

import FreeCAD

LENGTH, PRESSURE, STIFFNESS = "mm", "kPa", "N/mm"
"""The library's units, as FreeCAD spells them."""

_KINDS = {
    LENGTH: "App::PropertyLength",
    PRESSURE: "App::PropertyPressure",
    # FreeCAD 0.20 has the unit, but no type of property for it.
    STIFFNESS: "App::PropertyQuantity",
}


def kind_of(unit: str) -> str:
    """The type of property for a number in this unit."""
    return _KINDS.get(unit, "App::PropertyFloat")


def declare_unit(obj: Any, name: str, unit: str) -> None:
    """Tells a property its unit, which FreeCAD does not save for the types that need telling."""
    if obj.getTypeIdOfProperty(name) == "App::PropertyQuantity":
        setattr(obj, name, FreeCAD.Units.Unit(unit))


def quantity(value: float, unit: str) -> Any:
    """A number in a unit, for a property."""
    return FreeCAD.Units.Quantity(f"{value!r} {unit}") if unit in _KINDS else value


def number(value: Any, unit: str) -> float:
    """A property's value as a number in a unit.

    Raises:
        ValueError: if it is a quantity of another kind.
    """
    if isinstance(value, str):
        value = FreeCAD.Units.Quantity(value)
    if not hasattr(value, "getValueAs"):
        return float(value)
    if value.Unit == FreeCAD.Units.Unit():
        # A property that has lost its unit, as a copy of it may have.
        value = FreeCAD.Units.Quantity(value.Value, FreeCAD.Units.Unit(unit))
    try:
        return float(value.getValueAs(unit))
    except Exception as error:
        raise ValueError(f"{value.UserString} is no quantity in {unit}") from error
