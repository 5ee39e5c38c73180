"""Looking at a mesh before work is spent on it."""

from __future__ import annotations

import ctypes
import json
from contextlib import ExitStack
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional

from . import calls
from .handle import Handle, lent
from .notes import Defect, Note, read_note

if TYPE_CHECKING:
    from .design import Design
    from .mesh import Mesh
    from .parameters import Parameters


class Check(Handle):
    """What is found on a mesh: every defect with its place, warnings, size and girths.

    Checking takes about a second for 250,000 triangles; other threads run meanwhile. A mesh without
    defects can be flattened. A check never changes: any thread may use it.

    Args:
        mesh: to check.
        design: its facing bears on the check.
        parameters: None for the defaults.
    """

    _free = "wovenfit_check_free"

    def __init__(
        self,
        mesh: Mesh,
        design: Optional[Design] = None,
        parameters: Optional[Parameters] = None,
    ) -> None:
        with ExitStack() as held:
            given = held.enter_context(lent(mesh))
            wishes = held.enter_context(lent(design))
            values = held.enter_context(lent(parameters))
            super().__init__(calls.new("wovenfit_check_run", given, wishes, values))

    @cached_property
    def _counts(self) -> tuple[int, int]:
        defects, warnings = ctypes.c_size_t(), ctypes.c_size_t()
        with self._lent() as address:
            calls.call(
                "wovenfit_check_count", address, ctypes.byref(defects), ctypes.byref(warnings)
            )
        return defects.value, warnings.value

    @property
    def sound(self) -> bool:
        """Whether there is no defect."""
        return self._counts[0] == 0

    @cached_property
    def defects(self) -> tuple[Defect, ...]:
        """What is wrong with the mesh."""
        with self._lent() as address:
            return tuple(_defect(address, index) for index in range(self._counts[0]))

    @cached_property
    def warnings(self) -> tuple[Note, ...]:
        """What the designer should know of a sound mesh."""
        texts, places = "wovenfit_check_warning_text", "wovenfit_check_warning_place"
        with self._lent() as address:
            return tuple(
                read_note(texts, places, address, index) for index in range(self._counts[1])
            )

    @cached_property
    def report(self) -> dict[str, Any]:
        """What `wovenfit check --json` prints: unit, size, girths, openings, curvature."""
        with self._lent() as address:
            report: dict[str, Any] = json.loads(calls.text("wovenfit_check_json", address))
        return report


def _defect(address: int, index: int) -> Defect:
    note = read_note("wovenfit_check_defect_text", "wovenfit_check_defect_place", address, index)
    return Defect(
        note.code,
        note.message,
        note.at,
        calls.indices("wovenfit_check_defect_vertices", address, index),
        calls.indices("wovenfit_check_defect_triangles", address, index),
    )
