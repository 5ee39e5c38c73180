"""Surfaces with known answers, and mesh files, written anew for these tests."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Tube(NamedTuple):
    """A prism of `sides` sides, open at both ends, with axis z; its vertices lie on a cylinder."""

    positions: NDArray[np.float64]
    triangles: NDArray[np.uint32]
    radius: float
    length: float
    sides: int

    @property
    def girth(self) -> float:
        """The polygon's, which the mesh has."""
        return 2 * self.sides * self.radius * math.sin(math.pi / self.sides)

    def at(self, angle: float, height: float) -> list[float]:
        """A point of the cylinder, a hair outside of the prism."""
        return [self.radius * math.cos(angle), self.radius * math.sin(angle), height]

    def ring(self, index: int) -> NDArray[np.uint32]:
        """The vertices of a ring; ring 0 is the upper end."""
        return np.arange(index * self.sides, (index + 1) * self.sides, dtype=np.uint32)


def tube(radius: float = 45.0, length: float = 90.0, sides: int = 48, rings: int = 25) -> Tube:
    """Rings of vertices from the upper end down, each turned by half a side."""
    k, j = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    angle = 2 * np.pi * (j + 0.5 * (k % 2)) / sides
    height = length * (1 - k / (rings - 1))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=-1)
    k, j = k[:-1], j[:-1]
    a, b = k * sides + j, k * sides + (j + 1) % sides
    below, shift = (k + 1) * sides, k % 2
    left, right = below + (j + shift - 1) % sides, below + (j + shift) % sides
    triangles = np.stack([a, left, right, a, right, b], axis=-1).reshape(-1, 3)
    return Tube(points.reshape(-1, 3), triangles.astype(np.uint32), radius, length, sides)


def arm(triangles: int) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """A bent, bulging, oval limb of about so many triangles, 230 mm long: no short work."""
    sides = round(math.sqrt(triangles / 2))
    rings = sides + 1
    k, j = np.meshgrid(np.arange(rings) / (rings - 1), np.arange(sides), indexing="ij")
    angle = 2 * np.pi * j / sides
    radius = 46 - 16 * k + 3 * np.cos(2 * angle + 1) + 3 * np.sin(7 * k) * np.cos(angle)
    bend = 0.9 * k  # radians in all, on an arc of 255 mm radius
    out = 255 + radius * np.cos(angle)
    points = np.stack([out * np.cos(bend), radius * np.sin(angle), -out * np.sin(bend)], axis=-1)
    row, column = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    a, b = row * sides + column, row * sides + (column + 1) % sides
    faces = np.stack([a, a + sides, b + sides, a, b + sides, b], axis=-1).reshape(-1, 3)
    return points.reshape(-1, 3), faces.astype(np.uint32)


def write_ply(path: Path, positions: NDArray[np.float64], triangles: NDArray[np.uint32]) -> None:
    """A binary PLY file with exactly these 64-bit numbers."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), np.dtype([("count", "u1"), ("corners", "<u4", 3)]))
    faces["count"] = 3
    faces["corners"] = triangles
    path.write_bytes(header.encode() + positions.astype("<f8").tobytes() + faces.tobytes())
