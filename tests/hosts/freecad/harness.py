"""Runs checks inside FreeCAD and tells the outside how many passed and failed.

FreeCAD ends well whatever a script raises, so that what counts is written to the file that
CHECKS names: the last line is "N passed, N failed", and without it the run has broken off.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

SCRATCH = Path(os.environ["SCRATCH"])
"""A folder for the files of the checks."""

_checks: list[Callable[[], None]] = []


def check(function: Callable[[], None]) -> Callable[[], None]:
    """Marks a check; its name says what holds."""
    _checks.append(function)
    return function


def close(got: float, wanted: float, tolerance: float) -> None:
    """Demands that two numbers agree within an absolute tolerance."""
    assert abs(got - wanted) <= tolerance, f"{got!r} is not {wanted!r} within {tolerance}"


def refused(call: Callable[[], object], words: str) -> None:
    """Demands that a call raises with these words in its text."""
    try:
        call()
    except Exception as error:
        assert words in str(error), f"{words!r} is not in {str(error)!r}"
    else:
        raise AssertionError(f"nothing was refused; {words!r} was to be said")


def run_all() -> None:
    """Runs every check, writes the counts, and ends FreeCAD."""
    passed, failed = 0, 0
    with Path(os.environ["CHECKS"]).open("w", encoding="utf-8") as told:
        for function in _checks:
            try:
                function()
            except BaseException:
                failed += 1
                told.write(f"FAILED: {function.__name__}\n{traceback.format_exc()}\n")
            else:
                passed += 1
                told.write(f"passed: {function.__name__}\n")
            told.flush()
        told.write(f"{passed} passed, {failed} failed\n")
    sys.stdout.flush()
    os._exit(1 if failed else 0)
