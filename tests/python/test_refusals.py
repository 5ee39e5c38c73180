"""What is refused, and that the exception says what and where."""

from __future__ import annotations

import numpy as np
import pytest
import wovenfit
from limbs import Tube


def mesh_of(limb: Tube, row: int, value: float) -> wovenfit.Mesh:
    positions = limb.positions.copy()
    positions[row, 1] = value
    return wovenfit.Mesh(positions, limb.triangles)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_vertex_that_is_no_number_is_a_defect_with_its_index(limb: Tube, value: float) -> None:
    mesh = mesh_of(limb, 5, value)
    check = wovenfit.Check(mesh)
    assert not check.sound
    assert [(d.code, d.at, d.vertices.tolist()) for d in check.defects] == [
        ("not_finite", None, [5])
    ]
    with pytest.raises(wovenfit.SurfaceError, match="vertex 5") as raised:
        wovenfit.Job(mesh, wovenfit.Design()).result()
    assert [d.vertices.tolist() for d in raised.value.defects] == [[5]]


def test_an_index_too_large_is_a_defect_with_its_triangle(limb: Tube) -> None:
    triangles = np.vstack([limb.triangles, [[0, 1, 1_000_000]]])
    mesh = wovenfit.Mesh(limb.positions, triangles)
    with pytest.raises(wovenfit.SurfaceError, match="names vertex 1000000") as raised:
        wovenfit.Job(mesh, wovenfit.Design()).result()
    (defect,) = raised.value.defects
    assert defect.code == "index_out_of_range"
    assert defect.triangles.tolist() == [len(limb.triangles)]
    assert defect.vertices.tolist() == [1_000_000]


def test_the_defects_are_there_after_the_mesh_was_closed(limb: Tube) -> None:
    with pytest.raises(wovenfit.SurfaceError) as raised:
        wovenfit.flatten(
            limb.positions, np.vstack([limb.triangles, [[0, 1, 500]]]), wovenfit.Design()
        )
    (defect,) = raised.value.defects
    assert defect.code == "non_manifold_vertex"
    assert defect.vertices.tolist() == [500]
    assert len(limb.triangles) in defect.triangles
    assert np.allclose(defect.at, limb.positions[500], atol=1e-5)


def test_the_check_names_place_and_elements_of_each_defect(limb: Tube) -> None:
    # The edge of a triangle that is there twice more belongs to four.
    again = np.vstack([limb.triangles, limb.triangles[700:701], limb.triangles[1900:1901]])
    check = wovenfit.Check(wovenfit.Mesh(limb.positions, again))
    assert len(check.defects) >= 2
    for defect in check.defects:
        assert defect.code
        assert defect.message
        assert defect.at is not None
        named = {700, 1900, 2304, 2305}
        assert named & set(defect.triangles.tolist()), defect
    assert check.report["defects"]


def test_a_sound_mesh_has_no_defect_and_its_size_is_read(limb: Tube) -> None:
    check = wovenfit.Check(wovenfit.Mesh(limb.positions / 10, limb.triangles, "cm"))
    assert check.sound
    assert check.defects == ()
    assert check.report["unit"] == "cm"
    assert check.report["size_mm"] == pytest.approx([90.0, 90.0, 90.0], abs=0.1)
    assert check.report["girths"][2]["girth_mm"] == pytest.approx(limb.girth, abs=1e-3)


def test_checks_warn_with_places(limb: Tube) -> None:
    warnings = wovenfit.Check(wovenfit.Mesh(limb.positions / 1000, limb.triangles)).warnings
    assert {warning.code for warning in warnings} == {"opening_kept"}
    assert all(warning.at is not None and warning.message for warning in warnings)


def test_metres_that_are_called_millimetres_are_no_limb(limb: Tube) -> None:
    mesh = wovenfit.Mesh(limb.positions / 1000, limb.triangles)
    with pytest.raises(wovenfit.UnitError, match="probably in m"):
        wovenfit.Job(mesh, wovenfit.Design()).result()


@pytest.mark.parametrize("shape", [(9,), (3, 2), (3, 4), (1, 3, 3), ()])
def test_positions_of_another_shape(shape: tuple[int, ...]) -> None:
    with pytest.raises(wovenfit.InvalidArgument, match=r"`positions` has shape .*\(n, 3\)"):
        wovenfit.Mesh(np.zeros(shape), [[0, 1, 2]])


@pytest.mark.parametrize("dtype", ["U8", "O", "c16", "?", "M8[s]"])
def test_positions_that_are_no_real_numbers(dtype: str) -> None:
    with pytest.raises(wovenfit.InvalidArgument, match="`positions` holds"):
        wovenfit.Mesh(np.zeros((3, 3)).astype(dtype), [[0, 1, 2]])


