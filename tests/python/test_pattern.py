"""Results: shapes, known answers, and that arrays agree with each other and with the limb."""

from __future__ import annotations

import math

import numpy as np
import pytest
import wovenfit
from limbs import Tube
from numpy.typing import NDArray


@pytest.fixture(scope="module")
def pattern() -> wovenfit.Pattern:
    """The design of conftest on the tube, once for all that only look at it."""
    from limbs import tube

    limb = tube()
    design = {
        "fabric": {"warp": 0.5, "weft": 0.5, "diagonal": 0.05},
        "pressures": [{"at": limb.at(2.0, 45.0), "kpa": 2.0}],
    }
    return wovenfit.flatten(limb.positions, limb.triangles, design)


def width_of(pattern: wovenfit.Pattern) -> float:
    """How wide the pattern is half way up, from its arrays alone."""
    outline = np.concatenate([pattern.outlines[0], pattern.outlines[0][:1]])
    middle = outline[:, 1].mean()
    crossings = []
    for (x0, y0), (x1, y1) in zip(outline[:-1], outline[1:]):
        if (y0 < middle) != (y1 < middle):
            crossings.append(x0 + (middle - y0) / (y1 - y0) * (x1 - x0))
    assert len(crossings) == 2
    return abs(crossings[1] - crossings[0])


