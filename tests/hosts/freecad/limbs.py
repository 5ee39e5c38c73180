"""Limbs for the checks: a prism with known answers, and the sample that the program made."""

from __future__ import annotations

import json
import math
from pathlib import Path

import FreeCAD
import Mesh
import numpy as np
from harness import SCRATCH

RADIUS, LENGTH, SIDES, RINGS = 45.0, 90.0, 48, 25


def prism(radius: float = RADIUS, length: float = LENGTH) -> Mesh.Mesh:
    """A tube open at both ends, axis z, whose vertices lie on a cylinder; rows are turned by half a
    side against each other."""
    triangles = []

    def at(k: int, j: int) -> tuple[float, float, float]:
        angle = 2 * math.pi * (j + 0.5 * (k % 2)) / SIDES
        height = length * (1 - k / (RINGS - 1))
        return radius * math.cos(angle), radius * math.sin(angle), height

    for k in range(RINGS - 1):
        for j in range(SIDES):
            shift = k % 2
            a, b = at(k, j), at(k, j + 1)
            left, right = at(k + 1, j + shift - 1), at(k + 1, j + shift)
            triangles += [[a, left, right], [a, right, b]]
    return Mesh.Mesh(triangles)


def girth(radius: float = RADIUS) -> float:
    """The prism's girth in mm."""
    return 2 * SIDES * radius * math.sin(math.pi / SIDES)


def on_prism(angle: float, height: float) -> tuple[float, float, float]:
    """A place of the cylinder."""
    return RADIUS * math.cos(angle), RADIUS * math.sin(angle), height


def add_mesh(document, mesh: Mesh.Mesh, name: str = "Scan"):
    """The mesh as an object."""
    scan = document.addObject("Mesh::Feature", name)
    scan.Mesh = mesh
    return scan


def sample() -> tuple[Mesh.Mesh, str]:
    """The sample elbow with its design, made by the program before."""
    design = (SCRATCH / "elbow.design.json").read_text(encoding="utf-8")
    return Mesh.Mesh(str(SCRATCH / "elbow.obj")), design


def arrays(mesh: Mesh.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Points and facets of a mesh."""
    points, facets = mesh.Topology
    return np.array([(p.x, p.y, p.z) for p in points]), np.array(facets, np.int64)


def write_ply(path: Path, mesh: Mesh.Mesh) -> None:
    """The same numbers, in 64 bits, as a binary PLY file."""
    points, facets = arrays(mesh)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(facets)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(facets), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, facets
    path.write_bytes(header.encode() + points.astype("<f8").tobytes() + faces.tobytes())


def wires(pattern) -> list[np.ndarray]:
    """The corners of the closed wires of a pattern, in its own frame, in the order of the shape."""
    shape = pattern.Shape.copy()
    shape.Placement = FreeCAD.Placement()
    found = []
    for wire in shape.Wires:
        if wire.isClosed():
            found.append(np.array([(v.X, v.Y, v.Z) for v in wire.OrderedVertexes]))
    return found


def report(folder: Path) -> dict:
    """The report that the program wrote."""
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))
