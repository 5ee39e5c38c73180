"""What is said to the designer: warnings, defects, reasons."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Optional

import numpy as np

from . import calls
from .abi import NoteText

if TYPE_CHECKING:
    import numpy.typing as npt

Place = tuple[float, float, float]
"""x, y, z in mm."""


@dataclass(frozen=True)
class Note:
    """A warning, or why a pressure is missed."""

    code: str
    """A frozen short name that programs can test, such as "pattern_overlaps"."""
    message: str
    """What it is, where, and what to do, for people."""
    at: Optional[Place] = None
    """Where, in mm; None if it is at no one place."""


def _none() -> npt.NDArray[np.uint32]:
    return np.empty(0, np.uint32)


@dataclass(frozen=True)
class Defect(Note):
    """What is wrong with a mesh."""

    vertices: npt.NDArray[np.uint32] = field(default_factory=_none, compare=False)
    """Vertices of the mesh given that it is about, counted from 0; may be none."""
    triangles: npt.NDArray[np.uint32] = field(default_factory=_none, compare=False)
    """Triangles of the mesh given that it is about, counted from 0; may be none."""


def read_text(name: str, address: int, index: int, what: NoteText) -> str:
    """A text of note `index` by a function for that."""
    return calls.text(name, address, index, what).decode()


def read_note(text: str, place: str, address: int, index: int) -> Note:
    """Note `index` by functions for its texts and its place."""
    return Note(
        read_text(text, address, index, NoteText.CODE),
        read_text(text, address, index, NoteText.MESSAGE),
        calls.place(place, address, index),
    )