def test_rows_of_unequal_length() -> None:
    with pytest.raises(wovenfit.InvalidArgument, match="`positions`"):
        wovenfit.Mesh([[0, 0, 0], [1, 1]], [[0, 1, 2]])


@pytest.mark.parametrize(
    ("triangles", "words", "elements"),
    [
        ([[0, 1, 2, 3]], r"shape \(1, 4\)", ()),
        ([0, 1, 2], r"shape \(3,\)", ()),
        ([[0.0, 1.0, 2.0]], "float64: give whole numbers", ()),
        ([[True, False, True]], "bool: give whole numbers", ()),
        ([[0, 1, 2], [0, -1, 2]], "negative or beyond 32 bits at row 1", (1,)),
        ([[0, 1, 2**32], [0, 1, 2], [0, 1, 2**40]], "at rows 0, 2", (0, 2)),
    ],
)
def test_triangles_that_cannot_be(triangles: object, words: str, elements: tuple[int, ...]) -> None:
    with pytest.raises(wovenfit.InvalidArgument, match=words) as raised:
        wovenfit.Mesh(np.zeros((3, 3)), triangles)
    assert raised.value.elements == elements
    assert isinstance(raised.value, ValueError)


def test_more_vertices_than_the_library_takes() -> None:
    with pytest.raises(wovenfit.TooLarge, match="6000000 are the most"):
        wovenfit.Mesh(np.zeros((6_000_001, 3), np.float32), [[0, 1, 2]])


@pytest.mark.parametrize("unit", [0.0, -1.0, np.nan, np.inf, "furlong", "m\0", ""])
def test_units_that_are_none(limb: Tube, unit: float | str) -> None:
    with pytest.raises(wovenfit.InvalidArgument):
        wovenfit.Mesh(limb.positions, limb.triangles, unit)


REFUSED = [
    (lambda d, m: d.add_pressures([[np.nan, 0, 0]], 1), wovenfit.InvalidArgument, "at row 0"),
    (lambda d, m: d.add_pressures([[0, 0, 0]], np.nan), wovenfit.InvalidArgument, "`kpa`"),
    (lambda d, m: d.add_pressures([[0, 0, 0]], -1), wovenfit.InvalidArgument, "0 or more"),
    (lambda d, m: d.add_pressures([[0, 0, 0]], 200), wovenfit.DesignError, "13.3 kPa"),
    (lambda d, m: d.add_pressures([[0, 0, 0]], [1, 2]), wovenfit.InvalidArgument, r"\(1,\)"),
    (lambda d, m: d.add_pressures([[0, 0, 0]], "1"), wovenfit.InvalidArgument, "real numbers"),
    (lambda d, m: d.add_pressures([0, 0, 0], 1), wovenfit.InvalidArgument, "`positions` has"),
    (lambda d, m: d.add_pressures(np.zeros((1001, 3)), 1), wovenfit.TooLarge, "1000"),
    (lambda d, m: d.add_pressures_at_vertices(m, [9999], 1), wovenfit.OutOfRange, "9999"),
    (lambda d, m: d.add_pressures_at_vertices(m, [-1], 1), wovenfit.InvalidArgument, "negative"),
    (lambda d, m: d.add_pressures_at_vertices(m, [1.5], 1), wovenfit.InvalidArgument, "whole"),
    (lambda d, m: d.paint_pressures(m, [1.0]), wovenfit.InvalidArgument, "1200 vertices"),
    (lambda d, m: d.set_orientation([0, 0, 1], [0, 0, 1]), wovenfit.DesignError, "different"),
    (lambda d, m: d.set_orientation([0, 0], [0, 0, 1]), wovenfit.InvalidArgument, "`first`"),
    (lambda d, m: d.set_orientation_at_vertices(m, 0, 5000), wovenfit.OutOfRange, "5000"),
    (lambda d, m: d.add_seam([[0, 0, 0]]), wovenfit.DesignError, "2 or more"),
    (lambda d, m: d.add_seams_along_edges(m, [[0, 5000]]), wovenfit.OutOfRange, "5000"),
    (lambda d, m: d.add_seams_along_edges(m, [0, 1]), wovenfit.InvalidArgument, r"\(n, 2\)"),
    (lambda d, m: d.add_region_plane([0, 0, 0], [0, 0, 0]), wovenfit.DesignError, "zero"),
    (lambda d, m: d.set_region_triangles(m, []), wovenfit.InvalidArgument, "no triangle"),
    (lambda d, m: d.set_region_triangles(m, [9999]), wovenfit.OutOfRange, "9999"),
    (lambda d, m: d.set_region_triangles(m, [True]), wovenfit.InvalidArgument, "bool for each"),
    (lambda d, m: d.add_bony([[0, 0, np.inf]]), wovenfit.InvalidArgument, "at row 0"),
    (lambda d, m: d.set("fabric.wrap", 1), wovenfit.DesignError, "nearest.*warp"),
    (lambda d, m: d.set("fabric.warp", 0), wovenfit.DesignError, "more than 0"),
    (lambda d, m: d.set("fabric.warp", np.nan), wovenfit.InvalidArgument, "finite"),
    (lambda d, m: d.set("fabric.warp", "stiff"), wovenfit.DesignError, "number"),
    (lambda d, m: d.set("fabric.warp", None), wovenfit.InvalidArgument, "give a number"),
    (lambda d, m: d.set("fabric.name", "a\0b"), wovenfit.InvalidArgument, "NUL at 1"),
    (lambda d, m: d.set("fabric.name", "\ud800"), wovenfit.NotUtf8, "UTF-8"),
    (lambda d, m: d.set(None, 1), wovenfit.NullArgument, "`name`"),
    (lambda d, m: d.set_fabric(warp=101), wovenfit.DesignError, "at most 100"),
    (lambda d, m: d.clear("presures"), wovenfit.DesignError, "nearest.*pressures"),
    (lambda d, m: d.from_json("{"), wovenfit.DesignError, "cannot be read"),
    (lambda d, m: d.from_json({"presures": []}), wovenfit.DesignError, "presures"),
    (lambda d, m: d.from_json({"pressures": {1}}), wovenfit.InvalidArgument, "JSON"),
    (lambda d, m: d.from_json({"x": np.nan}), wovenfit.InvalidArgument, "JSON"),
]


