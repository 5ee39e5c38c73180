"""The limb's surface as arrays: a document's mesh, or faces of a shape, tessellated by FreeCAD."""

from __future__ import annotations

import hashlib
from typing import Any, NamedTuple

import FreeCAD
import numpy as np
import numpy.typing as npt


class Surface(NamedTuple):
    """Triangles in the document's global frame."""

    positions: npt.NDArray[np.float64]
    """(n, 3) in mm."""
    triangles: npt.NDArray[np.uint32]
    """(m, 3) vertices, counted from 0."""


_tessellated: dict[str, Surface] = {}
"""The last tessellation, which takes seconds, by its shape and edge length."""


def is_source(obj: Any) -> bool:
    """Whether a brace can be made on an object: a mesh, or a shape with faces."""
    if obj.isDerivedFrom("Mesh::Feature"):
        return bool(obj.Mesh.CountFacets)
    shape = getattr(obj, "Shape", None)
    return shape is not None and bool(getattr(shape, "Faces", None))


def surface_of(source: Any, edge_length: float) -> Surface:
    """The surface of a brace's source.

    Args:
        source: the value of the property `Source`: an object and names of its faces, none for all.
        edge_length: in mm, the longest edge of a tessellation.

    Raises:
        ValueError: if there is no surface; the text says why.
    """
    if source is None or source[0] is None:
        raise ValueError("no Source: give the brace a mesh, or faces of a shape")
    obj, names = source
    if obj.isDerivedFrom("Mesh::Feature"):
        return _of_mesh(obj)
    shape = getattr(obj, "Shape", None)
    if shape is None:
        raise ValueError(f"Source: {obj.Label} is neither a mesh nor a shape")
    if not obj.isValid():
        raise ValueError(f"Source: {obj.Label} is invalid itself: {obj.getStatusString()}")
    return _of_faces(obj, [name for name in names if name], edge_length)


def _to_global(obj: Any) -> Any:
    """What takes an object's own coordinates, with its placement, to the global frame."""
    return obj.getGlobalPlacement().multiply(obj.Placement.inverse())


def _of_mesh(obj: Any) -> Surface:
    if obj.Mesh.CountFacets == 0:
        raise ValueError(f"Source: {obj.Label} is an empty mesh: import the scan again")
    points, facets = obj.Mesh.Topology
    positions = np.array([(p.x, p.y, p.z) for p in points])
    outside = _to_global(obj)
    if not outside.isIdentity():
        m = np.array(outside.toMatrix().A).reshape(4, 4)
        positions = positions @ m[:3, :3].T + m[:3, 3]
    return Surface(positions, np.array(facets, np.uint32))


def _of_faces(obj: Any, names: list[str], edge_length: float) -> Surface:
    import Part

    if edge_length <= 0:
        raise ValueError(f"EdgeLength is {edge_length:g} mm: give a length above 0, such as 4 mm")
    if names:
        faces = []
        for name in names:
            if not name.startswith("Face"):
                raise ValueError(f"Source: {obj.Label}.{name} is no face: choose faces")
            try:
                faces.append(obj.Shape.getElement(name))
            except Exception as error:
                raise ValueError(
                    f"Source: {obj.Label} has no {name} any more: choose its faces anew"
                ) from error
    else:
        faces = obj.Shape.Faces
    if not faces:
        raise ValueError(f"Source: {obj.Label} has no faces")
    shape = faces[0].copy() if len(faces) == 1 else Part.makeShell([f.copy() for f in faces])
    shape.Placement = _to_global(obj).multiply(shape.Placement)
    key = hashlib.sha256(f"{edge_length!r} {shape.exportBrepToString()}".encode()).hexdigest()
    if key not in _tessellated:
        made = _tessellate(shape, edge_length)
        if made is None:
            raise ValueError(
                f"Source: FreeCAD cannot tessellate {obj.Label} with edges of {edge_length:g} mm: "
                "try another EdgeLength, or make a mesh of it by hand"
            )
        _tessellated.clear()
        _tessellated[key] = made
    return _tessellated[key]


def _tessellate(shape: Any, edge_length: float) -> Surface | None:
    """Triangles of about this size, also where the shape is flat: the pattern's unknowns are their
    corners. What FreeCAD draws on the screen are slivers from end to end, useless here."""
    import MeshPart

    try:
        mesh = MeshPart.meshFromShape(Shape=shape, MaxLength=edge_length)
    except Exception as error:  # of several types, by its version
        FreeCAD.Console.PrintLog(f"wovenfit: {error}\n")
        return None
    if mesh.CountFacets == 0:
        return None
    points, facets = mesh.Topology
    positions = np.array([(p.x, p.y, p.z) for p in points])
    return Surface(positions, np.array(facets, np.uint32))
