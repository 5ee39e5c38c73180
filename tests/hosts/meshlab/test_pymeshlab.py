"""The filters in today's MeshLab, by its Python module: double precision, so that everything is
compared bit for bit with the C ABI and byte for byte with the command line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest
import wovenfit
from limbs import (
    Limb,
    command_line,
    differing,
    edited,
    sample,
    write_obj,
    write_points,
)

BUILD = Path(os.environ["WOVENFIT_MESHLAB_BUILD"])
FLATTEN = "wovenfit_flatten_to_pattern"
CHECK = "wovenfit_check_surface"


@pytest.fixture(scope="session", autouse=True)
def plugin() -> None:
    pymeshlab.load_plugin(str(BUILD / "libfilter_wovenfit.so"))


@pytest.fixture(scope="session")
def limb(tmp_path_factory: pytest.TempPathFactory) -> Limb:
    return sample(tmp_path_factory.mktemp("limb"))


def layers(points: np.ndarray, faces: np.ndarray, **more: np.ndarray) -> pymeshlab.MeshSet:
    document = pymeshlab.MeshSet()
    document.add_mesh(pymeshlab.Mesh(points, faces, **more), "arm")
    return document


def of_abi(limb: Limb, design: wovenfit.Design | dict, **parameters: object) -> wovenfit.Pattern:
    return wovenfit.flatten(limb.points, limb.faces, design, parameters=parameters)


def same_bits(document: pymeshlab.MeshSet, pattern: wovenfit.Pattern) -> None:
    """The pattern's layer is the current one and has the numbers of the C ABI."""
    layer = document.current_mesh()
    points = layer.vertex_matrix()
    assert np.array_equal(points[:, :2], pattern.coordinates)
    assert not points[:, 2].any()
    assert np.array_equal(layer.face_matrix(), pattern.triangles)


def refused(document: pymeshlab.MeshSet, filter_name: str = FLATTEN, **values: object) -> str:
    """The text of a refusal, which leaves the document as it was."""
    before = len(document)
    with pytest.raises(pymeshlab.PyMeshLabException) as error:
        document.apply_filter(filter_name, **values)
    assert len(document) == before
    return str(error.value)


def test_both_filters_are_listed() -> None:
    assert {FLATTEN, CHECK} <= set(pymeshlab.filter_list())


def test_the_dialog_has_every_parameter_of_the_table_with_its_default(limb: Limb) -> None:
    shown = layers(limb.points, limb.faces).filter_parameter_values(FLATTEN)
    for row in wovenfit.parameter_table():
        value = shown[row.name]
        if row.choices:
            value = row.choices[value]
        assert value == pytest.approx(row.default), row.name


def test_a_design_file_gives_the_command_lines_files_and_the_c_abis_pattern(
    limb: Limb, tmp_path: Path
) -> None:
    document = layers(limb.points, limb.faces)
    figures = document.apply_filter(
        FLATTEN,
        design_file=str(limb.design_file),
        output_folder=str(tmp_path / "meshlab"),
        field="pressure (kPa)",
    )
    mesh = write_obj(tmp_path / "arm.obj", limb.points, limb.faces)
    expected = command_line(tmp_path, mesh, limb.design_file)
    assert differing(tmp_path / "meshlab", expected) == []
    assert sorted(p.name for p in (tmp_path / "meshlab").iterdir()) == sorted(
        p.name for p in expected.iterdir()
    )

    pattern = of_abi(limb, limb.design)
    same_bits(document, pattern)
    layer = document.current_mesh()
    assert np.array_equal(layer.vertex_scalar_array(), pattern.pressure_kpa)
    colours = layer.vertex_color_matrix()
    most, least = np.argmax(pattern.pressure_kpa), np.argmin(pattern.pressure_kpa)
    assert colours[most].tolist() == [1, 0, 0, 1]
    assert colours[least].tolist() == [0, 0, 1, 1]

    assert figures["width_mm"] == pattern.figures.width_mm
    assert figures["converged"] is True
    assert figures["flipped"] == 0
    assert figures["pressures"] == 4
    assert np.array_equal(figures["asked_kpa"], [row.asked_kpa for row in pattern.pressures])
    assert np.array_equal(figures["computed_kpa"], [row.got_kpa for row in pattern.pressures])
    assert figures["warnings"] == len(pattern.warnings)


