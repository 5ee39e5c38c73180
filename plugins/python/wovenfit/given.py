"""From a pattern's answer on the given triangles back to a host's polygons and edges.

A host with polygons splits them before it gives its mesh, and wants texture coordinates for its own
corners afterwards, and the edges along which they are torn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import arrays

if TYPE_CHECKING:
    import numpy.typing as npt

    Doubles = npt.NDArray[np.float64]
    Indices = npt.NDArray[np.uint32]

_TORN = 0.5
"""Share of an edge's length from which two coordinates of one point lie on two sides of a cut.

On one side they differ by what a triangle through which the cut runs goes on linearly, a few per
cent; on two sides by the gap in the pattern, which is that small at the tip of a dart alone."""


def polygon_corners(
    coordinates: npt.ArrayLike,
    corners: npt.ArrayLike,
    polygons: npt.ArrayLike,
    places: npt.ArrayLike,
) -> Doubles:
    """(n, 2) pattern coordinates of the corners of polygons; NaN where the brace does not reach.

    A polygon through which the edge or a seam runs lies wholly on the side of its largest covered
    triangle and goes on linearly beyond, as a triangle does, so that it is not torn.

    Args:
        coordinates: (m, 3, 2) numbers: `Pattern.given_corner_coordinates`.
        corners: (m, 3) whole numbers, the polygons' corner that each triangle's corner is.
        polygons: (m,) whole numbers, the polygon of each triangle.
        places: (n, 3) numbers, where the corners are, in any unit.
    """
    flat = np.asarray(coordinates, np.float64)
    of_corner = arrays.indices(corners, (len(flat), 3), "corners")
    of_polygon = arrays.indices(polygons, (len(flat),), "polygons")
    at = arrays.numbers(places, ("n", 3), "places")

    # An array in any case, which `all` along an axis does not promise.
    covered = np.asarray(np.isfinite(flat).all(axis=(1, 2)))
    result = np.full((len(at), 2), np.nan)
    result[of_corner[covered]] = flat[covered]
    apart: Doubles = np.linalg.norm(result[of_corner] - flat, axis=2).max(axis=1)
    torn: npt.NDArray[np.bool_] = covered & (apart > _TORN * _longest_edges(flat))
    # A polygon that is covered in part has triangles of both kinds.
    in_part = np.intersect1d(of_polygon[covered], of_polygon[~covered])
    for polygon in np.union1d(of_polygon[torn], in_part):
        mine = np.flatnonzero(np.equal(of_polygon, polygon))
        there = mine[covered[mine]]
        leading = there[np.argmax(_areas(flat[there]))]
        all_corners = np.unique(of_corner[mine])
        result[all_corners] = _beyond(at[of_corner[leading]], flat[leading], at[all_corners])
    return result


def torn_edges(coordinates: npt.ArrayLike, triangles: npt.ArrayLike) -> Indices:
    """(k, 2) the edges between given triangles along which the pattern is cut, as vertices.

    They follow a seam to within a triangle. Edges at which the brace ends are not among them.

    Args:
        coordinates: (m, 3, 2) numbers: `Pattern.given_corner_coordinates`.
        triangles: (m, 3) whole numbers, the vertices of the given triangles.
    """
    flat = np.asarray(coordinates, np.float64)
    corners = arrays.indices(triangles, (len(flat), 3), "triangles").astype(np.int64)
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    values = np.stack([flat, np.roll(flat, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    # Every edge from its smaller vertex to its larger.
    backward = ends[:, 0] > ends[:, 1]
    ends[backward] = ends[backward, ::-1]
    values[backward] = values[backward, ::-1]
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    ends, values = ends[order], values[order]
    same: npt.NDArray[np.bool_] = (ends[1:] == ends[:-1]).all(axis=1)
    gap = np.linalg.norm(values[1:] - values[:-1], axis=2)
    length = np.linalg.norm(values[1:, 1] - values[1:, 0], axis=1)
    # What is not covered is NaN, which is not larger.
    torn: npt.NDArray[np.bool_] = same & (gap.max(axis=1) > _TORN * length)
    found: Indices = ends[1:][torn].astype(np.uint32)
    return found


def _longest_edges(flat: Doubles) -> Doubles:
    """(m,) the longest edge of each triangle of the pattern."""
    longest: Doubles = np.linalg.norm(flat - np.roll(flat, -1, axis=1), axis=2).max(axis=1)
    return longest


def _areas(flat: Doubles) -> Doubles:
    """(m,) the area of each triangle of the pattern."""
    first, second = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    areas: Doubles = 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    return areas


def _beyond(triangle: Doubles, flat: Doubles, places: Doubles) -> Doubles:
    """(n, 2) a triangle's linear map, (3, 3) to (3, 2), at places projected onto its plane."""
    sides = np.stack([triangle[1] - triangle[0], triangle[2] - triangle[0]])
    weights = (places - triangle[0]) @ np.linalg.pinv(sides)
    beyond: Doubles = flat[0] + weights @ np.stack([flat[1] - flat[0], flat[2] - flat[0]])
    return beyond