@pytest.mark.parametrize(("wish", "kind", "words"), REFUSED)
def test_a_wish_that_cannot_be_changes_nothing(
    mesh: wovenfit.Mesh, wish: object, kind: type[Exception], words: str
) -> None:
    design = wovenfit.Design()
    before = design.to_json()
    with pytest.raises(kind, match=words):
        wish(design, mesh)
    assert design.to_json() == before


def test_rows_that_are_not_finite_are_listed_up_to_ten(mesh: wovenfit.Mesh) -> None:
    painted = np.zeros(mesh.vertex_count)
    painted[100:200] = np.nan
    with pytest.raises(wovenfit.InvalidArgument, match="and 90 more") as raised:
        wovenfit.Design().paint_pressures(mesh, painted)
    assert raised.value.elements == tuple(range(100, 110))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"spacin": 1}, "nearest name is `spacing`"),
        ({"spacing": 1e9}, "from 0.5 to 30"),
        ({"spacing": float("nan")}, "from 0.5 to 30"),
        ({"newton_steps": 1.5}, "whole number"),
        ({"newton_steps": -1}, "whole number"),
        ({"newton_steps": 10**30}, "whole number"),
        ({"keep_largest": 3}, "`true` or `false`"),
        ({"method": "magic"}, "`newton`, `diffusion`"),
        ({"spacing": None}, "cannot be a NoneType"),
    ],
)
def test_absurd_parameters(values: dict[str, object], words: str) -> None:
    with pytest.raises(wovenfit.ParameterError, match=words):
        wovenfit.Parameters(**values)


def test_pressures_off_the_limb_end_the_job(mesh: wovenfit.Mesh) -> None:
    design = wovenfit.Design()
    design.add_pressures([[500, 0, 0]], 2.0)
    with pytest.raises(wovenfit.PressureError, match=r"\(500.0, 0.0, 0.0\) mm lies 455.0 mm"):
        wovenfit.Job(mesh, design).result()


def test_a_region_that_misses_the_limb_ends_the_job(mesh: wovenfit.Mesh) -> None:
    design = wovenfit.Design()
    design.add_region_plane([0, 0, 1000], [0, 0, 1])
    with pytest.raises(wovenfit.SeamError):
        wovenfit.Job(mesh, design).result()


def test_units_as_parameter_and_of_the_mesh_must_agree(
    mesh: wovenfit.Mesh, design: wovenfit.Design
) -> None:
    with pytest.raises(wovenfit.InvalidArgument, match="`units`"):
        wovenfit.Job(mesh, design, wovenfit.Parameters(units="cm"))


def test_a_region_of_another_mesh_is_refused(mesh: wovenfit.Mesh, limb: Tube) -> None:
    design = wovenfit.Design()
    design.set_region_triangles(mesh, [0, 1])
    other = wovenfit.Mesh(limb.positions, limb.triangles[:-1])
    with pytest.raises(wovenfit.InvalidArgument, match="select it anew"):
        wovenfit.Job(other, design)
