"""What is wanted, by points, on the mesh and as text, shows in the pattern where it should."""

from __future__ import annotations

import json

import numpy as np
import pytest
import wovenfit
from limbs import Tube


def run(
    mesh: wovenfit.Mesh, design: wovenfit.Design, **parameters: wovenfit.parameters.Value
) -> wovenfit.Pattern:
    return wovenfit.Job(mesh, design, wovenfit.Parameters(**parameters)).result()


def seam_angle(pattern: wovenfit.Pattern) -> float:
    """The mean angle of the seam round the limb, in degrees."""
    x, y, _ = pattern.positions[pattern.seams[0].left].T
    return float(np.degrees(np.arctan2(y, x)).mean())


def test_pressures_pinned_to_vertices_are_those_at_their_places(
    mesh: wovenfit.Mesh, limb: Tube
) -> None:
    vertices, kpa = [12 * 48 + 20, 8 * 48 + 30], [2.0, 1.8]
    pinned, placed = wovenfit.Design(), wovenfit.Design()
    pinned.add_pressures_at_vertices(mesh, vertices, kpa)
    placed.add_pressures(limb.positions[vertices], kpa)
    assert pinned.pressure_count == 2
    assert pinned.to_json() == placed.to_json()
    pattern = run(mesh, pinned)
    assert [row.asked_kpa for row in pattern.pressures] == kpa
    for row, vertex in zip(pattern.pressures, vertices):
        assert row.at == pytest.approx(limb.positions[vertex], abs=1e-4)
        assert row.got_kpa == pytest.approx(row.asked_kpa, rel=0.05)


def test_painted_pressures_are_condensed_and_reached(mesh: wovenfit.Mesh, limb: Tube) -> None:
    painted = np.where(np.abs(limb.positions[:, 2] - 45) < 20, 2.0, 0.0)
    design = wovenfit.Design()
    design.paint_pressures(mesh, painted)
    assert 10 < design.pressure_count <= 200
    pattern = run(mesh, design)
    assert len(pattern.pressures) == design.pressure_count
    assert "painted_condensed" in {warning.code for warning in pattern.warnings}
    for row in pattern.pressures:
        assert row.asked_kpa == pytest.approx(2.0)
        assert abs(row.at[2] - 45) < 20
    # All of the middle has the strain of 2 kPa.
    assert pattern.figures.width_mm == pytest.approx(limb.girth / 1.18, rel=0.01)


def test_nothing_painted_asks_nothing(mesh: wovenfit.Mesh) -> None:
    design = wovenfit.Design()
    design.paint_pressures(mesh, np.zeros(mesh.vertex_count))
    assert design.pressure_count == 0


@pytest.mark.parametrize("as_bools", [False, True])
def test_a_face_selection_is_what_the_brace_covers(
    mesh: wovenfit.Mesh, limb: Tube, design: wovenfit.Design, as_bools: bool
) -> None:
    # The bands between rings 8 and 16 of 24, each 90 mm / 24 high.
    first, last = 8 * 2 * 48, 16 * 2 * 48
    covered = np.zeros(mesh.triangle_count, bool)
    covered[first:last] = True
    design.set_region_triangles(mesh, covered if as_bools else np.flatnonzero(covered))
    pattern = run(mesh, design)
    assert pattern.figures.height_mm == pytest.approx(30.0, rel=0.01)
    assert pattern.figures.width_mm == pytest.approx(limb.girth / 1.18, rel=0.01)
    missing = np.isnan(pattern.given_corner_coordinates).all(axis=(1, 2))
    assert np.array_equal(missing, ~covered)
    outside = np.isnan(pattern.given_pressure_kpa).reshape(25, 48)
    assert outside[:8].all()
    assert outside[17:].all()
    assert not outside[8:17].any()


def test_clearing_a_face_selection_covers_all_again(
    mesh: wovenfit.Mesh, design: wovenfit.Design
) -> None:
    design.set_region_triangles(mesh, np.arange(8 * 96, 16 * 96))
    design.clear("region_faces")
    assert run(mesh, design).figures.height_mm == pytest.approx(90.0, rel=0.01)


