"""The brace's properties that stand for one number, switch, choice or text.

They are made from the library's schema of a design and its table of parameters, so that what the
library adds there is a property here. Wishes that are places (pressures, seams, orientation,
region) are in `places.py`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

import wovenfit
from wovenfit import ParameterKind

from .quantities import LENGTH, PRESSURE, STIFFNESS, declare_unit, kind_of, number, quantity
from .scripted import ensure

AUTOMATIC = "automatic"
"""A choice that is left to the library."""


@dataclass(frozen=True)
class Scalar:
    """A property that stands for one value of the library."""

    key: str
    """In the library: the path in a design file ("fabric.warp"), or a parameter's name."""
    name: str
    """In FreeCAD: "FabricWarp"."""
    group: str
    kind: str
    unit: str
    """Of the library's number: "mm", "kPa", "N/mm" or none."""
    text: str
    """What it means, for the tooltip."""
    default: Any
    """None where the library has none: then 0, an empty text or `AUTOMATIC` leaves it out."""
    choices: tuple[str, ...] = ()

    def add(self, obj: Any) -> None:
        """Adds it to an object with its default, unless it is there; also what is not saved."""
        if ensure(obj, self.kind, self.name, self.group, self.text):
            if self.choices:
                setattr(obj, self.name, list(self.choices))
            declare_unit(obj, self.name, self.unit)
            if self.default is not None:
                self.write(obj, self.default)
            elif self.choices:
                setattr(obj, self.name, AUTOMATIC)
        else:
            declare_unit(obj, self.name, self.unit)

    def read(self, obj: Any) -> Any:
        """Its value for the library; None if it is left out."""
        value = getattr(obj, self.name)
        if self.kind in ("App::PropertyString", "App::PropertyEnumeration"):
            left_out = value in ("", AUTOMATIC) and self.default is None
            return None if left_out else value
        if self.kind in ("App::PropertyBool", "App::PropertyInteger"):
            return value
        plain = number(value, self.unit or "1")
        return None if self.default is None and plain == 0 else plain

    def write(self, obj: Any, value: Any) -> None:
        """Takes a value of the library; None leaves it to the library."""
        if value is None:
            value = self.default if self.default is not None else self._nothing()
        if isinstance(value, float):
            value = quantity(value, self.unit)
        setattr(obj, self.name, value)

    def _nothing(self) -> Any:
        if self.kind == "App::PropertyEnumeration":
            return AUTOMATIC
        return "" if self.kind == "App::PropertyString" else 0.0


@cache
def wishes() -> tuple[Scalar, ...]:
    """The design's single values, from the schema."""
    found = []
    for key, about in wovenfit.design_schema()["properties"].items():
        if about.get("type") == "object":
            for inner, detail in about["properties"].items():
                if detail.get("type") != "array":
                    default = about.get("default", {}).get(inner, detail.get("default"))
                    found.append(_wish(f"{key}.{inner}", key.capitalize(), detail, default))
        # The document's unit is mm; lists are wishes at places.
        elif about.get("type") != "array" and key != "units":
            found.append(_wish(key, "Brace", about, about.get("default")))
    return tuple(found)


def _wish(key: str, group: str, about: dict[str, Any], default: Any) -> Scalar:
    text, unit, kind = about["description"], "", "App::PropertyString"
    choices: tuple[str, ...] = ()
    name = _camel(key)
    if "oneOf" in about:
        kind = "App::PropertyEnumeration"
        choices = tuple(one["const"] for one in about["oneOf"])
        text += "".join(f"\n{one['const']}: {one['description']}" for one in about["oneOf"])
        if default is None:
            choices = (AUTOMATIC, *choices)
    elif about["type"] == "number":
        if key.endswith("_kpa"):
            unit, name = PRESSURE, _camel(key.removesuffix("_kpa")) + "Pressure"
        elif re.search(rf"\bin {STIFFNESS}\b", text):
            unit = STIFFNESS
        kind = kind_of(unit)
        default = None if default is None else float(default)
    return Scalar(key, name, group, kind, unit, text, default, choices)


@cache
def parameters() -> tuple[Scalar, ...]:
    """The table of parameters."""
    return tuple(_parameter(row) for row in wovenfit.parameter_table())


def _parameter(row: wovenfit.Parameter) -> Scalar:
    kinds = {
        ParameterKind.NUMBER: kind_of(row.unit),
        ParameterKind.INTEGER: "App::PropertyInteger",
        ParameterKind.SWITCH: "App::PropertyBool",
        ParameterKind.CHOICE: "App::PropertyEnumeration",
    }
    text = f"{row.summary}\n{row.paragraph}"
    if row.unit and row.unit != LENGTH:
        text += f"\nUnit: {row.unit}."
    if row.least is not None:
        text += f"\nFrom {row.least:g} to {row.most:g} {row.unit}".rstrip() + "."
    unit = row.unit if row.unit == LENGTH else ""
    return Scalar(
        row.name,
        _camel(row.name),
        "Parameters",
        kinds[row.kind],
        unit,
        text,
        row.default,
        row.choices,
    )


def _camel(key: str) -> str:
    return "".join(part.capitalize() for part in re.split(r"[._]", key))
