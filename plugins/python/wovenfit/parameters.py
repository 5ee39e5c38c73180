"""The table of parameters, from which a host makes its dialog, and values for it."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

from . import calls
from .abi import ParameterKind, ParameterText
from .errors import ParameterError
from .handle import Changeable
from .library import library
from .signatures import ParameterBounds

if TYPE_CHECKING:
    from collections.abc import Iterator

Value = Union[float, int, bool, str]
"""Of a parameter: `float`, `int`, `bool` or `str` as its kind says."""


@dataclass(frozen=True)
class Parameter:
    """A row of the table."""

    name: str
    """In snake case."""
    unit: str
    """Empty where it has none."""
    kind: ParameterKind
    default: Value
    least: Optional[float]
    """The least number that it may be; None where it is no number."""
    most: Optional[float]
    """The largest."""
    choices: tuple[str, ...]
    """The names that it may be; none unless it is a choice."""
    summary: str
    """What it does, in one line."""
    paragraph: str
    """When and why to change it."""

    def value_of(self, text: str) -> Value:
        """The value that a text of the library states."""
        if self.kind is ParameterKind.NUMBER:
            return float(text)
        if self.kind is ParameterKind.INTEGER:
            return int(text)
        if self.kind is ParameterKind.SWITCH:
            return text == "true"
        return text


@cache
def parameter_table() -> tuple[Parameter, ...]:
    """All parameters, in the order in which dialogs show them."""
    return tuple(_row(index) for index in range(library().wovenfit_parameter_count()))


def _row(index: int) -> Parameter:
    def text(what: ParameterText) -> str:
        return calls.text("wovenfit_parameter_describe", index, what).decode()

    bounds = ParameterBounds()
    calls.call("wovenfit_parameter_range", index, ctypes.byref(bounds))
    kind = ParameterKind(bounds.kind)
    whole = kind is ParameterKind.INTEGER
    number = whole or kind is ParameterKind.NUMBER
    default = text(ParameterText.DEFAULT)
    row = Parameter(
        name=text(ParameterText.NAME),
        unit=text(ParameterText.UNIT),
        kind=kind,
        default=default,
        least=(int(bounds.least) if whole else bounds.least) if number else None,
        most=(int(bounds.most) if whole else bounds.most) if number else None,
        choices=tuple(
            calls.text("wovenfit_parameter_choice", index, choice).decode()
            for choice in range(bounds.choices)
        ),
        summary=text(ParameterText.SUMMARY),
        paragraph=text(ParameterText.PARAGRAPH),
    )
    return Parameter(**{**vars(row), "default": row.value_of(default)})


class Parameters(Changeable, Mapping[str, Value]):
    """A value for every parameter of the table, the defaults but for those given.

    A mapping of names to values: ``Parameters(spacing=7.0)["spacing"]``. Any thread may use it; a
    job takes the values that it has when the job starts.

    Raises:
        ParameterError: for a name that is not in the table (the text says the nearest), or a value
            that the parameter cannot take (the text says the range).
    """

    _free = "wovenfit_parameters_free"
    # Two parameters may hold the same values and be changed apart.
    __hash__ = object.__hash__

    def __init__(self, **values: Value) -> None:
        super().__init__(calls.new("wovenfit_parameters_new"))
        for name, value in values.items():
            self[name] = value

    def copy(self) -> Parameters:
        """Parameters of their own with the same values."""
        copy = Parameters.__new__(Parameters)
        with self._lent() as address:
            Changeable.__init__(copy, calls.new("wovenfit_parameters_copy", address))
        return copy

    def __setitem__(self, name: str, value: Value) -> None:
        known, given = calls.c_text(name, "name"), calls.c_text(_text(name, value), "value")
        with self._lent() as address:
            calls.call("wovenfit_parameters_set", address, known, given)

    def __getitem__(self, name: str) -> Value:
        row = next((row for row in parameter_table() if row.name == name), None)
        if row is None:
            raise KeyError(name)
        with self._lent() as address:
            text = calls.text("wovenfit_parameters_get", address, name.encode()).decode()
        return row.value_of(text)

    def __iter__(self) -> Iterator[str]:
        return iter([row.name for row in parameter_table()])

    def __len__(self) -> int:
        return len(parameter_table())

    def __repr__(self) -> str:
        return f"Parameters({', '.join(f'{name}={value!r}' for name, value in self.items())})"


def _text(name: str, value: object) -> str:
    """A value as the library reads it."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    raise ParameterError(
        f"parameter `{name}` cannot be a {type(value).__name__}: give a number, a bool or a str"
    )
