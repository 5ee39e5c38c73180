"""The worn brace: the cut surface on the limb as a mesh, with strain or pressure as colours."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import Mesh
import numpy as np
import numpy.typing as npt
import wovenfit

from . import colours
from .scripted import OUTPUT, READ_ONLY, ensure
from .shown import Shown

QUANTITIES = {
    "Strain along warp": ("warp_strain", "", 0.01),
    "Strain along weft": ("weft_strain", "", 0.01),
    "Pressure": ("pressure_kpa", "kPa", 0.1),
    "Friction needed": ("friction", "", 0.01),
}
"""What can be shown: the pattern's array, its unit, and the least span of its colours."""


class Worn(Shown):
    """The proxy of the worn brace's mesh."""

    def add_properties(self, obj: Any) -> None:
        super().add_properties(obj)
        if ensure(obj, "App::PropertyEnumeration", "Show", "Worn", "What the colours mean."):
            obj.Show = list(QUANTITIES)
            obj.Show = "Pressure"
        shown = READ_ONLY | OUTPUT
        values = "The value at every point of the mesh, strain without unit or kPa; NaN: none."
        ensure(obj, "App::PropertyFloatList", "Values", "Worn", values, shown)
        ensure(obj, "App::PropertyFloat", "Least", "Worn", "Value of the scale's low end.", shown)
        ensure(obj, "App::PropertyFloat", "Most", "Worn", "Value of the scale's high end.", shown)
        # The view of a mesh takes the only list of colours that its object has.
        ensure(
            obj, "App::PropertyColorList", "VertexColors", "Worn", "Colour of every point.", shown
        )

    def options(self, obj: Any) -> str:
        return str(obj.Show)

    def show(self, obj: Any, pattern: wovenfit.Pattern) -> None:
        array, _, least = QUANTITIES[obj.Show]
        values = getattr(pattern, array)
        low, high = colours.scale(values, least)
        obj.Mesh = as_mesh(pattern.positions, pattern.triangles)
        obj.Values = [float(value) for value in values]
        obj.Least, obj.Most = low, high
        obj.VertexColors = [tuple(map(float, rgb)) for rgb in colours.colours(values, low, high)]

    def empty(self, obj: Any) -> None:
        obj.Mesh = Mesh.Mesh()
        obj.Values, obj.VertexColors = [], []
        obj.Least = obj.Most = 0.0


def as_mesh(positions: npt.NDArray[np.float64], triangles: npt.NDArray[np.uint32]) -> Any:
    """A mesh of FreeCAD, whose points are 32-bit numbers; the order is kept."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, triangles
    mesh = Mesh.Mesh()
    mesh.read(BytesIO(header.encode() + positions.astype("<f4").tobytes() + faces.tobytes()), "PLY")
    return mesh
