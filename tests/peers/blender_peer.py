"""Blender's minimum-stretch unwrap (SLIM inside), in a process of its own.

Blender's module takes over the process that imports it, and a crash must not end the measurement.
Started as `python blender_peer.py IN.npz OUT.npz REPEATS PATIENCE` it is that process.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from measure import Times, true_scale
from meshes import CutMesh, Floats, Ints

STEPS = 10
MISSING = (
    "bpy is missing: `python -m pip install bpy==4.5.15` (Python 3.11), or leave --with-bpy out"
)


class BlenderError(Exception):
    """Blender gave no pattern; the message says why."""


def minimum_stretch(mesh: CutMesh, repeats: int, patience: float) -> tuple[Floats, Times]:
    """The pattern in mm, at the scale of least stretch, and its times.

    Blender makes its own start and packs the result, both inside the time.
    """
    with tempfile.TemporaryDirectory(prefix="wovenfit-peers-") as folder:
        given, made = Path(folder, "mesh.npz"), Path(folder, "uv.npz")
        np.savez(given, points=mesh.points, faces=mesh.faces)
        command = [sys.executable, __file__, str(given), str(made), str(repeats), str(patience)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if not made.exists():
            last = (done.stderr or done.stdout).strip().splitlines()[-1:]
            raise BlenderError(f"Blender ended with {done.returncode}: {' '.join(last)}")
        with np.load(made) as result:
            return true_scale(mesh, result["uv"]), Times(result["seconds"].tolist())


def unwrap(
    points: Floats, faces: Ints, repeats: int, patience: float
) -> tuple[Floats, list[float]]:
    """Runs the unwrap in this process: UV coordinates (unit square) by vertex, and seconds."""
    try:
        import bpy
    except ImportError:
        sys.exit(MISSING)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    data = bpy.data.meshes.new("limb")
    data.from_pydata(points.tolist(), [], faces.tolist())
    data.uv_layers.new(name="pattern")
    limb = bpy.data.objects.new("limb", data)
    bpy.context.collection.objects.link(limb)
    bpy.context.view_layer.objects.active = limb
    limb.select_set(True)
    seconds: list[float] = []
    while True:
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        start = time.perf_counter()
        bpy.ops.uv.unwrap(
            method="MINIMUM_STRETCH", iterations=STEPS, fill_holes=False, correct_aspect=False
        )
        seconds.append(time.perf_counter() - start)
        bpy.ops.object.mode_set(mode="OBJECT")
        if len(seconds) >= repeats or seconds[-1] > patience:
            break
    corner_uv = np.zeros(2 * len(data.loops))
    data.uv_layers.active.data.foreach_get("uv", corner_uv)
    corner = np.zeros(len(data.loops), dtype=np.int32)
    data.loops.foreach_get("vertex_index", corner)
    uv = np.zeros((len(points), 2))
    uv[corner] = corner_uv.reshape(-1, 2)
    return uv, seconds


def main() -> None:
    """The process that has Blender in it."""
    given, made, repeats, patience = sys.argv[1:5]
    with np.load(given) as mesh:
        uv, seconds = unwrap(mesh["points"], mesh["faces"], int(repeats), float(patience))
    np.savez(made, uv=uv, seconds=np.array(seconds))


if __name__ == "__main__":
    main()
