"""What a dialog shows of the library's tables: its parameters, and the design's own keys.

Nothing is listed here: parameters come from the library's table, wishes from the schema of the
design file, with names, ranges and texts, so that a new one appears without a change here. Wishes
that are places on the limb (pressures, seams, …) are arrays in the schema and are not among them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import Any

import numpy as np

from ..wovenfit import Parameter, ParameterKind, design_schema, parameter_table

_OPEN_END = 1e-4
"""How far inside of a bound that must not be reached itself a slider ends."""


class Kind(Enum):
    """What a field holds."""

    NUMBER = "number"
    INTEGER = "integer"
    SWITCH = "switch"
    CHOICE = "choice"
    TEXT = "text"


@dataclass(frozen=True)
class Field:
    """A number, switch, choice or text of a dialog."""

    name: str
    """As the library knows it, such as "fabric.warp"."""
    kind: Kind
    label: str
    """With the unit."""
    tooltip: str
    unit: str
    default: Any
    """None where leaving it out means something of its own."""
    least: float | None = None
    most: float | None = None
    choices: tuple[tuple[str, str], ...] = ()
    """Names and what they mean."""

    @property
    def identifier(self) -> str:
        """The name as Python takes it."""
        return self.name.replace(".", "_")

    @property
    def section(self) -> str:
        """What stands before the point; empty for a name without one."""
        return self.name.rpartition(".")[0]

    @property
    def optional(self) -> bool:
        """Whether leaving it out means something of its own."""
        return self.default is None


def exact(value: float) -> float:
    """The decimal that was typed into a field of 32 bits: 0.01, not 0.00999999978."""
    return float(str(np.float32(value)))


@cache
def parameter_fields() -> tuple[Field, ...]:
    """All parameters but the unit, which is the scene's or stands beside the surface."""
    return tuple(_of_parameter(row) for row in parameter_table() if row.name != "units")


@cache
def unit_names() -> tuple[str, ...]:
    """The units of length that the library knows by name."""
    row = next(row for row in parameter_table() if row.name == "units")
    return tuple(name for name in row.choices if name != row.default)


def _of_parameter(row: Parameter) -> Field:
    kinds = {
        ParameterKind.NUMBER: Kind.NUMBER,
        ParameterKind.INTEGER: Kind.INTEGER,
        ParameterKind.SWITCH: Kind.SWITCH,
        ParameterKind.CHOICE: Kind.CHOICE,
    }
    return Field(
        name=row.name,
        kind=kinds[row.kind],
        label=_label(row.name, row.unit),
        tooltip=f"{row.summary}\n{row.paragraph}",
        unit=row.unit,
        default=row.default,
        least=row.least,
        most=row.most,
        choices=tuple((name, "") for name in row.choices),
    )


@cache
def design_fields() -> tuple[Field, ...]:
    """The wishes of the design file that are a number, a choice or a text."""
    schema = design_schema()
    found = []
    for name, node in schema["properties"].items():
        if node.get("type") == "object":
            found += [_of_schema(f"{name}.{key}", one) for key, one in node["properties"].items()]
        elif name != "units":
            found.append(_of_schema(name, node))
    return tuple(field for field in found if field is not None)


def _of_schema(name: str, node: dict[str, Any]) -> Field | None:
    text = node.get("description", "")
    if "oneOf" in node:
        choices = tuple((one["const"], one.get("description", "")) for one in node["oneOf"])
        return Field(
            name, Kind.CHOICE, _label(name, ""), text, "", node.get("default"), None, None, choices
        )
    if node.get("type") == "string":
        return Field(name, Kind.TEXT, _label(name, ""), text, "", node.get("default", ""))
    if node.get("type") != "number":
        return None
    unit = re.search(r"\bin (N/mm|kPa|mm)\b", text)
    least, most = node.get("minimum"), node.get("maximum")
    if "exclusiveMinimum" in node:
        least = node["exclusiveMinimum"] + _OPEN_END
    symbol = "" if unit is None else unit[1]
    return Field(
        name, Kind.NUMBER, _label(name, symbol), text, symbol, node.get("default"), least, most
    )


def _label(name: str, unit: str) -> str:
    last = name.rpartition(".")[2]
    if last.endswith("_kpa"):
        last = last[: -len("_kpa")] + "_pressure"
    words = last.replace("_", " ")
    words = words if len(words) == 1 else words[0].upper() + words[1:]
    return f"{words} ({unit})" if unit else words
