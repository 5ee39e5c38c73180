"""What hosts with polygons ask for, against surfaces whose pattern is known."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import wovenfit
from limbs import tube
from numpy.testing import assert_allclose

# Two squares side by side, split; the corners of square 0 are 0..3, of square 1 are 4..7.
PLACES = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]
)
CORNERS = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
POLYGONS = np.array([0, 0, 1, 1])


def test_polygons_get_the_coordinates_of_their_triangles() -> None:
    flat = 10.0 * PLACES[CORNERS][:, :, :2]
    got = wovenfit.polygon_corners(flat, CORNERS, POLYGONS, PLACES)
    assert_allclose(got, 10.0 * PLACES[:, :2], atol=1e-9)


def test_a_polygon_across_a_seam_is_not_torn_but_goes_on_beyond() -> None:
    flat = 10.0 * PLACES[CORNERS][:, :, :2]
    # The seam runs along the diagonal of square 0: its second triangle lies 300 mm away, smaller.
    flat[1] = 0.9 * flat[1] + [300.0, 0.0]
    got = wovenfit.polygon_corners(flat, CORNERS, POLYGONS, PLACES)
    assert_allclose(got, 10.0 * PLACES[:, :2], atol=1e-9)


def test_a_polygon_that_is_covered_in_part_goes_on_and_one_that_is_not_has_none() -> None:
    flat = 10.0 * PLACES[CORNERS][:, :, :2]
    flat[1:] = np.nan
    got = wovenfit.polygon_corners(flat, CORNERS, POLYGONS, PLACES)
    assert_allclose(got[:4], 10.0 * PLACES[:4, :2], atol=1e-9)
    assert np.isnan(got[4:]).all()


def test_the_torn_edges_of_a_tube_are_a_chain_from_end_to_end() -> None:
    limb = tube()
    pattern = wovenfit.flatten(limb.positions, limb.triangles, {"pressures": []})
    edges = wovenfit.torn_edges(pattern.given_corner_coordinates, limb.triangles)
    vertices, uses = np.unique(edges, return_counts=True)
    heights = limb.positions[vertices, 2]
    assert heights.min() == 0.0
    assert heights.max() == limb.length
    # A chain: two ends, at the two rims, and two edges at all else.
    assert sorted(uses)[:3] == [1, 1, 2]
    assert uses.max() == 2
    assert len(edges) == len(vertices) - 1


def test_a_flat_sheet_that_is_not_cut_has_no_torn_edges() -> None:
    flat = 10.0 * PLACES[CORNERS][:, :, :2]
    assert wovenfit.torn_edges(flat, [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]).shape == (0, 2)


def test_a_millimetre_of_mercury_is_the_librarys() -> None:
    asked = {"pressures": [{"at": [0, 0, 0], "mmhg": 1.0}]}
    design = json.loads(wovenfit.Design.from_json(asked).to_json())
    assert design["pressures"][0]["kpa"] == wovenfit.KPA_PER_MMHG


def test_the_fabrics_are_those_of_the_papers_examples(program: Path, tmp_path: Path) -> None:
    for name, fabric in wovenfit.FABRICS.items():
        command = [program, "sample", "elbow", "--config", "b", "--fabric", name]
        command += ["--triangles", "600", "--out", tmp_path / "limb.obj"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        written = json.loads((tmp_path / "limb.design.json").read_text(encoding="utf-8"))["fabric"]
        assert {key: written[key] for key in fabric} == dict(fabric)
        # And the library takes it.
        wovenfit.Design().set_fabric(**fabric)
