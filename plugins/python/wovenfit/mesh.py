"""A surface as the caller's arrays give it."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Union

from . import arrays, calls
from .handle import Handle

if TYPE_CHECKING:
    import numpy.typing as npt

Unit = Union[str, float]
"""A unit of length: "mm", "cm", "m" or "in", or the millimetres in one unit."""

KPA_PER_MMHG = 0.133322
"""kPa in one mmHg, as the library has it, for hosts that show either."""


def millimetres(unit: Unit) -> float:
    """The millimetres in one unit.

    Raises:
        InvalidArgument: if there is no unit of this name.
    """
    if not isinstance(unit, str):
        return float(unit)
    mm = ctypes.c_double()
    calls.call("wovenfit_unit_millimetres", calls.c_text(unit, "unit"), ctypes.byref(mm))
    return mm.value


class Mesh(Handle):
    """A mesh of triangles with its unit. It never changes: any thread may use it.

    Args:
        positions: (n, 3) numbers, the places of the vertices in `unit`. Arrays of 32 or 64 bits are
            read as they are; other real numbers become 64-bit.
        triangles: (m, 3) whole numbers, three vertices each, counted from 0, counter-clockwise seen
            from outside the limb. Split polygons before.
        unit: of `positions`.

    Both are copied. Whether the mesh is sound is for `Check` and the job to say, which name every
    defect; here only shapes, types, counts and the unit are refused.

    Raises:
        InvalidArgument: as said.
        TooLarge: beyond 2,000,000 triangles or 6,000,000 vertices.
    """

    _free = "wovenfit_mesh_free"

    def __init__(
        self, positions: npt.ArrayLike, triangles: npt.ArrayLike, unit: Unit = "mm"
    ) -> None:
        points, stride = arrays.coordinates(positions, "positions")
        corners = arrays.indices(triangles, ("m", 3), "triangles")
        single = points.itemsize == ctypes.sizeof(ctypes.c_float)
        made = calls.new(
            "wovenfit_mesh_new_f32" if single else "wovenfit_mesh_new_f64",
            arrays.floats_at(points) if single else arrays.doubles_at(points),
            len(points),
            stride,
            arrays.indices_at(corners),
            len(corners),
            millimetres(unit),
        )
        super().__init__(made)
        self.vertex_count = len(points)
        self.triangle_count = len(corners)

    def __repr__(self) -> str:
        return f"<Mesh of {self.vertex_count} vertices and {self.triangle_count} triangles>"
