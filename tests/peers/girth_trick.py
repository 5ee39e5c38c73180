"""The obvious trick: shrink the limb's girth by 1 / (1 + wanted strain), then flatten with ARAP.

It is what a designer does who has a flattening tool and a strain, but no woven model.
"""

from __future__ import annotations

import igl
import numpy as np

from libigl_peers import arap
from measure import frames, moved_onto, warp_strain_error
from meshes import CutMesh, Floats, Ints, boundary, glued

SLICES = 16


def along_limb(mesh: CutMesh) -> Floats:
    """How far along the limb each vertex lies: 0 at one opening, 1 at the other, harmonic."""
    points, faces, place = glued(mesh)
    openings = loops(boundary(faces))
    if len(openings) < 2:
        raise ValueError("the limb has no two openings: it has no axis")
    lengths = [np.linalg.norm(points[np.roll(o, -1)] - points[o], axis=1).sum() for o in openings]
    first, second = (openings[index] for index in np.argsort(lengths)[-2:])
    held = np.concatenate([first, second])
    value = np.concatenate([np.zeros(len(first)), np.ones(len(second))])[:, None]
    return np.asarray(igl.harmonic(points, faces, held, value, 1)).ravel()[place]


def loops(edges: Ints) -> list[Ints]:
    """The vertices of each closed loop of the directed boundary edges."""
    result: list[Ints] = []
    begin = 0
    for index in range(1, len(edges) + 1):
        if index == len(edges) or edges[index, 0] != edges[index - 1, 1]:
            result.append(edges[begin:index, 0])
            begin = index
    return result


def shrunk(mesh: CutMesh, along: Floats, strain: Floats) -> Floats:
    """Every vertex's distance to the limb's centre line divided by 1 + strain; positions in mm.

    The centre line goes through the centroids of slices of the limb; a vertex moves towards the
    line's point at its own place along the limb. Few slices: more of them, the line's nearest point
    or moving only across the line all gave a larger error of strain.
    """
    middle = along[mesh.faces].mean(axis=1)
    area = 0.5 * np.linalg.det(frames(mesh.points, mesh.faces))
    slice_of = np.minimum((middle * SLICES).astype(np.int64), SLICES - 1)
    weight = np.bincount(slice_of, area, SLICES)
    filled = weight > 0.0

    def mean(values: Floats) -> Floats:
        return np.bincount(slice_of, area * values, SLICES)[filled] / weight[filled]

    level = mean(middle)
    centroids = mesh.points[mesh.faces].mean(axis=1)
    centre = np.column_stack(
        [np.interp(along, level, mean(centroids[:, axis])) for axis in range(3)]
    )
    return centre + (mesh.points - centre) / (1.0 + strain)[:, None]


def trick(mesh: CutMesh, along: Floats, strain: Floats, begin: Floats) -> Floats:
    """Shrinks and flattens; `begin` is where ARAP starts, in mm."""
    return arap(shrunk(mesh, along, strain), mesh.faces, begin)


def strain_error(
    mesh: CutMesh, flat: Floats, by_place: Floats, heights: Floats, strains: Floats
) -> float:
    """RMS warp strain error, in the way that is kinder to the trick.

    by_place: the wanted strain of each vertex by its place on the limb. heights (mm), strains: the
    wanted strain along weft; the trick's own threads lie at other places than ours.
    """
    upright = moved_onto(flat, mesh.pattern, mirror=True)
    own = np.interp(upright[:, 1], heights, strains)
    return min(warp_strain_error(mesh, upright, target) for target in (by_place, own))