@pytest.mark.parametrize(
    ("field", "name"), [("warp strain", "warp_strain"), ("weft strain", "weft_strain")]
)
def test_the_field_asked_for_is_the_layers_quality(limb: Limb, field: str, name: str) -> None:
    document = layers(limb.points, limb.faces)
    document.apply_filter(FLATTEN, design_file=str(limb.design_file), field=field)
    expected = getattr(of_abi(limb, limb.design), name)
    assert np.array_equal(document.current_mesh().vertex_scalar_array(), expected)


def test_the_source_gets_texture_coordinates_in_mm(limb: Limb) -> None:
    document = layers(limb.points, limb.faces)
    document.apply_filter(FLATTEN, design_file=str(limb.design_file))
    document.set_current_mesh(0)
    corners = document.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2)
    expected = of_abi(limb, limb.design).given_corner_coordinates
    assert np.array_equal(corners, expected.astype(np.float32))


def test_a_layers_transform_is_applied_and_one_that_mirrors_keeps_corners(
    limb: Limb, tmp_path: Path
) -> None:
    without = edited(tmp_path, limb.design, pressures=[])
    wishes = [(wish["at"], f"{wish['kpa']!r} kPa") for wish in limb.design["pressures"]]
    picked = write_points(tmp_path / "arm.pp", wishes)
    moved = np.array([[0, -1, 0, 5.0], [1, 0, 0, -7], [0, 0, 1, 11], [0, 0, 0, 1]], dtype=float)
    mirror = np.diag([1.0, 1, -1, 1]) @ moved
    for transform in (moved, mirror):
        inverse = np.linalg.inv(transform)
        local = limb.points @ inverse[:3, :3].T + inverse[:3, 3]
        turned = limb.faces[:, ::-1] if transform is mirror else limb.faces
        document = layers(local, np.ascontiguousarray(turned))
        document.set_matrix(transformmatrix=transform, freeze=False)
        # Picked points lie where MeshLab shows the layer.
        document.apply_filter(FLATTEN, design_file=str(without), picked_points_file=str(picked))
        expected = of_abi(limb, limb.design)
        points = document.current_mesh().vertex_matrix()[:, :2]
        assert np.abs(points - expected.coordinates).max() < 1e-3
        document.set_current_mesh(0)
        corners = document.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2)
        order = corners[:, ::-1] if transform is mirror else corners
        assert np.abs(order - expected.given_corner_coordinates).max() < 1e-2


def test_the_unit_is_believed(limb: Limb) -> None:
    document = layers(limb.points / 1000, limb.faces)
    document.apply_filter(FLATTEN, design_file=str(limb.design_file), units="m")
    expected = of_abi(limb, limb.design).coordinates
    assert np.abs(document.current_mesh().vertex_matrix()[:, :2] - expected).max() < 1e-3


def painted(limb: Limb) -> np.ndarray:
    """What a brush leaves: 2 kPa round two places, 0 elsewhere."""
    quality = np.zeros(len(limb.points))
    for wish in limb.design["pressures"][:2]:
        quality[np.linalg.norm(limb.points - wish["at"], axis=1) < 15] = 2.0
    assert 2 < np.count_nonzero(quality) < 200
    return quality


@pytest.mark.parametrize(
    ("values", "factor"),
    [({}, 1.0), ({"quality_scale": 20, "pressure_unit": "mmHg"}, 2.0 / (20 * 0.133322))],
)
def test_pressures_come_from_the_vertex_quality(limb: Limb, values: dict, factor: float) -> None:
    kpa = painted(limb)
    document = layers(
        limb.points,
        limb.faces,
        v_scalar_array=kpa * (factor if values else 1) / (2 if values else 1),
    )
    figures = document.apply_filter(FLATTEN, pressures_from_quality=True, **values)
    design = wovenfit.Design()
    design.paint_pressures(wovenfit.Mesh(limb.points, limb.faces), kpa)
    expected = of_abi(limb, design)
    assert figures["pressures"] == len(expected.pressures) > 2
    assert figures["asked_kpa"] == pytest.approx([row.asked_kpa for row in expected.pressures])
    if values:
        assert (
            np.abs(document.current_mesh().vertex_matrix()[:, :2] - expected.coordinates).max()
            < 1e-6
        )
    else:
        same_bits(document, expected)


