"""libigl: the conformal start, ARAP and SLIM. Patterns are (n, 2) in mm."""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, diags
from scipy.sparse.linalg import spsolve

from measure import flat_frames, flips, frames
from meshes import Floats, Ints

ARAP_STEPS = 40
SLIM_STEPS = 18


@dataclass(frozen=True)
class Start:
    """Where ARAP and SLIM start: a pattern at the surface's area, and how it was made."""

    flat: Floats
    method: str


def at_area(points: Floats, faces: Ints, flat: Floats) -> Floats:
    """The pattern scaled to the area of the surface."""
    surface = np.linalg.det(frames(points, faces)).sum()
    drawn = np.abs(np.linalg.det(flat_frames(flat, faces)).sum())
    return flat * float(np.sqrt(surface / drawn))


def lscm(points: Floats, faces: Ints) -> Floats:
    """Least-squares conformal map, two far vertices of the boundary held."""
    loop = np.asarray(igl.boundary_loop(faces))
    distance = np.linalg.norm(points[loop] - points[loop[0]], axis=1)
    held = np.array([loop[0], loop[distance.argmax()]], dtype=np.int64)
    flat, _ = igl.lscm(points, faces, held, np.array([[0.0, 0.0], [distance.max(), 0.0]]))
    return at_area(points, faces, np.asarray(flat))


def tutte(points: Floats, faces: Ints) -> Floats:
    """Tutte's embedding into a circle, all weights 1: never flips, far from isometric."""
    loop = np.asarray(igl.boundary_loop(faces))
    step = np.linalg.norm(points[np.roll(loop, -1)] - points[loop], axis=1)
    angle = 2.0 * np.pi * (np.cumsum(step) - step) / step.sum()
    flat = np.zeros((len(points), 2))
    flat[loop] = np.column_stack([np.cos(angle), np.sin(angle)])
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = np.unique(np.sort(ends, axis=1), axis=0)
    one = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(flat),) * 2)
    adjacent = csc_matrix(one + one.T)
    laplacian = csc_matrix(diags(np.asarray(adjacent.sum(axis=1)).ravel()) - adjacent)
    inside = np.setdiff1d(np.arange(len(flat)), loop)
    right = -laplacian[inside][:, loop] @ flat[loop]
    flat[inside] = spsolve(laplacian[inside][:, inside], right)
    return at_area(points, faces, flat)


def start(points: Floats, faces: Ints) -> Start:
    """LSCM; Tutte's embedding where LSCM turns triangles over or has no answer."""
    flat = lscm(points, faces)
    if np.isfinite(flat).all() and flips(faces, flat) == 0:
        return Start(flat, "LSCM")
    return Start(tutte(points, faces), "Tutte (LSCM flips)")


def arap(points: Floats, faces: Ints, begin: Floats) -> Floats:
    """As rigid as possible, 40 local-global steps; one vertex held against drift."""
    data = igl.ARAPData()
    data.max_iter = ARAP_STEPS
    igl.arap_precomputation(points, faces, 2, np.array([0], dtype=np.int32), data)
    return np.asarray(igl.arap_solve(begin[:1], data, np.ascontiguousarray(begin)))[:, :2]


def slim(points: Floats, faces: Ints, begin: Floats) -> Floats:
    """Scalable locally injective mappings of the symmetric Dirichlet energy, 18 steps."""
    data = igl.slim_precompute(
        np.asfortranarray(points),
        np.asfortranarray(faces, dtype=np.int32),
        np.asfortranarray(begin),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, dtype=np.int32),
        np.asfortranarray(np.zeros((0, 2))),
        0.0,
    )
    return np.asarray(igl.slim_solve(data, SLIM_STEPS))[:, :2]
