"""Debian's MeshLab 2020.09 with our plugin beside its own; its scripts and what it writes.

MeshLab looks for plugins where its program lies, so the program is copied and the rest linked.
"""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import wovenfit

OWN = Path("/usr/lib/x86_64-linux-gnu/meshlab")
FLATTEN = "WovenFit: Flatten to Pattern"
CHECK = "WovenFit: Check Surface"
CHECKED = ("units", "keep_largest", "close_holes", "curvature", "curvature_radius", "girth_step")
FABRIC = ("warp", "weft", "diagonal", "max_strain")


def tree(folder: Path, plugins: list[Path]) -> Path:
    """A MeshLab with these plugins; where its programs are."""
    programs, library = folder / "bin", folder / "lib/x86_64-linux-gnu/meshlab"
    programs.mkdir(parents=True)
    (library / "plugins").mkdir(parents=True)
    for program in ("meshlab", "meshlabserver"):
        shutil.copy(Path("/usr/bin") / program, programs)
    (library / "libmeshlab-common.so").symlink_to(OWN / "libmeshlab-common.so")
    for plugin in [*(OWN / "plugins").glob("*.so"), *plugins]:
        (library / "plugins" / plugin.name).symlink_to(plugin)
    return programs


@dataclass(frozen=True)
class Ran:
    code: int
    said: str


def environment(home: Path, **more: str) -> dict[str, str]:
    home.mkdir(mode=0o700, exist_ok=True)
    return {
        **os.environ,
        "HOME": str(home),
        "XDG_RUNTIME_DIR": str(home),
        "LIBGL_ALWAYS_SOFTWARE": "1",
        **more,
    }


def serve(programs: Path, *arguments: str, **more: str) -> Ran:
    """Runs meshlabserver."""
    command = [
        "xvfb-run",
        "-a",
        "-s",
        "-screen 0 1280x900x24",
        str(programs / "meshlabserver"),
        *arguments,
    ]
    done = subprocess.run(
        command,
        env=environment(programs.parent / "home", **more),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        check=False,
    )
    return Ran(done.returncode, done.stdout)


def script(file: Path, *filters: str) -> str:
    """A MeshLab script of these filters."""
    file.write_text(
        "<!DOCTYPE FilterScript>\n<FilterScript>\n" + "\n".join(filters) + "\n</FilterScript>\n"
    )
    return str(file)


def filter_of(name: str, *parameters: tuple[str, str, object]) -> str:
    """A filter of a script; parameters are name, type and value."""
    rows = []
    for key, kind, value in parameters:
        shown = str(value).lower() if isinstance(value, bool) else str(value)
        more = ' exts_cardinality="1" exts_val0="*"' if kind == "RichOpenFile" else ""
        more = ' enum_cardinality="0"' if kind == "RichEnum" else more
        rows.append(
            f"<Param name={quoteattr(key)} type={quoteattr(kind)} value={quoteattr(shown)}{more}/>"
        )
    return f"<filter name={quoteattr(name)}>{''.join(rows)}</filter>"


def table_row(row: wovenfit.Parameter, value: object) -> tuple[str, str, object]:
    if row.choices:
        return row.name, "RichEnum", row.choices.index(str(value))
    kind = {bool: "RichBool", int: "RichInt"}.get(type(row.default), "RichFloat")
    return row.name, kind, value


def flatten_filter(**values: object) -> str:
    """Our filter with these values; the rest has its default. All must stand in a script."""
    own = [
        ("design_file", "RichOpenFile", ""),
        ("picked_points_file", "RichOpenFile", ""),
        ("pressures_from_quality", "RichBool", False),
        ("quality_scale", "RichFloat", 1),
        ("pressure_unit", "RichEnum", 0),
        ("selected_faces_only", "RichBool", False),
        ("field", "RichEnum", 0),
        ("output_folder", "RichString", ""),
        ("pattern_formats", "RichString", "svg"),
        ("pattern_unit", "RichEnum", 0),
        *((f"fabric_{name}", "RichString", "") for name in FABRIC),
    ]
    rows = [(name, kind, values.pop(name, value)) for name, kind, value in own]
    rows += [
        table_row(row, values.pop(row.name, row.default)) for row in wovenfit.parameter_table()
    ]
    assert not values, values
    return filter_of(FLATTEN, *rows)


def check_filter(**values: object) -> str:
    rows = [row for row in wovenfit.parameter_table() if row.name in CHECKED]
    return filter_of(CHECK, *(table_row(row, values.get(row.name, row.default)) for row in rows))


@dataclass(frozen=True)
class Ply:
    """What MeshLab has written."""

    vertices: np.ndarray
    """A record for each vertex."""
    faces: np.ndarray
    texture: list[tuple[float, ...]]
    flags: list[int]

    @property
    def points(self) -> np.ndarray:
        return np.stack([self.vertices[axis] for axis in "xyz"], axis=1).astype(float)


TYPES = {
    "char": "b",
    "uchar": "B",
    "short": "h",
    "ushort": "H",
    "int": "i",
    "uint": "I",
    "float": "f",
    "double": "d",
}


def read_ply(file: Path) -> Ply:
    """Reads a binary little-endian PLY."""
    header, body = file.read_bytes().split(b"end_header\n", 1)
    lines = [line.split() for line in header.decode().splitlines()]
    assert ["format", "binary_little_endian", "1.0"] in lines
    counts: dict[str, int] = {}
    properties: dict[str, list[list[str]]] = {}
    for line in lines:
        if line[0] == "element":
            element = line[1]
            counts[element], properties[element] = int(line[2]), []
        elif line[0] == "property":
            properties[element].append(line[1:])
    record = np.dtype([(name, "<" + TYPES[kind]) for kind, name in properties["vertex"]])
    vertices = np.frombuffer(body, record, counts["vertex"])
    at = record.itemsize * counts["vertex"]
    faces, texture, flags = [], [], []
    for _ in range(counts.get("face", 0)):
        for row in properties["face"]:
            if row[0] == "list":
                (count,) = struct.unpack_from("<" + TYPES[row[1]], body, at)
                at += struct.calcsize(TYPES[row[1]])
                kind = f"<{count}{TYPES[row[2]]}"
                values = struct.unpack_from(kind, body, at)
                at += struct.calcsize(kind)
                (texture if row[3] == "texcoord" else faces).append(values)
            else:
                (value,) = struct.unpack_from("<" + TYPES[row[0]], body, at)
                at += struct.calcsize(TYPES[row[0]])
                if row[1] == "flags":
                    flags.append(value)
    return Ply(vertices, np.array(faces), texture, flags)