def test_pressures_come_from_picked_points(limb: Limb, tmp_path: Path) -> None:
    places = [wish["at"] for wish in limb.design["pressures"]]
    names = ["1.6 kPa", "13 mmHg", "15", "ignored"]
    file = write_points(tmp_path / "arm.pp", list(zip(places, names, strict=True)), inactive=(3,))
    document = layers(limb.points, limb.faces)
    document.apply_filter(FLATTEN, picked_points_file=str(file), pressure_unit="mmHg")
    design = wovenfit.Design()
    design.add_pressures(places[:3], [1.6, 13 * 0.133322, 15 * 0.133322])
    same_bits(document, of_abi(limb, design))


def test_fabric_seams_and_orientation_are_the_files_and_what_is_filled_in_goes_before(
    limb: Limb, tmp_path: Path
) -> None:
    seam = [
        limb.points[np.argmax(limb.points[:, 2])].tolist(),
        limb.points[np.argmin(limb.points[:, 2])].tolist(),
    ]
    file = edited(tmp_path, limb.design, seams=[seam])
    document = layers(limb.points, limb.faces)
    document.apply_filter(FLATTEN, design_file=str(file), fabric_warp="0.8", spacing=8)
    wanted = json.loads(file.read_text())
    wanted["fabric"]["warp"] = 0.8
    same_bits(document, of_abi(limb, wanted, spacing=8))


def test_the_brace_covers_the_selected_faces_alone(limb: Limb) -> None:
    document = layers(limb.points, limb.faces)
    document.compute_selection_by_condition_per_face(condselect="(z0 < 90) && (z0 > -50)")
    document.apply_filter(FLATTEN, selected_faces_only=True)
    height = limb.points[limb.faces][:, 0, 2]
    design = wovenfit.Design()
    triangles = np.flatnonzero((height < 90) & (height > -50))
    design.set_region_triangles(wovenfit.Mesh(limb.points, limb.faces), triangles)
    expected = of_abi(limb, design)
    same_bits(document, expected)
    document.set_current_mesh(0)
    corners = document.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2)
    outside = np.isnan(expected.given_corner_coordinates).any(axis=(1, 2))
    assert outside.any()
    assert not corners[outside].any()
    assert corners[~outside].any()


def test_a_second_pattern_is_another_layer(limb: Limb) -> None:
    document = layers(limb.points, limb.faces)
    for _ in range(2):
        document.set_current_mesh(0)
        document.apply_filter(FLATTEN, design_file=str(limb.design_file))
    assert len(document) == 3
    assert "is a pattern: make the layer of the limb" in refused(document)


LOGGED = """
import sys
import numpy as np, pymeshlab
pymeshlab.load_plugin(sys.argv[1])
limb = np.load(sys.argv[2])
document = pymeshlab.MeshSet()
document.add_mesh(pymeshlab.Mesh(limb["points"], limb["faces"]), "arm")
document.set_verbosity(True)
print(document.apply_filter("wovenfit_check_surface"))
document.apply_filter("wovenfit_flatten_to_pattern", design_file=sys.argv[3])
"""


