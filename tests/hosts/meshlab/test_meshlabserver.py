"""The filters in Debian's MeshLab 2020.09, by its own scripts: single precision, so that the layers
are compared to that precision and the files, which the core writes, byte for byte."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import wovenfit
from limbs import Limb, command_line, differing, edited, flat, sample, write_ply, write_points
from server import (
    CHECK,
    FLATTEN,
    Ran,
    check_filter,
    filter_of,
    flatten_filter,
    read_ply,
    script,
    serve,
    tree,
)

BUILD = Path(os.environ["WOVENFIT_MESHLAB_BUILD"])
# Of a pattern of some 260 mm in single precision.
SINGLE = 260 * 2.0**-23
SELECTED = 0x20


@pytest.fixture(scope="session")
def meshlab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tree(tmp_path_factory.mktemp("meshlab") / "own", [BUILD / "libfilter_wovenfit.so"])


@pytest.fixture(scope="session")
def limb(tmp_path_factory: pytest.TempPathFactory) -> Limb:
    return sample(tmp_path_factory.mktemp("limb"))


@pytest.fixture
def ply(limb: Limb, tmp_path: Path) -> Path:
    return write_ply(tmp_path / "arm.ply", limb.points, limb.faces)


def run(meshlab: Path, folder: Path, mesh: Path, *filters: str, out: str = "vc vq") -> Ran:
    """Runs filters on a mesh; the current layer is written to out.ply."""
    steps = script(folder / "script.mlx", *filters)
    return serve(
        meshlab, "-i", str(mesh), "-s", steps, "-o", str(folder / "out.ply"), "-m", *out.split()
    )


def succeeded(ran: Ran) -> str:
    assert ran.code == 0, ran.said
    return ran.said


def failed(ran: Ran) -> str:
    """meshlabserver shows no filter's error: the log has it."""
    assert ran.code != 0, ran.said
    assert "error: " in ran.said, ran.said
    return ran.said.split("error: ", 1)[1]


def abi(limb: Limb, design: wovenfit.Design | dict, **parameters: object) -> wovenfit.Pattern:
    return wovenfit.flatten(limb.points, limb.faces, design, parameters=parameters)


def near(file: Path, pattern: wovenfit.Pattern) -> None:
    """The layer written is the pattern of the C ABI to single precision."""
    layer = read_ply(file)
    assert np.abs(layer.points[:, :2] - pattern.coordinates).max() <= SINGLE
    assert not layer.points[:, 2].any()
    assert np.array_equal(layer.faces, pattern.triangles)


def test_both_filters_are_listed_with_their_parameters(meshlab: Path, tmp_path: Path) -> None:
    succeeded(serve(meshlab, "-d", str(tmp_path / "dump.txt")))
    text = (tmp_path / "dump.txt").read_text()
    assert FLATTEN in text
    assert CHECK in text
    dialog = text.split(FLATTEN, 1)[1].split("\\section", 1)[0]
    for row in wovenfit.parameter_table():
        label = row.name.replace("_", " ").capitalize()
        assert (f"{label} ({row.unit})" if row.unit else label) in dialog
        assert row.summary.split("'")[0] in dialog


