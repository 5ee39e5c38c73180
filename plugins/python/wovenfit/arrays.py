"""Arrays of the caller, checked and in the form that the library reads.

Nothing is rounded or guessed in silence: indices must be whole numbers, shapes must be as stated.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from .errors import InvalidArgument

if TYPE_CHECKING:
    import numpy.typing as npt

_MOST_NAMED = 10
"""Faulty elements that an exception carries."""

Shape = tuple[Union[int, str], ...]
"""What an array must be: numbers, and letters for what may be any number."""


def _shaped(values: object, shape: Shape, name: str) -> npt.NDArray[Any]:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise InvalidArgument(f"`{name}` is no array: {error}") from error
    # An empty list is an empty array of whatever shape can be empty.
    if array.size == 0 and array.ndim == 1 and isinstance(shape[0], str):
        array = array.reshape((0, *(n if isinstance(n, int) else 0 for n in shape[1:])))
    fits = array.ndim == len(shape) and all(
        isinstance(wanted, str) or wanted == got for wanted, got in zip(shape, array.shape)
    )
    if not fits:
        stated = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
        raise InvalidArgument(
            f"`{name}` has shape {array.shape}: give an array of shape ({stated})"
        )
    return array


def _numbers(values: object, shape: Shape, name: str) -> npt.NDArray[Any]:
    array = _shaped(values, shape, name)
    if array.size == 0:
        return array.astype(np.float64)
    if array.dtype.kind not in "fiu":
        raise InvalidArgument(f"`{name}` holds {array.dtype}: give real numbers")
    return array


def numbers(values: object, shape: Shape, name: str) -> npt.NDArray[np.float64]:
    """Finite 64-bit numbers, one after the other.

    Raises:
        InvalidArgument: if they are of another shape, no real numbers, or not finite; `elements`
            are then the rows.
    """
    array = np.ascontiguousarray(_numbers(values, shape, name), np.float64)
    finite = np.isfinite(array)
    if not finite.all():
        rows = ~finite.reshape(len(array), -1).all(axis=1)
        elements = tuple(map(int, np.flatnonzero(rows)[:_MOST_NAMED]))
        raise InvalidArgument(
            f"`{name}` is not finite at {_listed(elements, int(rows.sum()))}: give finite numbers",
            elements,
        )
    return array


def coordinates(values: object, name: str) -> tuple[npt.NDArray[Any], int]:
    """Points of a mesh, of 32 or 64 bits, and the bytes from one to the next.

    They are not copied if they are of such numbers and each point's three stand together. They may
    be not finite: that is a defect of the mesh, which its check names.
    """
    array = _numbers(values, ("n", 3), name)
    if array.dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
        array = array.astype(np.float64)
    one = array.itemsize
    together = array.strides[1] == one and array.strides[0] >= 3 * one
    if not together:
        array = np.ascontiguousarray(array)
    return array, max(array.strides[0], 3 * one)


def indices(values: object, shape: Shape, name: str) -> npt.NDArray[np.uint32]:
    """Indices, counted from 0, one after the other.

    Raises:
        InvalidArgument: if they are of another shape, no whole numbers, negative or beyond 32 bits;
            `elements` are then the rows.
    """
    array = _shaped(values, shape, name)
    if array.size == 0:
        return array.astype(np.uint32)
    if array.dtype.kind not in "iu":
        raise InvalidArgument(f"`{name}` holds {array.dtype}: give whole numbers, counted from 0")
    beyond = (array < 0) | (array > np.iinfo(np.uint32).max)
    if beyond.any():
        rows = beyond.reshape(len(array), -1).any(axis=1)
        elements = tuple(map(int, np.flatnonzero(rows)[:_MOST_NAMED]))
        raise InvalidArgument(
            f"`{name}` is negative or beyond 32 bits at {_listed(elements, int(rows.sum()))}: give "
            "indices counted from 0",
            elements,
        )
    return np.ascontiguousarray(array, np.uint32)


def _listed(elements: tuple[int, ...], all_of_them: int) -> str:
    more = f" and {all_of_them - len(elements)} more" if all_of_them > len(elements) else ""
    return f"row{'s' if all_of_them > 1 else ''} {', '.join(map(str, elements))}{more}"


def doubles_at(array: npt.NDArray[np.float64]) -> Any:
    """The array for a function that reads 64-bit numbers; it must outlive the call."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def floats_at(array: npt.NDArray[np.float32]) -> Any:
    """The array for a function that reads 32-bit numbers; it must outlive the call."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_float))


def indices_at(array: npt.NDArray[np.uint32]) -> Any:
    """The array for a function that reads indices; it must outlive the call."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_uint32))
