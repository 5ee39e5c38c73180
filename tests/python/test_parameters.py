"""The table of parameters as a host's dialog reads it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import wovenfit
from wovenfit import ParameterKind

ROWS = wovenfit.parameter_table()


def other_value(row: wovenfit.Parameter) -> float | int | bool | str:
    """One that it may be and is not by default."""
    if row.kind is ParameterKind.SWITCH:
        return not row.default
    if row.kind is ParameterKind.CHOICE:
        return next(name for name in row.choices if name != row.default)
    return row.most if row.default != row.most else row.least


def test_the_table_is_long_and_has_each_name_once() -> None:
    assert len(ROWS) > 15
    assert len({row.name for row in ROWS}) == len(ROWS)
    assert {row.kind for row in ROWS} == set(ParameterKind)
    spacing = next(row for row in ROWS if row.name == "spacing")
    assert (spacing.unit, spacing.default, spacing.least, spacing.most) == ("mm", 5.0, 0.5, 30.0)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_every_row_has_what_a_dialog_needs(row: wovenfit.Parameter) -> None:
    types = {
        ParameterKind.NUMBER: float,
        ParameterKind.INTEGER: int,
        ParameterKind.SWITCH: bool,
        ParameterKind.CHOICE: str,
    }
    assert type(row.default) is types[row.kind]
    assert row.summary
    assert row.paragraph
    if row.kind in (ParameterKind.NUMBER, ParameterKind.INTEGER):
        assert row.least <= row.default <= row.most
        assert math.isfinite(row.least)
        assert math.isfinite(row.most)
        assert row.choices == ()
    else:
        assert row.least is None
        assert row.most is None
        assert (row.default in row.choices) == (row.kind is ParameterKind.CHOICE)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_every_value_can_be_set_and_read_back(row: wovenfit.Parameter) -> None:
    values = wovenfit.Parameters()
    assert values[row.name] == row.default
    other = other_value(row)
    values[row.name] = other
    assert values[row.name] == other
    assert type(values[row.name]) is type(row.default)
    copy = values.copy()
    copy[row.name] = row.default
    assert (values[row.name], copy[row.name]) == (other, row.default)


def test_numbers_of_numpy_are_numbers() -> None:
    values = wovenfit.Parameters(
        spacing=np.float32(7.5), newton_steps=np.int64(12), keep_largest=np.bool_(True)
    )
    assert (values["spacing"], values["newton_steps"], values["keep_largest"]) == (7.5, 12, True)


def test_parameters_are_a_mapping() -> None:
    values = wovenfit.Parameters(spacing=7.0)
    assert len(values) == len(ROWS)
    assert list(values) == [row.name for row in ROWS]
    assert "spacing" in values
    assert "spacin" not in values
    assert "spacing=7.0" in repr(values)
    assert dict(values) == dict(wovenfit.Parameters(**values))


def test_a_value_changes_the_pattern(mesh: wovenfit.Mesh, design: wovenfit.Design) -> None:
    def pattern(**values: wovenfit.parameters.Value) -> wovenfit.Pattern:
        return wovenfit.Job(mesh, design, wovenfit.Parameters(**values)).result()

    assert len(pattern(girth_step=9.0).girths) > len(pattern(girth_step=30.0).girths)
    assert pattern(curvature_radius=6.0).figures.curvature_radius_mm == 6.0