def test_the_log_says_what_the_limb_is_and_has_the_table(limb: Limb, tmp_path: Path) -> None:
    np.savez(tmp_path / "limb.npz", points=limb.points, faces=limb.faces)
    plugin = str(BUILD / "libfilter_wovenfit.so")
    command = [
        sys.executable,
        "-c",
        LOGGED,
        plugin,
        str(tmp_path / "limb.npz"),
        str(limb.design_file),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert "'defects': 0" in done.stdout
    assert "'selected_faces': 0" in done.stdout
    # MeshLab's log goes to standard error.
    assert "tube: cut along a seam" in done.stderr
    assert "This surface can be flattened." in done.stderr
    pattern = of_abi(limb, limb.design)
    for line in pattern.table.splitlines():
        assert line in done.stderr
    for warning in pattern.warnings:
        assert "warning: " + warning.message in done.stderr


def test_check_selects_what_is_broken(limb: Limb) -> None:
    # A third face on an edge.
    fin = np.array([[limb.faces[100, 0], limb.faces[100, 1], len(limb.points)]], dtype=np.int32)
    points = np.vstack([limb.points, limb.points[limb.faces[100, 0]] * 1.2])
    faces = np.vstack([limb.faces, fin])
    document = layers(points, faces)
    figures = document.apply_filter(CHECK)
    assert figures["defects"] == 1
    selected = document.current_mesh().face_selection_array()
    found = wovenfit.Check(wovenfit.Mesh(points, faces))
    assert set(np.flatnonzero(selected)) == set(
        np.concatenate([d.triangles for d in found.defects])
    )
    assert selected[-1]
    assert figures["selected_faces"] == selected.sum()
    assert "edge" in refused(document)
    # The selection of a sound layer is cleared.
    document.add_mesh(pymeshlab.Mesh(limb.points, limb.faces), "sound")
    document.compute_selection_by_condition_per_face(condselect="z0 < 0")
    document.apply_filter(CHECK)
    assert not document.current_mesh().face_selection_array().any()


def test_what_is_no_limb_is_refused_with_its_remedy(limb: Limb) -> None:
    # An empty document is refused by pymeshlab itself.
    assert "requires at least one mesh" in refused(pymeshlab.MeshSet())
    cloud = pymeshlab.MeshSet()
    cloud.add_mesh(pymeshlab.Mesh(limb.points), "cloud")
    for filter_name in (FLATTEN, CHECK):
        assert "points and no faces" in refused(cloud, filter_name)
    assert "set `units` to `m`" in refused(layers(limb.points / 1000, limb.faces))


def test_wrong_values_are_refused_in_words(limb: Limb, tmp_path: Path) -> None:
    document = layers(limb.points, limb.faces)

    def said(**values: object) -> str:
        return refused(document, **values)

    assert "there is no such file" in said(design_file=str(tmp_path / "none.json"))
    (tmp_path / "bad.json").write_text('{"pressures": [], "fabrik": {}}')
    assert "bad.json: `fabrik` is not a known key" in said(design_file=str(tmp_path / "bad.json"))
    (tmp_path / "latin1.json").write_bytes(b'{"piece": {"name": "\xe9"}}')
    assert "latin1.json: byte 20 is not UTF-8" in said(design_file=str(tmp_path / "latin1.json"))
    assert "give a number from 0.5 to 30" in said(spacing=100)
    assert "`fabric.warp`" in said(fabric_warp="much")
    assert "no face is selected" in said(selected_faces_only=True)
    (tmp_path / "file").write_text("")
    assert "give a folder" in said(output_folder=str(tmp_path / "file"))
    place = limb.design["pressures"][0]["at"]
    points = tmp_path / "arm.pp"
    write_points(points, [(place, "0"), (place, "1")])
    assert "rename each" in said(picked_points_file=str(points))
    write_points(points, [(place, "wrist")])
    assert 'point 1 is called "wrist"' in said(picked_points_file=str(points))
    write_points(points, [(place, "25 kPa")])
    assert "13.3" in said(picked_points_file=str(points))
    write_points(points, [([0.0, 0.0, 900.0], "2 kPa")])
    assert "mm from the surface" in said(picked_points_file=str(points))
    points.write_text("<PickedPoints>")
    assert "no file of picked points" in said(picked_points_file=str(points))
    assert "0 everywhere" in said(pressures_from_quality=True)
    negative = layers(limb.points, limb.faces, v_scalar_array=np.full(len(limb.points), -1.0))
    assert "vertex 0 at" in refused(negative, pressures_from_quality=True)


def test_nothing_is_written_where_nothing_is_made(limb: Limb, tmp_path: Path) -> None:
    out = tmp_path / "out"
    wanted = [{"at": [0, 0, 900], "kpa": 1}]
    file = edited(tmp_path, limb.design, pressures=wanted)
    document = layers(limb.points, limb.faces)
    assert "mm from the surface" in refused(document, design_file=str(file), output_folder=str(out))
    assert not out.exists()
    assert not document.current_mesh().has_wedge_tex_coord()


@pytest.mark.parametrize(
    ("name", "said"), [("other_version", "version"), ("other_scalar", "precision")]
)
def test_another_meshlabs_plugin_is_refused(name: str, said: str) -> None:
    script = (
        f"import pymeshlab; pymeshlab.load_plugin({str(BUILD / f'libfilter_wovenfit_{name}.so')!r})"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 1, done
    assert said in done.stderr
