"""Times wovenfit and its peers in one run, on the same cut meshes, and prints a table.

Usage: python tests/peers/run.py [--sizes 2000 20000 200000] [--limbs elbow wrist ankle]
[--with-bpy] [--json FILE]; README.md beside this file says what the columns mean.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import json
import os
import platform
import signal
import sys
import tempfile
from pathlib import Path
from typing import Any

NEEDED = ("numpy", "scipy", "igl")
REQUIREMENTS = Path(__file__).with_name("requirements.txt")

# The program's default distance of the diffusion's threads, and the triangles of a limb with edges as long.
EDGE_MM = 5.0, 5_000

try:
    import numpy as np

    import blender_peer
    import girth_trick
    import known
    import libigl_peers
    import measure
    import ours
    import table
    from criteria import judge
    from measure import Times
    from meshes import CutMesh, Floats
except ModuleNotFoundError as missing:
    if missing.name not in NEEDED:
        raise
    sys.exit(f"{missing.name} is missing: python -m pip install -r {os.path.relpath(REQUIREMENTS)}")

OUTLINE_MM = 0.1
PRESSURE_SHARE = 0.005
TIGHTER = 100.0


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--sizes",
        type=int,
        nargs="+",
        default=[2_000, 20_000, 200_000],
        help="triangles of each limb, about",
    )
    parser.add_argument(
        "--limbs",
        nargs="+",
        default=["elbow", "wrist", "ankle"],
        choices=["elbow", "knee", "wrist", "ankle", "forearm"],
    )
    parser.add_argument(
        "--whole",
        type=int,
        nargs="*",
        default=[20_000, 100_000, 250_000],
        help="triangles at which the first limb's whole flatten is timed; none "
        "after it: leave that out",
    )
    parser.add_argument(
        "--with-bpy",
        action="store_true",
        help="Blender's minimum-stretch unwrap too (needs the package bpy)",
    )
    parser.add_argument(
        "--diffusion-up-to",
        type=int,
        default=20_000,
        metavar="N",
        help="largest limb on which our own diffusion is timed",
    )
    parser.add_argument(
        "--diffusion-plateau",
        type=float,
        metavar="SHARE",
        help="the diffusion ends when J_E falls by less in 1,000 steps; default: the program's",
    )
    parser.add_argument(
        "--diffusion-spacing",
        type=float,
        nargs="+",
        metavar="MM",
        help="distances of the diffusion's threads; default: the program's, and the mesh's edges",
    )
    parser.add_argument("--repeats", type=int, default=3, help="runs of each, for the median")
    parser.add_argument(
        "--patience",
        type=float,
        default=30.0,
        metavar="SECONDS",
        help="what takes longer is not run again",
    )
    parser.add_argument(
        "--wovenfit",
        type=Path,
        metavar="PROGRAM",
        help="the program; default: target/release/wovenfit, built if missing",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure there")
    parser.add_argument(
        "--keep",
        type=Path,
        metavar="DIR",
        help="keep the limbs and patterns there, not in a temporary folder",
    )
    given = parser.parse_args()
    if given.repeats < 1:
        parser.error("--repeats must be 1 or more")
    if given.json and not given.json.resolve().parent.is_dir():
        parser.error(f"{given.json}: there is no such folder")
    return given


def figures(
    mesh: CutMesh, flat: Floats, times: Times, key: str, method: str, **more: Any
) -> dict[str, Any]:
    """One line of the table."""
    edge, whole = measure.seam_mismatch(mesh, flat)
    return {
        "key": key,
        "method": method,
        "seconds": times.as_json(),
        "stretch_rms": measure.stretch_rms(mesh, flat),
        "flips": measure.flips(mesh.faces, flat),
        "seam_edge": edge,
        "seam_whole": whole,
        **more,
    }


def tighter_check(
    program: ours.Program, limb: ours.Limb, run: ours.Run, method: str, *options: str
) -> dict[str, Any]:
    """The same pattern at a tolerance a hundred times smaller: does the run's time count?"""
    tolerance = float(run.report["parameters"]["newton_tolerance"]) / TIGHTER
    label = f"{run.out.name.removeprefix(limb.scan.stem + '-')}-tight"
    tight = program.flatten(limb, label, *options, "--newton-tolerance", f"{tolerance:g}")
    mesh = tight.mesh()
    outline, vertices = measure.apart(mesh, run.mesh().pattern, mesh.pattern)
    pressure = float(np.abs(run.pressures() / tight.pressures() - 1.0).max())
    converged = bool(run.summary["converged"] and tight.summary["converged"])
    return {
        "method": method,
        "tighter_mm": tolerance,
        "outline_mm": outline,
        "vertices_mm": vertices,
        "pressure": pressure,
        "converged": converged,
        "tight_fit_seconds": tight.fit.median,
        "counts": converged and outline <= OUTLINE_MM and pressure <= PRESSURE_SHARE,
    }