def area(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Signed areas of triangles in the plane."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return 0.5 * (ux * vy - uy * vx)


@pytest.mark.parametrize(("radius", "kpa", "warp"), [(45.0, 2.0, 0.5), (30.0, 3.0, 0.3)])
def test_a_cylinder_is_girth_over_one_plus_strain_wide(
    radius: float, kpa: float, warp: float
) -> None:
    from limbs import tube

    limb = tube(radius, 80.0)
    design = wovenfit.Design()
    design.set_fabric(warp=warp, weft=warp, diagonal=0.1 * warp)
    design.add_pressures([limb.at(2.0, 40.0)], kpa)
    pattern = wovenfit.flatten(limb.positions, limb.triangles, design)
    # Laplace's law: P = k e / r, 1 kPa = 1e-3 N/mm2.
    strain = kpa * 1e-3 * radius / warp
    assert width_of(pattern) == pytest.approx(limb.girth / (1 + strain), rel=0.01)
    assert pattern.figures.width_mm == pytest.approx(limb.girth / (1 + strain), rel=0.01)
    assert pattern.figures.height_mm == pytest.approx(80.0, rel=0.01)
    assert np.median(pattern.warp_strain) == pytest.approx(strain, rel=0.01)
    assert np.median(pattern.weft_strain) == pytest.approx(0.0, abs=0.005)
    assert np.median(pattern.pressure_kpa) == pytest.approx(kpa, rel=0.02)
    assert np.median(pattern.area_stretch) == pytest.approx(1 + strain, rel=0.01)


def test_shapes_are_as_stated_and_numbers_finite(pattern: wovenfit.Pattern, limb: Tube) -> None:
    # How many the cut makes is its own affair: it splits the seam's vertices and some triangles.
    v, t = len(pattern.positions), len(pattern.triangles)
    gv, gt = len(limb.positions), len(limb.triangles)
    assert gv + 25 <= v < gv + 100
    assert gt <= t < gt + 200
    shapes = {
        "coordinates": (v, 2),
        "corner_coordinates": (t, 3, 2),
        "positions": (v, 3),
        "warp_strain": (v,),
        "weft_strain": (v,),
        "area_stretch": (v,),
        "pressure_kpa": (v,),
        "friction": (v,),
        "vertex_weights": (v, 3),
        "given_corner_coordinates": (gt, 3, 2),
        "given_warp_strain": (gv,),
        "given_weft_strain": (gv,),
        "given_pressure_kpa": (gv,),
    }
    indices = {
        "triangles": (t, 3),
        "vertex_to_given_vertex": (v,),
        "vertex_to_given_triangle": (v,),
        "triangle_to_given_triangle": (t,),
    }
    for kind, wanted in ((np.float64, shapes), (np.uint32, indices)):
        for name, shape in wanted.items():
            array = getattr(pattern, name)
            assert (array.shape, array.dtype) == (shape, kind), name
            assert np.isfinite(array).any() if name == "friction" else np.isfinite(array).all()


def test_arrays_are_kept_and_cannot_be_written_to(pattern: wovenfit.Pattern) -> None:
    assert pattern.coordinates is pattern.coordinates
    with pytest.raises(ValueError, match="read-only"):
        pattern.coordinates[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        pattern.outlines[0][0, 0] = 1.0


def test_corners_are_the_vertices_coordinates_and_nothing_is_flipped(
    pattern: wovenfit.Pattern,
) -> None:
    assert np.array_equal(pattern.coordinates[pattern.triangles], pattern.corner_coordinates)
    areas = area(pattern.corner_coordinates)
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(pattern.figures.area_mm2, rel=1e-9)
    assert pattern.coordinates.min(axis=0) == pytest.approx([0, 0], abs=1e-9)
    assert pattern.coordinates.max(axis=0) == pytest.approx(
        [pattern.figures.width_mm, pattern.figures.height_mm], rel=1e-9
    )


def test_outline_and_seam_are_vertices_of_the_cut_surface(pattern: wovenfit.Pattern) -> None:
    assert len(pattern.outlines) == len(pattern.outline_vertices) == 1
    outline = pattern.outline_vertices[0]
    assert np.array_equal(pattern.coordinates[outline], pattern.outlines[0])
    (seam,) = pattern.seams
    assert len(seam.left) == len(seam.right)
    assert set(seam.left.tolist()) | set(seam.right.tolist()) <= set(outline.tolist())
    # Sewn together: the same places on the limb, the same length in the pattern.
    assert np.array_equal(pattern.positions[seam.left], pattern.positions[seam.right])
    for side, stated in ((seam.left, seam.left_mm), (seam.right, seam.right_mm)):
        steps = np.diff(pattern.coordinates[side], axis=0)
        assert np.hypot(*steps.T).sum() == pytest.approx(stated, rel=1e-9)
    assert seam.left_mm == pytest.approx(seam.right_mm, abs=0.1)
    assert seam.left_mm == pytest.approx(90.0, rel=0.01)


def test_marks_lie_in_the_pattern_where_they_are_on_the_limb(limb: Tube) -> None:
    design = wovenfit.Design()
    vertices = [10 * limb.sides + 7, 4 * limb.sides + 7]
    first, second = 2 * limb.sides + 20, 20 * limb.sides + 20
    with wovenfit.Mesh(limb.positions, limb.triangles) as mesh:
        design.add_pressures_at_vertices(mesh, vertices, [2.0, 1.5])
        design.set_orientation_at_vertices(mesh, first, second)
    pattern = wovenfit.flatten(limb.positions, limb.triangles, design)
    given = pattern.vertex_to_given_vertex
    for point, vertex in zip(pattern.pressure_points, vertices):
        # One, unless the seam runs through it.
        (mine,) = np.flatnonzero(given == vertex)
        assert point == pytest.approx(pattern.coordinates[mine], abs=1e-6)
    markers = pattern.orientation_markers
    assert markers[0, 0] == pytest.approx(markers[1, 0], abs=1e-6)
    # 18 of 24 steps along a limb of 90 mm.
    assert markers[0, 1] - markers[1, 1] == pytest.approx(90.0 * 18 / 24, rel=0.01)


def test_the_way_back_to_the_given_mesh(pattern: wovenfit.Pattern, limb: Tube) -> None:
    corners = limb.positions[limb.triangles[pattern.vertex_to_given_triangle]]
    back = np.einsum("vc,vcx->vx", pattern.vertex_weights, corners)
    assert np.allclose(back, pattern.positions, atol=1e-5)
    given = pattern.vertex_to_given_vertex
    kept = given != wovenfit.NONE
    assert kept.sum() >= 1200 - 2 * 48
    assert np.allclose(limb.positions[given[kept]], pattern.positions[kept], atol=1e-5)
    with pytest.raises(IndexError):
        limb.positions[wovenfit.NONE]
    middles = pattern.positions[pattern.triangles].mean(axis=1)
    theirs = limb.positions[limb.triangles[pattern.triangle_to_given_triangle]]
    assert (np.linalg.norm(theirs.mean(axis=1) - middles, axis=1) < 5.0).all()


def test_strains_and_pressures_are_on_the_given_vertices_too(
    pattern: wovenfit.Pattern,
) -> None:
    given = pattern.vertex_to_given_vertex
    kept = np.flatnonzero(given != wovenfit.NONE)
    for there, here in (
        (pattern.given_warp_strain, pattern.warp_strain),
        (pattern.given_weft_strain, pattern.weft_strain),
        (pattern.given_pressure_kpa, pattern.pressure_kpa),
    ):
        inside = kept[~np.isin(kept, pattern.outline_vertices[0])]
        assert np.allclose(there[given[inside]], here[inside], atol=1e-6)


def test_the_table_says_what_was_asked_and_got(pattern: wovenfit.Pattern, limb: Tube) -> None:
    (row,) = pattern.pressures
    assert row.at == pytest.approx(limb.at(2.0, 45.0), abs=0.2)
    assert row.asked_kpa == 2.0
    assert row.got_kpa == pytest.approx(2.0, rel=0.01)
    assert row.got_local_kpa == pytest.approx(2.0, rel=0.02)
    assert row.warp_strain == pytest.approx(0.18, rel=0.01)
    assert row.weft_strain == pytest.approx(0.0, abs=0.005)
    assert row.warp_curvature_per_m == pytest.approx(1000 / 45, rel=0.01)
    assert row.weft_curvature_per_m == pytest.approx(0.0, abs=0.3)
    assert row.mean_curvature_per_m == pytest.approx(500 / 45, rel=0.02)
    # From no strain to the fabric's limit of 0.5.
    assert row.reachable_least_kpa == pytest.approx(0.0, abs=0.02)
    assert row.reachable_most_kpa == pytest.approx(0.5 * 0.5 / 45 * 1e3, rel=0.01)
    assert row.met
    assert row.reason is None
    assert "1 of 1 reached" in pattern.table


def test_a_pressure_that_no_strain_gives_is_missed_with_its_reason(limb: Tube) -> None:
    design = wovenfit.Design()
    design.set_fabric(warp=0.5, weft=0.5, diagonal=0.05, max_strain=0.2)
    design.add_pressures([limb.at(2.0, 45.0)], 8.0)
    pattern = wovenfit.flatten(limb.positions, limb.triangles, design)
    (row,) = pattern.pressures
    assert not row.met
    assert row.reachable_most_kpa == pytest.approx(0.2 * 0.5 / 45 * 1e3, rel=0.01)
    assert row.reason is not None
    assert row.reason.code
    assert row.reason.message
    assert row.reason.at == row.at


def test_warnings_have_codes_texts_and_places(pattern: wovenfit.Pattern) -> None:
    codes = {warning.code: warning for warning in pattern.warnings}
    assert set(codes) == {"seam_automatic", "orientation_automatic"}
    assert "draw a seam" in codes["seam_automatic"].message
    x, y, z = codes["seam_automatic"].at
    assert math.hypot(x, y) == pytest.approx(45.0, abs=0.2)
    assert z == pytest.approx(90.0, abs=1e-3)


def test_report_page_and_drawing_are_of_the_same_pattern(pattern: wovenfit.Pattern) -> None:
    assert pattern.report["pattern"]["width_mm"] == pattern.figures.width_mm
    assert pattern.report["pressures"][0]["got_kpa"] == pattern.pressures[0].got_kpa
    assert len(pattern.report["warnings"]) == len(pattern.warnings)
    assert pattern.svg.startswith("<?xml")
    assert pattern.html.lower().startswith("<!doctype html>")
    assert pattern.figures.converged
    assert (pattern.figures.flipped, pattern.figures.overlaps) == (0, 0)
    assert pattern.figures.steps >= 1
    assert pattern.figures.energy >= 0
    assert pattern.figures.curvature_radius_mm == 10.0


def test_girths_are_the_polygons(pattern: wovenfit.Pattern, limb: Tube) -> None:
    assert pattern.girths.shape[1] == 2
    assert len(pattern.girths) >= 3
    assert pattern.girths[1:, 1] == pytest.approx(limb.girth, abs=1e-3)


def test_a_closed_pattern_says_so(limb: Tube, design: wovenfit.Design) -> None:
    pattern = wovenfit.flatten(limb.positions, limb.triangles, design)
    kept = pattern.coordinates
    with pattern:
        pass
    pattern.close()
    assert pattern.closed
    assert "closed" in repr(pattern)
    assert kept.shape[1] == 2
    with pytest.raises(ValueError, match="this Pattern is closed"):
        _ = pattern.friction
