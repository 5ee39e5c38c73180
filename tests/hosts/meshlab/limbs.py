"""What the tests of both MeshLabs share: a limb, its design, files of picked points."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[3]
PROGRAM = REPOSITORY / "target/release/wovenfit"
FILES = ("worn.obj", "flat.obj", "pattern.svg", "report.json", "report.html")


@dataclass(frozen=True)
class Limb:
    """A sample limb in mm, its coordinates rounded to 32 bits, as MeshLab 2020.09 keeps them."""

    points: np.ndarray
    faces: np.ndarray
    design_file: Path

    @property
    def design(self) -> dict[str, Any]:
        return json.loads(self.design_file.read_text())


def sample(folder: Path, triangles: int = 4000) -> Limb:
    """The sample elbow."""
    file = folder / "arm.obj"
    command = [str(PROGRAM), "sample", "elbow", "--triangles", str(triangles), "--out", str(file)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    lines = [line.split() for line in file.read_text().splitlines()]
    points = [[float(x) for x in line[1:4]] for line in lines if line[:1] == ["v"]]
    faces = [[int(c.split("/")[0]) - 1 for c in line[1:4]] for line in lines if line[:1] == ["f"]]
    rounded = np.array(points).astype(np.float32).astype(np.float64)
    return Limb(rounded, np.array(faces, dtype=np.int32), folder / "arm.design.json")


def write_ply(
    file: Path,
    points: np.ndarray,
    faces: np.ndarray,
    quality: np.ndarray | None = None,
    scalar: str = "float",
) -> Path:
    """A binary PLY as MeshLab reads it."""
    kind = {"float": "<f4", "double": "<f8"}[scalar]
    names = ["x", "y", "z"] + (["quality"] if quality is not None else [])
    columns = [*points.T] + ([quality] if quality is not None else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property {scalar} {name}" for name in names]
    header += [
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header\n",
    ]
    rows = np.empty(len(faces), dtype=[("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, faces
    body = np.stack(columns, axis=1).astype(kind).tobytes() + rows.tobytes()
    file.write_bytes("\n".join(header).encode() + body)
    return file


def write_obj(file: Path, points: np.ndarray, faces: np.ndarray) -> Path:
    """An OBJ with every digit."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    file.write_text("\n".join(lines) + "\n")
    return file


def write_points(
    file: Path, points: list[tuple[list[float], str]], inactive: tuple[int, ...] = ()
) -> Path:
    """A file as the PickPoints tool saves it."""
    rows = [
        f'<point x="{x!r}" y="{y!r}" z="{z!r}" active="{0 if i in inactive else 1}" name="{name}"/>'
        for i, ((x, y, z), name) in enumerate(points)
    ]
    document = '<DocumentData><templateName name="new Template"/></DocumentData>'
    file.write_text(
        f"<!DOCTYPE PickedPoints>\n<PickedPoints>\n{document}\n"
        + "\n".join(rows)
        + "\n</PickedPoints>\n"
    )
    return file


def command_line(folder: Path, mesh: Path, design: Path, *flags: str) -> Path:
    """The folder with what `wovenfit flatten` makes of these."""
    out = folder / "command-line"
    command = [
        str(PROGRAM),
        "flatten",
        str(mesh),
        "--design",
        str(design),
        "--out",
        str(out),
        "--quiet",
        *flags,
    ]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    return out


def differing(one: Path, other: Path) -> list[str]:
    """The files of a result that are not equal byte for byte."""
    return [name for name in FILES if (one / name).read_bytes() != (other / name).read_bytes()]


def flat(folder: Path) -> np.ndarray:
    """The points of flat.obj."""
    lines = (folder / "flat.obj").read_text().splitlines()
    return np.array(
        [[float(x) for x in line.split()[1:4]] for line in lines if line.startswith("v ")]
    )


def edited(folder: Path, design: dict[str, Any], **changes: Any) -> Path:
    """A design file with other values."""
    file = folder / "edited.json"
    file.write_text(json.dumps({**design, **changes}))
    return file
