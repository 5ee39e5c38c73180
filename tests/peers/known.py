"""The measures against a slit tube, whose pattern is a rectangle: run before every measurement."""

from __future__ import annotations

import numpy as np

import measure
from meshes import CutMesh, Floats, find_seams

ROUND, ALONG, RADIUS, STEP = 40, 12, 30.0, 4.0


class MeasureError(Exception):
    """A measure does not give what is known."""


def tube() -> CutMesh:
    """A tube (a prism, in mm) slit along one line, and its exact pattern."""
    turn, level = np.meshgrid(np.arange(ROUND + 1), np.arange(ALONG + 1))
    angle = 2.0 * np.pi * (turn % ROUND) / ROUND
    side = 2.0 * RADIUS * np.sin(np.pi / ROUND)
    points = np.stack([RADIUS * np.cos(angle), RADIUS * np.sin(angle), STEP * level], axis=2)
    pattern = np.stack([side * turn, STEP * level], axis=2).reshape(-1, 2)
    index = np.arange(turn.size).reshape(turn.shape)
    low, next_low, high, next_high = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    halves = [(low, next_low, next_high), (low, next_high, high)]
    faces = np.concatenate([np.stack(half, axis=-1).reshape(-1, 3) for half in halves])
    points = points.reshape(-1, 3)
    return CutMesh(points, faces, pattern, find_seams(points, faces))


def check() -> None:
    """Raises `MeasureError` where a measure is wrong."""
    mesh = tube()
    flat = mesh.pattern
    narrow = flat / [1.2, 1.0]
    if [len(seam.left) for seam in mesh.seams] != [ALONG]:
        raise MeasureError(f"the slit tube has one seam of {ALONG} edges, found {mesh.seams}")
    longer = stretched_side(flat, 1.05)
    folded = flat.copy()
    folded[3 * (ROUND + 1) + 5] = flat[3 * (ROUND + 1) + 8]
    turned = flat @ np.array([[0.6, 0.8], [-0.8, 0.6]]) + 5.0
    targets = np.full(len(flat), 0.2)
    apart = 0.05 / 1.025
    for what, found, known in (
        ("stretch of the exact pattern", measure.stretch_rms(mesh, flat), 0.0),
        ("stretch", measure.stretch_rms(mesh, narrow), (1.0 - 1.0 / 1.2) / np.sqrt(2.0)),
        ("warp strain", measure.warp_strain_error(mesh, narrow, targets), 0.0),
        ("warp strain error", measure.warp_strain_error(mesh, narrow, targets / 2.0), 0.1),
        ("seam edge", measure.seam_mismatch(mesh, longer)[0], apart),
        ("whole seam", measure.seam_mismatch(mesh, longer)[1], apart),
        ("seam of the exact pattern", measure.seam_mismatch(mesh, flat)[0], 0.0),
        ("flips", measure.flips(mesh.faces, folded), 2),
        ("flips of a mirrored pattern", measure.flips(mesh.faces, flat * [-1.0, 1.0]), 0),
        ("a rigid motion", measure.apart(mesh, turned, flat)[1], 0.0),
        ("a mirror is no rigid motion", measure.apart(mesh, flat * [-1, 1], flat)[1] > 1.0, True),
        ("scale", np.abs(measure.true_scale(mesh, flat / 317.0) - flat).max(), 0.0),
        ("growth", measure.growth((10, 1000), (1.0, 1000.0)), 1.5),
    ):
        if abs(float(found) - float(known)) > 1e-9:
            raise MeasureError(f"{what}: {found}, known is {known}")


def stretched_side(flat: Floats, factor: float) -> Floats:
    """The pattern with one side of the slit longer by a factor."""
    longer = flat.copy()
    longer[ROUND :: ROUND + 1, 1] *= factor
    return longer