def measure_limb(
    program: ours.Program, name: str, size: int, given: argparse.Namespace
) -> dict[str, Any]:
    """Everything on one limb at one size."""
    limb = program.sample(name, size)
    often = {"repeats": given.repeats, "patience": given.patience}
    default = program.flatten(limb, "ours", **often)
    free = program.flatten(limb, "free", *ours.PAPERS, **often)
    mesh = default.mesh()
    heights, strains = free.rows("y_mm"), free.rows("strain")
    # The wanted strain, before any correction, at the place that a height of ours has.
    along = np.interp(mesh.pattern[:, 1], default.rows("y_mm"), default.rows("t"))
    wanted = np.interp(along, free.rows("t"), strains)
    corrected = np.interp(mesh.pattern[:, 1], default.rows("y_mm"), default.rows("strain"))
    corrected_error = measure.warp_strain_error(mesh, mesh.pattern, corrected)

    rows = [
        figures(
            mesh,
            mesh.pattern,
            default.fit,
            "ours",
            "wovenfit",
            strain_error=measure.warp_strain_error(mesh, mesh.pattern, wanted),
            strain_error_corrected=corrected_error,
            remark=f"{corrected_error:.4f} from the corrected strains",
            total=default.total.as_json(),
            cpu=default.cpu.as_json(),
            steps=default.report["fit"]["iterations"],
            peak_mib=default.peak_mib,
        ),
    ]
    free_mesh = free.mesh()
    rows.append(
        figures(
            free_mesh,
            free_mesh.pattern,
            free.fit,
            "ours_free",
            "wovenfit, free seams, uncorrected",
            strain_error=measure.warp_strain_error(
                free_mesh, free_mesh.pattern, np.interp(free_mesh.pattern[:, 1], heights, strains)
            ),
            total=free.total.as_json(),
            cpu=free.cpu.as_json(),
            steps=free.report["fit"]["iterations"],
            peak_mib=free.peak_mib,
        )
    )
    checks = [
        tighter_check(program, limb, default, "wovenfit"),
        tighter_check(program, limb, free, "wovenfit, free seams, uncorrected", *ours.PAPERS),
    ]

    rows += peers(mesh, heights, strains, wanted, given)
    diffusion = []
    if size <= given.diffusion_up_to:
        edge = EDGE_MM[0] * (EDGE_MM[1] / size) ** 0.5
        plateau = given.diffusion_plateau
        options = ["--plateau", f"{plateau:g}"] if plateau else []
        for spacing in given.diffusion_spacing or dict.fromkeys([EDGE_MM[0], edge]):
            slow = program.flatten(
                limb,
                f"diffusion-{spacing:g}",
                "--method",
                "diffusion",
                "--spacing",
                f"{spacing:g}",
                *options,
                *ours.PAPERS,
                **often,
            )
            slow_mesh = slow.mesh()
            target = np.interp(slow_mesh.pattern[:, 1], slow.rows("y_mm"), slow.rows("strain"))
            rows.append(
                figures(
                    slow_mesh,
                    slow_mesh.pattern,
                    slow.fit,
                    "diffusion",
                    f"our diffusion, {spacing:.3g} mm, to its plateau",
                    strain_error=measure.warp_strain_error(slow_mesh, slow_mesh.pattern, target),
                    steps=slow.report["fit"]["iterations"],
                )
            )
            found = same_energy(program, limb, free, slow, given)
            diffusion.append(found | {"spacing_mm": spacing, "as_fine": spacing <= 1.01 * edge})
    for row in rows:
        against = "ours_free" if row["key"] == "diffusion" else "ours"
        reference = next(other for other in rows if other["key"] == against)
        if "seconds" in row:
            row["ratio"] = row["seconds"]["median"] / reference["seconds"]["median"]
        if row["key"] == "diffusion":
            row["remark"] = "ratio to free seams, uncorrected"
    return {
        "limb": name,
        "asked_triangles": size,
        "triangles": limb.triangles,
        "cut_triangles": len(mesh.faces),
        "fit_alone": not default.whole_fit,
        "methods": rows,
        "checks": checks,
        "diffusion": diffusion,
    }