def test_planes_bound_the_brace(mesh: wovenfit.Mesh, limb: Tube, design: wovenfit.Design) -> None:
    design.add_region_plane([0, 0, 70], [0, 0, -1])
    design.add_region_plane([0, 0, 20], [0, 0, 5])
    pattern = run(mesh, design)
    assert pattern.figures.height_mm == pytest.approx(50.0, rel=0.01)
    assert pattern.figures.width_mm == pytest.approx(limb.girth / 1.18, rel=0.01)


@pytest.mark.parametrize("column", [7, 30])
def test_seams_run_along_the_edges_that_were_chosen(
    mesh: wovenfit.Mesh, design: wovenfit.Design, column: int
) -> None:
    # From ring to ring to and fro by half a side; given from the middle outward, in any order.
    edges = [[ring * 48 + column, (ring + 1) * 48 + column] for ring in range(24)]
    design.add_seams_along_edges(mesh, edges[12:] + edges[:12])
    pattern = run(mesh, design)
    assert len(pattern.seams) == 1
    # Round the limb 7.5 degrees a vertex, and a quarter more in the mean of the zigzag.
    wanted = 7.5 * (column + 0.25)
    assert (seam_angle(pattern) - wanted + 180) % 360 - 180 == pytest.approx(0.0, abs=3.75)
    assert pattern.seams[0].left_mm == pytest.approx(90.0, rel=0.01)
    assert "seam_automatic" not in {warning.code for warning in pattern.warnings}


def test_a_seam_runs_along_its_points(
    mesh: wovenfit.Mesh, limb: Tube, design: wovenfit.Design
) -> None:
    design.add_seam([limb.at(1.0, 90.0), limb.at(1.0, 0.0)])
    assert seam_angle(run(mesh, design)) == pytest.approx(np.degrees(1.0), abs=1.0)


def test_markers_turn_the_pattern(mesh: wovenfit.Mesh, limb: Tube, design: wovenfit.Design) -> None:
    # Two vertices above each other on the limb, and the same upside down.
    for first, second in ((5, 24 * 48 + 5), (24 * 48 + 5, 5)):
        design.set_orientation_at_vertices(mesh, first, second)
        at_vertices = design.to_json()
        design.set_orientation(limb.positions[first], limb.positions[second])
        assert design.to_json() == at_vertices
        pattern = run(mesh, design)
        given = pattern.vertex_to_given_vertex
        upper, lower = (pattern.coordinates[given == v][0] for v in (first, second))
        assert upper[1] - lower[1] == pytest.approx(90.0, rel=0.01)
        assert upper[0] == pytest.approx(lower[0], abs=0.2)


def test_numbers_and_texts_of_the_design_are_set_and_cleared() -> None:
    design = wovenfit.Design()
    empty = design.to_json()
    design.set_fabric(warp=0.7, name="power weave", max_strain=np.float32(0.25))
    design.set("piece.reference", "job 17 – Ellenbogen")
    design.set("limits.max_kpa", 20)
    wishes = json.loads(design.to_json())
    assert wishes["fabric"]["warp"] == 0.7
    assert wishes["fabric"]["name"] == "power weave"
    assert wishes["fabric"]["max_strain"] == 0.25
    assert wishes["piece"]["reference"] == "job 17 – Ellenbogen"
    design.add_pressures([[0, 0, 0]], 15.0)
    design.add_bony([[1, 2, 3]])
    assert json.loads(design.to_json())["limits"]["bony"] == [[1, 2, 3]]
    design.clear("limits.bony")
    for name in ("pressures", "fabric", "limits", "piece"):
        design.clear(name)
    assert design.to_json() == empty


def test_bony_places_are_warned_of(mesh: wovenfit.Mesh, limb: Tube) -> None:
    design = wovenfit.Design()
    design.set_fabric(warp=2.0, weft=2.0, diagonal=0.2)
    design.add_pressures([limb.at(2.0, 45.0)], 10.0)
    place = limb.at(2.0, 45.0)

    def bony() -> list[wovenfit.Note]:
        warnings = run(mesh, design).warnings
        return [warning for warning in warnings if warning.code == "bony_over_limit"]

    assert bony() == []
    design.add_bony([place])
    (warning,) = bony()
    assert warning.at == pytest.approx(place, abs=1e-4)