def test_a_design_gives_the_command_lines_files_and_the_pattern_as_a_layer(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    out = tmp_path / "meshlab"
    said = succeeded(
        run(
            meshlab,
            tmp_path,
            ply,
            flatten_filter(design_file=limb.design_file, output_folder=out, field=2),
        )
    )
    expected = command_line(tmp_path, ply, limb.design_file)
    assert differing(out, expected) == []
    pattern = abi(limb, limb.design)
    near(tmp_path / "out.ply", pattern)
    assert np.abs(read_ply(tmp_path / "out.ply").points - flat(expected)).max() < 1e-3
    layer = read_ply(tmp_path / "out.ply").vertices
    assert np.array_equal(layer["quality"], pattern.pressure_kpa.astype(np.float32))
    most, least = np.argmax(pattern.pressure_kpa), np.argmin(pattern.pressure_kpa)
    assert [layer[c][most] for c in ("red", "green", "blue")] == [255, 0, 0]
    assert [layer[c][least] for c in ("red", "green", "blue")] == [0, 0, 255]
    for line in pattern.table.splitlines():
        assert line in said
    for warning in pattern.warnings:
        assert warning.message in said
    assert f"width_mm = {pattern.figures.width_mm:.4f}"[:15] in said


def test_the_pattern_is_written_in_the_formats_and_the_unit_that_are_chosen(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    names = [row.name for row in wovenfit.pattern_formats()]
    chosen = {"pattern_formats": ", ".join(names), "pattern_unit": 1}
    out = tmp_path / "meshlab"
    wish = {"design_file": limb.design_file, "output_folder": out}
    succeeded(run(meshlab, tmp_path, ply, flatten_filter(**wish, **chosen)))
    flags = ("--format", ",".join(names), "--pattern-units", "in")
    expected = command_line(tmp_path, ply, limb.design_file, *flags)
    assert len(list(expected.iterdir())) == len(names) + 4
    for file in expected.iterdir():
        assert (out / file.name).read_bytes() == file.read_bytes(), file.name
    wish["output_folder"] = tmp_path / "none"
    said = failed(run(meshlab, tmp_path, ply, flatten_filter(**wish, pattern_formats="svg,dfx")))
    assert "`dfx` is no format of the pattern: give some of svg, pdf" in said
    assert not (tmp_path / "none").exists()


def test_the_source_gets_texture_coordinates(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    # Without the pattern's layer the limb's is the current one again.
    steps = (flatten_filter(design_file=limb.design_file), filter_of("Delete Current Mesh"))
    succeeded(run(meshlab, tmp_path, ply, *steps, out="wt"))
    source = read_ply(tmp_path / "out.ply")
    assert np.array_equal(source.points, limb.points)
    expected = abi(limb, limb.design).given_corner_coordinates.reshape(-1, 6)
    assert np.abs(np.array(source.texture) - expected).max() <= SINGLE


def test_pressures_from_quality(meshlab: Path, limb: Limb, tmp_path: Path) -> None:
    kpa = np.zeros(len(limb.points))
    for wish in limb.design["pressures"][:2]:
        kpa[np.linalg.norm(limb.points - wish["at"], axis=1) < 15] = 2.0
    ply = write_ply(tmp_path / "arm.ply", limb.points, limb.faces, kpa)
    said = succeeded(run(meshlab, tmp_path, ply, flatten_filter(pressures_from_quality=True)))
    design = wovenfit.Design()
    design.paint_pressures(wovenfit.Mesh(limb.points, limb.faces), kpa)
    near(tmp_path / "out.ply", abi(limb, design))
    assert "at least 10 mm apart" in said


def test_pressures_from_picked_points(meshlab: Path, limb: Limb, ply: Path, tmp_path: Path) -> None:
    places = [wish["at"] for wish in limb.design["pressures"]]
    points = write_points(tmp_path / "arm.pp", [(places[0], "1.6"), (places[1], "13 mmHg")])
    succeeded(
        run(meshlab, tmp_path, ply, flatten_filter(picked_points_file=points, fabric_warp="0.8"))
    )
    design = wovenfit.Design()
    design.set_fabric(warp=0.8)
    design.add_pressures(places[:2], [1.6, 13 * 0.133322])
    near(tmp_path / "out.ply", abi(limb, design))


def test_selected_faces_and_a_layer_with_deleted_elements(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    """Deleted faces stay in MeshLab's arrays until it compacts them, which its scripts never do."""

    def select(condition: str) -> str:
        return filter_of("Conditional Face Selection", ("condSelect", "RichString", condition))

    succeeded(
        run(
            meshlab,
            tmp_path,
            ply,
            select("(z0 < -60)"),
            filter_of("Delete Selected Faces and Vertices"),
            select("(z0 > -40)"),
            flatten_filter(selected_faces_only=True),
        )
    )
    height = limb.points[limb.faces][:, 0, 2]
    # As MeshLab deletes: the faces, and then the vertices all of whose faces are gone.
    kept = height >= -60
    used = np.unique(limb.faces[kept])
    renumbered = np.full(len(limb.points), -1)
    renumbered[used] = np.arange(len(used))
    points, faces = limb.points[used], renumbered[limb.faces[kept]]
    design = wovenfit.Design()
    design.set_region_triangles(wovenfit.Mesh(points, faces), np.flatnonzero(height[kept] > -40))
    near(tmp_path / "out.ply", wovenfit.flatten(points, faces, design))


def test_check_says_and_selects(meshlab: Path, limb: Limb, ply: Path, tmp_path: Path) -> None:
    said = succeeded(run(meshlab, tmp_path, ply, check_filter(), out="ff vf"))
    assert "tube: cut along a seam" in said
    assert "This surface can be flattened." in said
    assert not any(flag & SELECTED for flag in read_ply(tmp_path / "out.ply").flags)

    apex = limb.points[limb.faces[100, 0]] * 1.2
    points = np.vstack([limb.points, apex])
    faces = np.vstack([limb.faces, [[limb.faces[100, 0], limb.faces[100, 1], len(limb.points)]]])
    broken = write_ply(tmp_path / "broken.ply", points, faces)
    said = succeeded(run(meshlab, tmp_path, broken, check_filter(), out="ff vf"))
    assert "defect: " in said
    assert "cannot be flattened" in said
    flags = read_ply(tmp_path / "out.ply").flags
    found = wovenfit.Check(wovenfit.Mesh(points, faces))
    expected = set(np.concatenate([defect.triangles for defect in found.defects]))
    assert {i for i, flag in enumerate(flags) if flag & SELECTED} == expected


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"design_file": "/nowhere/brace.json"}, "there is no such file"),
        ({"spacing": 100}, "give a number from 0.5 to 30"),
        ({"fabric_weft": "soft"}, "`fabric.weft` is `soft`: give a number"),
        ({"selected_faces_only": True}, "no face is selected"),
        ({"pressures_from_quality": True}, "quality"),
    ],
)
def test_refusals_say_what_to_do(
    meshlab: Path, ply: Path, tmp_path: Path, values: dict[str, object], said: str
) -> None:
    assert said in failed(run(meshlab, tmp_path, ply, flatten_filter(**values)))
    assert not (tmp_path / "out.ply").exists()


