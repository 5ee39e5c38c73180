"""Vertices that the designer chose, found again after the mesh was edited.

A mark keeps its vertex's index, its place and how many vertices there were. While their number is
the same a mark stays with its vertex, wherever that is moved, unless another vertex lies just where
the mark was: then the vertices were renumbered. With another number it is the vertex that lies
where the mark was; if there is none, the place itself is what counts, and the designer is told.
"""

from dataclasses import dataclass

import numpy as np

from .limb import got

_SAME_PLACE = 1e-6
"""Share of the mesh's size within which a place is the same: some steps of 32-bit numbers."""


@dataclass(frozen=True)
class Found:
    """Where a mark is now."""

    vertex: int
    """The vertex of the object's own mesh; -1 if there is none any more."""
    place: np.ndarray
    """(3,) in the object's coordinates."""


def mark(target, mesh, vertex):
    """Puts a mark onto a vertex."""
    target.vertex = vertex
    target.place = mesh.vertices[vertex].co
    target.vertices = len(mesh.vertices)


def find(target, points):
    """Where a mark is on a mesh whose vertices lie at `points`, (n, 3)."""
    was = np.array(target.place, np.float64)
    there = 0 <= target.vertex < len(points)
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if there and _near(points[target.vertex], was, size):
        return Found(target.vertex, points[target.vertex])
    nearest = int(np.argmin(np.linalg.norm(points - was, axis=1))) if len(points) else -1
    if nearest >= 0 and _near(points[nearest], was, size):
        return Found(nearest, points[nearest])
    if there and target.vertices == len(points):
        return Found(target.vertex, points[target.vertex])
    return Found(-1, was)


def renew(target, found, points):
    """Writes where a mark was found into it. A lost one stays as it was."""
    if found.vertex < 0:
        return
    if target.vertex != found.vertex:
        target.vertex = found.vertex
    if target.vertices != len(points):
        target.vertices = len(points)
    if not np.array_equal(np.array(target.place, np.float64), found.place):
        target.place = found.place


def points_of(mesh):
    """(n, 3) the vertices of an object's own mesh, as 64-bit numbers."""
    return got(mesh.vertices, "co", np.float32, 3).astype(np.float64)


def _near(one, other, size):
    return bool(np.linalg.norm(one - other) <= _SAME_PLACE * size)
