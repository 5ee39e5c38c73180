"""MeshLab's own parametrizations of the same limb beside the pattern: how far each stretches the
surface and how far the two sides of the seam differ in length.

    python side_by_side.py     prints the table; ends with 1 if the pattern's seam does not match

All are laid on the very surface that the pattern was cut from (worn.obj), so that the seam is one
and the same. LSCM knows no scale: each of MeshLab's is scaled to the surface's area. The pattern is
stretched on purpose, by the wanted pressures; so one without pressures stands beside them, too.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import pymeshlab
import wovenfit
from limbs import sample

SEAM_TOLERANCE_MM = 0.1


def stretches(
    worn: np.ndarray, flat: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Both principal stretches from plane to limb, and the area on the limb, of every face."""
    a, b, c = (worn[faces[:, k]] for k in range(3))
    u = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    normal = np.cross(b - a, c - a)
    v = np.cross(normal / np.linalg.norm(normal, axis=1)[:, None], u)
    onto = np.stack(
        [np.stack([((p - a) * w).sum(1) for p in (b, c)], axis=-1) for w in (u, v)], axis=1
    )
    p, q, r = (flat[faces[:, k]] for k in range(3))
    plane = np.stack([q - p, r - p], axis=-1)
    singular = np.linalg.svd(onto @ np.linalg.inv(plane), compute_uv=False)
    return singular[:, 0], singular[:, 1], 0.5 * np.linalg.norm(normal, axis=1)


def figures(
    worn: np.ndarray, flat: np.ndarray, pattern: wovenfit.Pattern
) -> tuple[float, float, float]:
    """Root mean square of both strains, and the seam's mismatch: of the whole seam in mm, and the
    worst edge's as a share of it."""
    large, small, area = stretches(worn, flat, pattern.triangles)
    strain = np.sqrt((area * ((large - 1) ** 2 + (small - 1) ** 2)).sum() / (2 * area.sum()))
    whole, edge = 0.0, 0.0
    for seam in pattern.seams:
        left, right = (
            np.linalg.norm(np.diff(flat[side], axis=0), axis=1) for side in (seam.left, seam.right)
        )
        whole = max(whole, abs(left.sum() - right.sum()))
        edge = max(edge, float((np.abs(left - right) / np.maximum(left, right)).max()))
    return float(strain), whole, edge


def of_meshlab(pattern: wovenfit.Pattern, name: str) -> np.ndarray:
    """One of MeshLab's parametrizations, scaled to the area of the surface."""
    document = pymeshlab.MeshSet()
    document.add_mesh(pymeshlab.Mesh(pattern.positions, pattern.triangles.astype(np.int32)), "worn")
    document.apply_filter(name)
    flat = document.current_mesh().vertex_tex_coord_matrix()
    p, q, r = (flat[pattern.triangles[:, k]] for k in range(3))
    doubled = (q - p)[:, 0] * (r - p)[:, 1] - (q - p)[:, 1] * (r - p)[:, 0]
    *_, area = stretches(pattern.positions, pattern.coordinates, pattern.triangles)
    return flat * np.sqrt(area.sum() / (0.5 * abs(doubled.sum())))


def main() -> int:
    pymeshlab.load_plugin(str(Path(os.environ["WOVENFIT_MESHLAB_BUILD"]) / "libfilter_wovenfit.so"))
    with tempfile.TemporaryDirectory() as folder:
        limb = sample(Path(folder), 20_000)
        rows = []
        document = pymeshlab.MeshSet()
        document.add_mesh(pymeshlab.Mesh(limb.points, limb.faces), "arm")
        for label, values in (
            ("WovenFit, no pressures", {}),
            ("WovenFit, its pressures", {"design_file": str(limb.design_file)}),
        ):
            document.set_current_mesh(0)
            document.apply_filter("wovenfit_flatten_to_pattern", **values)
            flat = document.current_mesh().vertex_matrix()[:, :2]
            design = limb.design if values else wovenfit.Design()
            pattern = wovenfit.flatten(limb.points, limb.faces, design)
            rows.append((label, figures(pattern.positions, flat, pattern)))
            if not values:
                bare = pattern
        for label, name in (
            ("MeshLab LSCM", "compute_texcoord_parametrization_least_squares_conformal_maps"),
            ("MeshLab harmonic", "compute_texcoord_parametrization_harmonic"),
        ):
            rows.append((label, figures(bare.positions, of_meshlab(bare, name), bare)))
    print("elbow, 20,000 triangles       strain RMS   seam, whole   seam, worst edge")
    for label, (strain, whole, edge) in rows:
        print(f"{label:<28} {100 * strain:>9.1f} %   {whole:>8.2f} mm   {100 * edge:>14.1f} %")
    ours = [whole for label, (_, whole, _) in rows if label.startswith("WovenFit")]
    return 0 if max(ours) <= SEAM_TOLERANCE_MM else 1


if __name__ == "__main__":
    sys.exit(main())
