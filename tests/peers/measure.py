"""What is measured: times, stretch, flips, seams, strain, and how far two patterns are apart."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes import CutMesh, Floats, Ints, boundary


@dataclass(frozen=True)
class Times:
    """Wall-clock seconds of several runs of one thing."""

    seconds: list[float]

    @property
    def median(self) -> float:
        """Median, in seconds."""
        return statistics.median(self.seconds)

    @property
    def spread(self) -> float:
        """Largest over smallest: 1 on a quiet machine."""
        return max(self.seconds) / max(min(self.seconds), 1e-9)

    def as_json(self) -> dict[str, object]:
        """Every run, in seconds, and their median."""
        return {"median": self.median, "runs": self.seconds}


def timed(action: Callable[[], Floats], repeats: int, patience: float) -> tuple[Floats, Times]:
    """Runs `action` up to `repeats` times, no more after a run longer than `patience` seconds."""
    seconds: list[float] = []
    while True:
        start = time.perf_counter()
        result = action()
        seconds.append(time.perf_counter() - start)
        if len(seconds) >= repeats or seconds[-1] > patience:
            return result, Times(seconds)


def frames(points: Floats, faces: Ints) -> Floats:
    """(m, 2, 2): the two edges of each triangle as columns, in mm, in its own plane."""
    first = points[faces[:, 1]] - points[faces[:, 0]]
    second = points[faces[:, 2]] - points[faces[:, 0]]
    along = np.linalg.norm(first, axis=1)
    x = np.einsum("ij,ij->i", first, second) / along
    y = np.sqrt(np.maximum(np.einsum("ij,ij->i", second, second) - x * x, 0.0))
    result = np.zeros((len(faces), 2, 2))
    result[:, 0, 0], result[:, 0, 1], result[:, 1, 1] = along, x, y
    return result


def flat_frames(flat: Floats, faces: Ints) -> Floats:
    """(m, 2, 2): the two edges of each triangle of the pattern as columns, in mm."""
    return np.stack(
        [flat[faces[:, 1]] - flat[faces[:, 0]], flat[faces[:, 2]] - flat[faces[:, 0]]], 2
    )


def stretches(points: Floats, faces: Ints, flat: Floats) -> tuple[Floats, Floats]:
    """Both principal stretches from the surface to the pattern, and each triangle's area in mm²."""
    surface = frames(points, faces)
    singular = np.linalg.svd(flat_frames(flat, faces) @ np.linalg.inv(surface), compute_uv=False)
    return singular, 0.5 * np.linalg.det(surface)


def stretch_rms(mesh: CutMesh, flat: Floats) -> float:
    """RMS of both principal stretches about 1, weighted by the area on the surface."""
    singular, area = stretches(mesh.points, mesh.faces, flat)
    return float(np.sqrt(np.average(((singular - 1.0) ** 2).mean(axis=1), weights=area)))


def true_scale(mesh: CutMesh, flat: Floats) -> Floats:
    """A pattern without scale (Blender's fills the unit square), at the scale of least stretch."""
    singular, area = stretches(mesh.points, mesh.faces, flat)
    weight = area[:, None]
    return flat * float((weight * singular).sum() / (weight * singular**2).sum())


def flips(faces: Ints, flat: Floats) -> int:
    """Triangles that lie the other way round than the most; also those without any area."""
    area = np.linalg.det(flat_frames(flat, faces))
    return int((area * np.sign(area.sum()) <= 0.0).sum())


def seam_mismatch(mesh: CutMesh, flat: Floats) -> tuple[float, float]:
    """Difference of a seam's two sides over their mean: the worst edge, the worst whole seam."""
    edge, whole = 0.0, 0.0
    for seam in mesh.seams:
        left, right = (
            np.linalg.norm(flat[side[:, 1]] - flat[side[:, 0]], axis=1)
            for side in (seam.left, seam.right)
        )
        edge = max(edge, float((2.0 * np.abs(left - right) / (left + right)).max()))
        whole = max(whole, float(2.0 * abs(left.sum() - right.sum()) / (left.sum() + right.sum())))
    return edge, whole


def warp_strain_error(mesh: CutMesh, flat: Floats, target: Floats) -> float:
    """RMS of (warp strain - target), weighted by the area in the pattern.

    flat: the pattern in mm, x along warp. target: a wanted strain per vertex.
    """
    drawn = flat_frames(flat, mesh.faces)
    along_warp = (frames(mesh.points, mesh.faces) @ np.linalg.inv(drawn))[:, :, 0]
    strain = np.linalg.norm(along_warp, axis=1) - 1.0
    error = strain - target[mesh.faces].mean(axis=1)
    return float(np.sqrt(np.average(error**2, weights=np.abs(np.linalg.det(drawn)))))


def moved_onto(flat: Floats, other: Floats, mirror: bool = False) -> Floats:
    """`flat` after the rigid motion that brings it closest to `other`; same vertices, in mm.

    With `mirror` it may be turned over as well.
    """
    from_centre, to_centre = flat.mean(axis=0), other.mean(axis=0)
    u, _, vt = np.linalg.svd((flat - from_centre).T @ (other - to_centre))
    turn = u @ vt
    if not mirror and np.linalg.det(turn) < 0.0:
        turn = u @ np.diag([1.0, -1.0]) @ vt
    moved: Floats = (flat - from_centre) @ turn + to_centre
    return moved


def apart(mesh: CutMesh, flat: Floats, other: Floats) -> tuple[float, float]:
    """Largest distance of a vertex in two patterns after the rigid motion, in mm: outline, all."""
    distance = np.linalg.norm(moved_onto(flat, other) - other, axis=1)
    return float(distance[boundary(mesh.faces)[:, 0]].max()), float(distance.max())


def growth(sizes: tuple[int, int], seconds: tuple[float, float]) -> float:
    """Exponent p of time ~ triangles^p between two sizes."""
    return float(np.log(seconds[1] / seconds[0]) / np.log(sizes[1] / sizes[0]))