def test_a_copy_is_changed_alone(design: wovenfit.Design) -> None:
    copy = design.copy()
    copy.clear("pressures")
    assert (design.pressure_count, copy.pressure_count) == (1, 0)


@pytest.mark.parametrize("unit", ["cm", "m", "in", 2.5])
def test_units_of_mesh_and_design_are_those_stated(limb: Tube, unit: str | float) -> None:
    scale = {"cm": 10.0, "m": 1000.0, "in": 25.4}.get(unit, unit)
    design = wovenfit.Design(unit)
    design.add_pressures([np.array(limb.at(2.0, 45.0)) / scale], 2.0)
    mesh = wovenfit.Mesh(limb.positions / scale, limb.triangles, unit)
    pattern = run(mesh, design)
    assert pattern.figures.width_mm == pytest.approx(limb.girth / 1.18, rel=0.01)
    assert pattern.positions[:, 2].max() == pytest.approx(90.0, abs=1e-3)


def test_a_mapping_is_read_like_the_text(limb: Tube) -> None:
    wishes = {"pressures": [{"at": np.array(limb.at(2.0, 45.0)), "kpa": np.float64(2.0)}]}
    text = json.dumps({"pressures": [{"at": limb.at(2.0, 45.0), "kpa": 2.0}]})
    assert wovenfit.Design.from_json(wishes).to_json() == wovenfit.Design.from_json(text).to_json()
    # Where the text says no units they are the caller's.
    in_cm = json.loads(wovenfit.Design.from_json(text, "cm").to_json())
    assert in_cm["pressures"][0]["at"][2] == pytest.approx(450.0)


def test_the_schema_names_every_wish() -> None:
    properties = wovenfit.design_schema()["properties"]
    assert {"fabric", "pressures", "orientation", "seams", "region", "limits"} <= set(properties)


def test_arrays_of_any_layout_give_the_same_pattern(limb: Tube, design: wovenfit.Design) -> None:
    exact = wovenfit.Job(wovenfit.Mesh(limb.positions, limb.triangles), design).result()
    padded = np.full((len(limb.positions), 5), np.nan)
    padded[:, 1:4] = limb.positions
    layouts = {
        "a column of rows with more in them": padded[:, 1:4],
        "columns": np.asfortranarray(limb.positions),
        "backwards in memory": limb.positions[::-1].copy()[::-1],
        "the other byte order": limb.positions.astype(limb.positions.dtype.newbyteorder()),
        "a list": limb.positions.tolist(),
    }
    for name, positions in layouts.items():
        mesh = wovenfit.Mesh(positions, limb.triangles.astype(np.int64)[:, :])
        got = wovenfit.Job(mesh, design).result()
        assert got.file("worn.obj") == exact.file("worn.obj"), name


def test_32_bit_positions_are_read_as_they_are(limb: Tube, design: wovenfit.Design) -> None:
    single = limb.positions.astype(np.float32)
    padded = np.full((len(single), 4), np.nan, np.float32)
    padded[:, :3] = single
    exact = wovenfit.Job(wovenfit.Mesh(single.astype(np.float64), limb.triangles), design).result()
    for positions in (single, padded[:, :3]):
        got = wovenfit.Job(wovenfit.Mesh(positions, limb.triangles), design).result()
        assert got.file("worn.obj") == exact.file("worn.obj")


def test_whole_numbers_as_positions(limb: Tube) -> None:
    rounded = np.round(limb.positions)
    wanted, got = (
        wovenfit.Check(wovenfit.Mesh(rounded.astype(dtype), limb.triangles)).report
        for dtype in (np.float64, np.int16)
    )
    assert got == wanted
    assert got["length_mm"] == pytest.approx(90.0, abs=0.5)
