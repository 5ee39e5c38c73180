"""Blender's own unwrap beside ours, on the same cut limb: strain and seam mismatch, as a table.

Run as run.py is, in a Blender that has all three of its methods (4.3 and later). What is measured
and how stands in tests/peers/README.md, whose measures these are.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "peers")]

import bpy  # noqa: E402  Blender's module, after the path
import measure  # noqa: E402
import numpy as np  # noqa: E402
import scene  # noqa: E402
from install import install  # noqa: E402
from meshes import CutMesh, find_seams  # noqa: E402

METHODS = {
    "Blender LSCM": {"method": "CONFORMAL"},
    "Blender ABF": {"method": "ANGLE_BASED"},
    "Blender minimum stretch": {"method": "MINIMUM_STRETCH", "iterations": 10},
}
STIFFNESS = 0.5
"""Of the default fabric along warp, in N/mm."""


def unwrapped(cut, options):
    """The pattern in mm, at the scale of least stretch, turned as ours is."""
    limb = scene.place(cut.points / 1000.0, cut.faces, "cut")
    mesh = limb.data
    mesh.uv_layers.new(name="own")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.unwrap(fill_holes=False, correct_aspect=False, **options)
    bpy.ops.object.mode_set(mode="OBJECT")
    corner = scene.corner_uv(mesh, "own")
    flat = np.zeros((len(cut.points), 2))
    flat[[loop.vertex_index for loop in mesh.loops]] = corner
    return measure.moved_onto(measure.true_scale(cut, flat), cut.pattern, mirror=True)


def warp_strains(cut, flat, vertices):
    """Strain along warp at vertices: the mean over their triangles."""
    along = measure.frames(cut.points, cut.faces) @ np.linalg.inv(
        measure.flat_frames(flat, cut.faces)
    )
    by_face = np.linalg.norm(along[:, :, 0], axis=1) - 1.0
    return np.array([by_face[(cut.faces == v).any(axis=1)].mean() for v in vertices])


def main():
    scene.module_name = install()
    scene.clear()
    scene.pinned_arm()
    pattern = scene.flatten().pattern
    faces = pattern.triangles.astype(np.int64)
    cut = CutMesh(
        pattern.positions, faces, pattern.coordinates, find_seams(pattern.positions, faces)
    )
    rows = pattern.pressures
    points = [int(np.argmin(np.linalg.norm(cut.points - np.array(row.at), axis=1))) for row in rows]
    # Laplace's law: the strain that gives the pressure where the limb has this curvature.
    wanted = np.array([row.asked_kpa / (STIFFNESS * row.warp_curvature_per_m) for row in rows])

    patterns = {"wovenfit": cut.pattern}
    patterns.update({name: unwrapped(cut, options) for name, options in METHODS.items()})
    print()
    print(f"elbow, {len(faces)} triangles, warp strain at its {len(rows)} pressures")
    print(f"{'':26}{'seam edge':>10}{'whole seam':>12}{'stretch':>9}{'flips':>7}  at the points")
    print(f"{'wanted':64}  " + "  ".join(f"{100 * x:5.1f} %" for x in wanted))
    found = {}
    for name, flat in patterns.items():
        edge, whole = measure.seam_mismatch(cut, flat)
        strains = warp_strains(cut, flat, points)
        found[name] = edge, whole, float(np.abs(strains - wanted).max())
        print(
            f"{name:26}{100 * edge:8.2f} %{100 * whole:10.2f} %"
            f"{measure.stretch_rms(cut, flat):9.3f}{measure.flips(cut.faces, flat):7}  "
            + "  ".join(f"{100 * x:5.1f} %" for x in strains)
        )
    print(
        "seam edge, whole seam: difference of the two sides over their mean; stretch: RMS about 1, "
        "which ours wants at the pressures"
    )

    failed = []
    edge, whole, off = found.pop("wovenfit")
    # A tenth of a millimetre on a seam of 220 mm.
    if whole > 0.1 / 220 or edge > 0.02:
        failed.append(f"our seam: {edge}, {whole}")
    if off > 0.03:
        failed.append(f"our strain is off by {off}")
    for name, (their_edge, _, their_off) in found.items():
        if their_edge < 2 * edge:
            failed.append(f"{name} has seams as equal as ours")
        if their_off < 2 * off:
            failed.append(f"{name} has the wanted strains")
    for one in failed:
        print(f"FAILED: {one}")
    checks = 2 + 2 * len(found)
    print(
        f"beside Blender {bpy.app.version_string}: "
        f"{checks - len(failed)} passed, {len(failed)} failed"
    )
    sys.stdout.flush()
    os._exit(1 if failed else 0)


main()
