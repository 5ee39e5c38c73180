"""Cut meshes: reading `worn.obj`, the boundary, and which boundary edges are sewn together."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Seam:
    """One seam: edge `left[k]` is sewn to edge `right[k]`; each edge is two vertices."""

    left: Ints
    right: Ints


@dataclass(frozen=True)
class CutMesh:
    """A surface cut to a disk.

    points: (n, 3) worn positions in mm. faces: (m, 3). pattern: (n, 2) the program's pattern in mm,
    x along warp (round the limb), y along weft. seams: the edges sewn together.
    """

    points: Floats
    faces: Ints
    pattern: Floats
    seams: list[Seam]


def read_worn(path: Path) -> CutMesh:
    """Reads the program's `worn.obj`: a vertex is a pair v/vt."""
    points: list[list[float]] = []
    pattern: list[list[float]] = []
    corners: list[list[tuple[int, int]]] = []
    with path.open(encoding="ascii") as lines:
        for line in lines:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append([float(word) for word in words[1:4]])
            elif words[0] == "vt":
                pattern.append([float(word) for word in words[1:3]])
            elif words[0] == "f":
                pairs = (word.split("/") for word in words[1:4])
                corners.append([(int(pair[0]) - 1, int(pair[1]) - 1) for pair in pairs])
    used, faces = np.unique(np.array(corners).reshape(-1, 2), axis=0, return_inverse=True)
    place = np.array(points)[used[:, 0]]
    flat = np.array(pattern)[used[:, 1]]
    triangles = faces.reshape(-1, 3).astype(np.int64)
    return CutMesh(place, triangles, flat, find_seams(place, triangles))


def boundary(faces: Ints) -> Ints:
    """The directed edges (k, 2) that only one triangle has, each loop in its order."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    single = edges[first[count == 1]]
    after = {int(a): int(b) for a, b in single}
    if len(after) != len(single):
        raise ValueError("the boundary of the cut mesh touches itself in a vertex")
    ordered: list[tuple[int, int]] = []
    while after:
        vertex = min(after)
        while vertex in after:
            following = after.pop(vertex)
            ordered.append((vertex, following))
            vertex = following
    return np.array(ordered, dtype=np.int64)


def find_seams(points: Floats, faces: Ints) -> list[Seam]:
    """Boundary edges whose two ends coincide exactly in space, chained to seams."""
    edges = boundary(faces)
    _, place = np.unique(points, axis=0, return_inverse=True)
    place = place.reshape(-1)
    at: dict[tuple[int, int], int] = {}
    for index, (a, b) in enumerate(edges):
        at[int(place[a]), int(place[b])] = index
    partner = [at.get((int(place[b]), int(place[a])), -1) for a, b in edges]
    seams: list[Seam] = []
    chain: list[int] = []

    def end_chain() -> None:
        if chain:
            seams.append(Seam(edges[chain], edges[[partner[index] for index in chain]]))
            chain.clear()

    done: set[int] = set()
    for index, other in enumerate(partner):
        goes_on = bool(chain) and index == chain[-1] + 1 and other == partner[chain[-1]] - 1
        if other < 0 or index in done or not goes_on:
            end_chain()
        if other >= 0 and index not in done:
            chain.append(index)
            done.update((index, other))
    end_chain()
    return seams


def glued(mesh: CutMesh) -> tuple[Floats, Ints, Ints]:
    """The mesh before the cut: points, faces, and for each cut vertex its vertex there."""
    points, place = np.unique(mesh.points, axis=0, return_inverse=True)
    place = place.reshape(-1).astype(np.int64)
    return points, place[mesh.faces], place
