"""FreeCAD's own unwrap of the same limb beside the brace's pattern: time, strain and seams.

Printed as a table. FreeCAD's flatmesh knows no fabric and no seam; what is compared is the stretch
of the surface against a brace without wanted pressures, and whether the sides of the seam can be
sewn. Only sizes that must hold are checked, no times.
"""

from __future__ import annotations

import os
import sys
import time

sys.path.insert(0, os.environ["TESTS"])

import flatmesh
import FreeCAD
import limbs
import numpy as np
import wovenfit_freecad as tools
from harness import check, run_all


def stretches(solid: np.ndarray, plane: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
    """RMS of both principal stretches about 1, weighted by area, and the largest departure."""
    corners, flat = solid[triangles], plane[triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    ex = u / np.linalg.norm(u, axis=1)[:, None]
    normal = np.cross(u, v)
    area = np.linalg.norm(normal, axis=1) / 2
    ey = np.cross(normal / (2 * area)[:, None], ex)
    there = np.stack(
        [
            np.stack([(u * ex).sum(1), (v * ex).sum(1)], -1),
            np.stack([(u * ey).sum(1), (v * ey).sum(1)], -1),
        ],
        1,
    )
    here = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], -1)
    singular = np.linalg.svd(here @ np.linalg.inv(there), compute_uv=False)
    off = singular - 1
    rms = float(np.sqrt((area[:, None] * off**2).sum() / (2 * area.sum())))
    return rms, float(np.abs(off).max())


def sides(plane: np.ndarray, seam) -> tuple[np.ndarray, np.ndarray]:
    """Lengths of the edges of a seam's two sides."""
    return tuple(
        np.linalg.norm(np.diff(plane[side.astype(int)], axis=0), axis=1)
        for side in (seam.left, seam.right)
    )


@check
def the_same_limb_unwrapped_by_freecad():
    mesh, design = limbs.sample()
    document = FreeCAD.newDocument("Beside")
    scan = limbs.add_mesh(document, mesh)
    brace = tools.new_brace(document, scan)
    started = time.perf_counter()
    document.recompute()
    ours_seconds = time.perf_counter() - started
    assert brace.isValid(), brace.getStatusString()
    pattern = brace.Proxy.pattern(brace)
    solid, triangles = pattern.positions, pattern.triangles.astype(np.int64)
    started = time.perf_counter()
    unwrapper = flatmesh.FaceUnwrapper(solid, triangles)
    unwrapper.findFlatNodes(5, 0.95)
    theirs_seconds = time.perf_counter() - started
    theirs = np.array(unwrapper.ze_nodes)
    ours = np.array(pattern.coordinates)
    rows = [("wovenfit", ours_seconds, ours), ("FreeCAD flatmesh", theirs_seconds, theirs)]
    found = {}
    print()
    print(f"elbow, {len(triangles)} triangles, no pressures wanted, cut along the same seam")
    head = ("", "seconds", "stretch RMS", "stretch most", "seam edge", "seam whole")
    print("{:<18}{:>9}{:>13}{:>14}{:>11}{:>12}".format(*head))
    for name, seconds, plane in rows:
        rms, most = stretches(solid, plane, triangles)
        left, right = sides(plane, pattern.seams[0])
        edge = float(np.max(np.abs(left - right) / ((left + right) / 2)))
        whole = float(abs(left.sum() - right.sum()) / ((left.sum() + right.sum()) / 2))
        found[name] = rms, edge, whole
        print(f"{name:<18}{seconds:>9.2f}{rms:>13.4f}{most:>14.3f}{edge:>11.1%}{whole:>12.2%}")
    print("seconds: ours with surface check, cut, fit, report and drawing; theirs the unwrap alone")
    sys.stdout.flush()
    # Ours can be sewn, edge by edge; theirs cannot. Both stretch the limb little.
    assert found["wovenfit"][1] < 0.01 and found["wovenfit"][2] < 0.001, found
    assert found["FreeCAD flatmesh"][1] > 0.05, found
    assert found["wovenfit"][0] < 1.1 * found["FreeCAD flatmesh"][0], found


run_all()