def same_energy(
    program: ours.Program, limb: ours.Limb, run: ours.Run, slow: ours.Run, given: argparse.Namespace
) -> dict[str, Any]:
    """Ours and the diffusion at the diffusion's last J_E over the fabric's area.

    Ours is run again with as many steps as it takes to get below that, and timed: more often than the others,
    for so short a time scatters by a quarter.
    """
    densities = run.energy_density(), slow.energy_density()
    found: dict[str, Any] = {
        "ours_density": densities[0],
        "diffusion_density": densities[1],
        "above": densities[1] / densities[0] - 1.0,
    }
    step = run.down_at(densities[1])
    if step is not None:
        options = ("--newton-steps", str(step), *ours.PAPERS)
        short = program.flatten(
            limb, "down", *options, repeats=5 * given.repeats, patience=given.patience
        )
        found |= {
            "step": step,
            "steps": run.report["fit"]["iterations"],
            "ours_seconds": short.fit.median,
            "ratio": slow.fit.median / short.fit.median,
        }
    return found


def peers(
    mesh: CutMesh, heights: Floats, strains: Floats, wanted: Floats, given: argparse.Namespace
) -> list[dict[str, Any]]:
    """The others, on the same cut mesh."""
    points, faces = mesh.points, mesh.faces
    rows: list[dict[str, Any]] = []
    _, lscm_times = measure.timed(
        lambda: libigl_peers.lscm(points, faces), given.repeats, given.patience
    )
    begin = libigl_peers.start(points, faces)
    if begin.method == "LSCM":
        rows.append(figures(mesh, begin.flat, lscm_times, "lscm", "libigl LSCM, the start"))
    else:
        rows.append(
            {
                "key": "lscm",
                "method": "libigl LSCM",
                "failed": f"no usable start; ARAP and SLIM start from {begin.method}",
            }
        )
    flat, times = measure.timed(
        lambda: libigl_peers.arap(points, faces, begin.flat), given.repeats, given.patience
    )
    rows.append(figures(mesh, flat, times, "arap", f"libigl ARAP, {libigl_peers.ARAP_STEPS} steps"))
    flat, times = measure.timed(
        lambda: libigl_peers.slim(points, faces, begin.flat), given.repeats, given.patience
    )
    rows.append(figures(mesh, flat, times, "slim", f"libigl SLIM, {libigl_peers.SLIM_STEPS} steps"))

    if given.with_bpy:
        method = f"Blender minimum stretch, {blender_peer.STEPS} steps"
        try:
            flat, times = blender_peer.minimum_stretch(mesh, given.repeats, given.patience)
            rows.append(figures(mesh, flat, times, "blender", method, remark="with its own start"))
        except blender_peer.BlenderError as failure:
            rows.append({"key": "blender", "method": method, "failed": str(failure)})

    along = girth_trick.along_limb(mesh)
    narrow = girth_trick.shrunk(mesh, along, wanted)
    narrow_begin = libigl_peers.start(narrow, faces)
    flat, times = measure.timed(
        lambda: girth_trick.trick(mesh, along, wanted, narrow_begin.flat),
        given.repeats,
        given.patience,
    )
    rows.append(
        figures(
            mesh,
            flat,
            times,
            "trick",
            "girth shrunk, then ARAP",
            strain_error=girth_trick.strain_error(mesh, flat, wanted, heights, strains),
        )
    )
    return rows