def test_a_point_cloud_is_refused(meshlab: Path, limb: Limb, tmp_path: Path) -> None:
    cloud = write_ply(tmp_path / "cloud.ply", limb.points, limb.faces[:0])
    for steps in (flatten_filter(), check_filter()):
        assert "points and no faces" in failed(run(meshlab, tmp_path, cloud, steps))


def test_pressures_off_the_limb_leave_no_files(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    file = edited(tmp_path, limb.design, pressures=[{"at": [0, 0, 900], "kpa": 1}])
    steps = flatten_filter(design_file=file, output_folder=tmp_path / "out")
    assert "mm from the surface" in failed(run(meshlab, tmp_path, ply, steps))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("other_version", "built for MeshLab 2019.03"),
        ("other_scalar", "with double precision, and this is"),
    ],
)
def test_another_meshlabs_plugin_refuses(
    limb: Limb, ply: Path, tmp_path: Path, name: str, said: str
) -> None:
    other = tree(tmp_path / "meshlab", [BUILD / f"libfilter_wovenfit_{name}.so"])
    refusal = failed(run(other, tmp_path, ply, filter_of(FLATTEN)))
    assert said in refusal
    assert "MeshLab 2020.09 with single precision" in refusal
    assert "install.py" in refusal


def test_what_only_code_inside_meshlab_can_do(
    meshlab: Path, limb: Limb, ply: Path, tmp_path: Path
) -> None:
    """A nested call, an empty document, a layer closed meanwhile, a cancel, a panic: driver.cpp."""
    own = BUILD / "libfilter_wovenfit.so"
    inside = tree(tmp_path / "inside", [own, BUILD / "libfilter_wovenfit_driver.so"])
    steps = filter_of("WovenFit test: From Inside")
    ran = run(inside, tmp_path, ply, steps)
    said = succeeded(ran)
    lines = [line for line in said.splitlines() if line.startswith(("ok: ", "FAILED: "))]
    assert len(lines) == 8, said
    assert all(line.startswith("ok: ") for line in lines), said
