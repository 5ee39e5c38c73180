"""wovenfit, run from outside: limbs, patterns, times and memory."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from measure import Times
from meshes import CutMesh, Floats, read_worn

ROOT = Path(__file__).resolve().parents[2]
PAPERS = ("--equal-seams=false", "--correct-pressures=false")
NO_STAGES = (
    "this wovenfit has no `stages.fit` in its JSON: its times are the whole of the core's flatten "
    "(validation, cut, curvature, parameterization, fit, mapping, report), not the fit alone"
)


class ProgramError(Exception):
    """The program cannot be had, or ended badly; the message says what to do."""


@dataclass(frozen=True)
class Limb:
    """A sample limb on disk: the scan, its design, its number of triangles."""

    name: str
    scan: Path
    design: Path
    triangles: int


@dataclass(frozen=True)
class Run:
    """One pattern: the folder with its files, and what was measured.

    fit: seconds of the fit alone, or of the whole flatten in the core if `whole_fit`.
    total: seconds from reading to the written report, as the program says.
    wall, cpu: seconds of the whole process. peak_mib: largest resident memory.
    """

    out: Path
    summary: dict[str, Any]
    report: dict[str, Any]
    fit: Times
    whole_fit: bool
    total: Times
    wall: Times
    cpu: Times
    peak_mib: float

    def mesh(self) -> CutMesh:
        """The cut mesh with the pattern."""
        return read_worn(self.out / "worn.obj")

    def pressures(self) -> Floats:
        """Computed pressure at each annotated point, in kPa."""
        return np.array([point["got_kpa"] for point in self.summary["pressures"]])

    def rows(self, key: str) -> Floats:
        """A column of the strain function: `y_mm` (weft coordinate in mm), `t` or `strain`."""
        return np.array([row[key] for row in self.report["strain_function"]["rows"]])

    def energy_density(self) -> float:
        """J_E over the fabric's rest area, in N/mm: comparable between the methods.

        Newton's fabric is the pattern. The diffusion's is its whole cells, by Euler's formula
        springs - nodes + 1, the springs being warp's and weft's.
        """
        fit = self.report["fit"]
        if fit["method"] == "diffusion":
            cells = fit["springs"] - fit["nodes"] + 1
            return float(fit["energy"] / (cells * fit["spacing_mm"] ** 2))
        return float(fit["energy"] / self.report["pattern"]["area_mm2"])

    def down_at(self, density: float) -> int | None:
        """Newton's first step with J_E over the area at most `density` (N/mm).

        Of all vertices: the steps on fewer, from which it begins, are not limited and not counted.
        """
        area = self.report["pattern"]["area_mm2"]
        history = self.report["fit"]["history"]
        history = [entry for entry in history if entry["nodes"] == history[-1]["nodes"]]
        for entry in history:
            if entry["energy"] / area <= density:
                return max(int(entry["iteration"] - history[0]["iteration"]), 1)
        return None


class Program:
    """The program and a folder for what it writes."""

    def __init__(self, path: Path, folder: Path) -> None:
        """The program at `path`; everything that it writes goes into `folder`."""
        self.path = path
        self.folder = folder

    def sample(self, name: str, triangles: int) -> Limb:
        """Writes a limb of about so many triangles."""
        scan = self.folder / f"{name}-{triangles}.obj"
        self._run(["sample", name, "--triangles", str(triangles), "--out", str(scan)])
        with scan.open(encoding="ascii") as lines:
            count = sum(line.startswith("f ") for line in lines)
        return Limb(name, scan, scan.with_suffix(".design.json"), count)

    def flatten(
        self, limb: Limb, label: str, *options: str, repeats: int = 1, patience: float = np.inf
    ) -> Run:
        """Flattens up to `repeats` times, no more after a run longer than `patience` seconds."""
        out = self.folder / f"{limb.scan.stem}-{label}"
        command = [
            "flatten",
            str(limb.scan),
            "--design",
            str(limb.design),
            "--out",
            str(out),
            "--json",
            *options,
        ]
        fits: list[float] = []
        totals: list[float] = []
        walls: list[float] = []
        cpus: list[float] = []
        while True:
            text, wall, cpu, peak = self._run(command)
            summary = json.loads(text)
            seconds = summary["seconds"]
            stages = summary.get("stages") or seconds.get("stages") or {}
            fits.append(float(stages.get("fit", seconds["fit"])))
            totals.append(float(seconds["total"]))
            walls.append(wall)
            cpus.append(cpu)
            if len(walls) >= repeats or wall > patience:
                break
        report = json.loads((out / "report.json").read_text(encoding="utf-8"))
        return Run(
            out,
            summary,
            report,
            Times(fits),
            "fit" not in stages,
            Times(totals),
            Times(walls),
            Times(cpus),
            float(summary.get("peak_mib") or peak),
        )

    def _run(self, arguments: list[str]) -> tuple[str, float, float, float]:
        """Standard output, wall seconds, CPU seconds, MiB at most resident."""
        log = self.folder / "stderr.txt"
        start = time.perf_counter()
        with (
            log.open("wb") as errors,
            subprocess.Popen(
                [str(self.path), *arguments], stdout=subprocess.PIPE, stderr=errors
            ) as child,
        ):
            assert child.stdout is not None
            text = child.stdout.read().decode()
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        if child.returncode != 0:
            said = log.read_text(encoding="utf-8", errors="replace").strip()
            raise ProgramError(
                f"`wovenfit {' '.join(arguments)}` ended with {child.returncode}:\n{said}"
            )
        return text, wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0


def find(path: Path | None) -> Path:
    """The program: the one that was named, or the release build, built if it is missing."""
    if path is not None:
        if not path.is_file():
            raise ProgramError(
                f"{path}: there is no such program; leave --wovenfit out to build it"
            )
        return path.resolve()
    built = ROOT / "target" / "release" / "wovenfit"
    if not built.is_file():
        if shutil.which("cargo") is None:
            raise ProgramError(
                "cargo is missing: install Rust from https://rustup.rs, or name a "
                "built program with --wovenfit"
            )
        print("building wovenfit ...", flush=True)
        if subprocess.run(["cargo", "build", "--release"], cwd=ROOT, check=False).returncode != 0:
            raise ProgramError("`cargo build --release` failed: see above")
    return built