def measure_whole(
    program: ours.Program, name: str, size: int, given: argparse.Namespace
) -> dict[str, Any]:
    """The whole of `flatten` at one size."""
    limb = program.sample(name, size)
    run = program.flatten(limb, "whole", repeats=given.repeats, patience=given.patience)
    return {
        "limb": name,
        "asked_triangles": size,
        "triangles": limb.triangles,
        "seconds": run.total.as_json(),
        "wall": run.wall.as_json(),
        "cpu": run.cpu.as_json(),
        "peak_mib": run.peak_mib,
        "pressures": len(run.pressures()),
        "stages": stage_seconds(run.summary),
    }


def stage_seconds(summary: dict[str, Any]) -> dict[str, float]:
    """Seconds of every stage from reading to writing; of the core as a whole if it has no more."""
    seconds = summary["seconds"]
    core = summary.get("stages") or {"core": seconds["fit"]}
    return {"read": seconds["read"], **core, "write": seconds["write"]}


def versions(given: argparse.Namespace) -> dict[str, str]:
    """What was measured with."""
    packages = ["libigl", "numpy", "scipy"] + (["bpy"] if given.with_bpy else [])
    return {
        "python": platform.python_version(),
        **{package: importlib.metadata.version(package) for package in packages},
    }


def load() -> float:
    """How many processes wanted a core in the last minute."""
    return os.getloadavg()[0]


def run(given: argparse.Namespace, folder: Path) -> dict[str, Any]:
    """Measures and prints; returns every figure."""
    known.check()
    program = ours.Program(ours.find(given.wovenfit), folder)
    before = load()
    limbs: list[dict[str, Any]] = []
    print(f"{os.cpu_count()} cores, load {before:.1f} before; {given.repeats} runs of each")
    for size in given.sizes:
        for name in given.limbs:
            limbs.append(measure_limb(program, name, size, given))
            if not limbs[0]["fit_alone"] and len(limbs) == 1:
                print(f"remark: {ours.NO_STAGES}")
            print(table.limb_table(limbs[-1]), flush=True)
    whole = [measure_whole(program, given.limbs[0], size, given) for size in given.whole]
    if whole:
        print(table.whole_table(whole))
    criteria = judge(limbs, whole)
    if criteria:
        print(table.criteria_table(criteria))
    after = load()
    print(
        f"\n{table.LEGEND}\nload {before:.1f} before, {after:.1f} after: "
        + (
            "times of a busy machine, see min and max"
            if max(before, after) > 1.5
            else "a quiet machine"
        )
    )
    return {
        "versions": versions(given),
        "cores": os.cpu_count(),
        "load_before": before,
        "load_after": after,
        "limbs": limbs,
        "whole": whole,
        "criteria": criteria,
    }


def main() -> None:
    """The command."""
    # Ended from outside, it still removes its temporary folder.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended"))
    given = arguments()
    if given.with_bpy and importlib.util.find_spec("bpy") is None:
        sys.exit(blender_peer.MISSING)
    try:
        if given.keep:
            given.keep.mkdir(parents=True, exist_ok=True)
            found = run(given, given.keep)
        else:
            with tempfile.TemporaryDirectory(prefix="wovenfit-peers-") as folder:
                found = run(given, Path(folder))
    except ours.ProgramError as failure:
        sys.exit(str(failure))
    if given.json:
        given.json.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
