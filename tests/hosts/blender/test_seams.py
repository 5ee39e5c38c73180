"""Seams as marked edges, orientation by two vertices, region by selected faces."""

import itertools

import bpy
import numpy as np
import scene


def marked(limb):
    """The vertices of the edges that are marked as seams."""
    return {vertex for edge in limb.data.edges if edge.use_seam for vertex in edge.vertices}


def test_an_automatic_seam_is_marked_from_end_to_end_and_stays_automatic():
    limb, _ = scene.arm()
    first = scene.flatten().pattern.file("pattern.svg")
    ends = [edge for edge in limb.data.edges if edge.use_seam]
    assert ends, "no edge is marked"
    count = {}
    for edge in ends:
        for vertex in edge.vertices:
            count[vertex] = count.get(vertex, 0) + 1
    # A chain: two ends, all else has two.
    assert sorted(count.values())[:3] == [1, 1, 2] and max(count.values()) == 2
    # Flattened again it is not a wish of the designer's: the same pattern.
    again = scene.flatten().pattern
    assert again.file("pattern.svg") == first
    assert any(one.code == "seam_automatic" for one in again.warnings)
    said = " ".join(one["message"] for one in scene.result()["warnings"])
    assert "mark another chain of edges as seam" in said and "`" not in said, said


def test_the_designers_seam_is_taken_and_kept():
    limb = scene.tube()
    side = 12
    line = [ring * scene.SIDES + side for ring in range(scene.RINGS)]
    wanted = {tuple(sorted(pair)) for pair in itertools.pairwise(line)}
    for edge in limb.data.edges:
        edge.use_seam = tuple(sorted(edge.vertices)) in wanted
    pattern = scene.flatten().pattern
    assert marked(limb) == set(line)
    assert not any(one.code == "seam_automatic" for one in pattern.warnings)
    along = pattern.positions[pattern.seams[0].left]
    # A quarter round the tube: x is 0.
    assert np.abs(along[:, 0]).max() < 0.01 and along[:, 1].min() > 44.0


def test_a_changed_automatic_seam_is_the_designers():
    limb = scene.tube()
    scene.flatten()
    here = marked(limb)
    for edge in limb.data.edges:
        a, b = edge.vertices
        edge.use_seam = a % scene.SIDES == b % scene.SIDES == 30
    pattern = scene.flatten().pattern
    assert marked(limb) == {ring * scene.SIDES + 30 for ring in range(scene.RINGS)} != here
    assert not any(one.code == "seam_automatic" for one in pattern.warnings)
    # And all of them cleared it is automatic again.
    for edge in limb.data.edges:
        edge.use_seam = False
    assert any(one.code == "seam_automatic" for one in scene.flatten().pattern.warnings)
    assert marked(limb) == here


def test_sewn_edges_of_the_flat_mesh_are_equally_long():
    limb = scene.pinned_arm()
    scene.flatten()
    mesh = limb.wovenfit.flat.data
    places = 1000.0 * scene.vectors(mesh.vertices, "co")
    numbers = np.empty(len(mesh.edges), np.int32)
    mesh.attributes["wovenfit_seam"].data.foreach_get("value", numbers)
    seams = scene.result()["seams"]
    assert set(numbers) == set(range(len(seams) + 1))
    for number, (left, right) in enumerate(seams, 1):
        total = sum(
            np.linalg.norm(
                places[mesh.edges[int(e)].vertices[0]] - places[mesh.edges[int(e)].vertices[1]]
            )
            for e in np.flatnonzero(numbers == number)
        )
        scene.near(total, left + right, 0.05)
        scene.near(left, right, 0.1)
    assert [edge.use_seam for edge in mesh.edges] == (numbers > 0).tolist()


def test_two_vertices_stand_above_each_other():
    limb, _ = scene.arm()
    low, high = [], []
    points = 1000.0 * scene.vectors(limb.data.vertices, "co")
    for target, found in (([-7.1, 41.5, 90.0], high), ([-20.0, 38.0, 20.0], low)):
        found.append(int(np.argmin(np.linalg.norm(points - target, axis=1))))
    scene.choose(limb, [*low, *high])
    assert bpy.ops.wovenfit.set_orientation() == {"FINISHED"}
    kept = limb.wovenfit
    assert kept.oriented
    if kept.first.vertex != high[0]:
        assert bpy.ops.wovenfit.swap_orientation() == {"FINISHED"}
    assert (kept.first.vertex, kept.second.vertex) == (high[0], low[0])
    pattern = scene.flatten().pattern
    assert not any(one.code == "orientation_automatic" for one in pattern.warnings)
    own = {int(v): index for index, v in enumerate(pattern.vertex_to_given_vertex)}
    body, other = (pattern.coordinates[own[v]] for v in (high[0], low[0]))
    scene.near(body[0], other[0], 0.5)
    assert body[1] > other[1] + 30.0
    scene.choose(limb, low)
    scene.refused(bpy.ops.wovenfit.set_orientation, "1 vertices", "select two")


def test_selected_faces_alone_are_covered_if_asked_for():
    # Rings of 4 mm: those with middles from 34 to 86 mm reach from 32 to 88.
    limb = scene.tube(quads=True)
    middles = scene.vectors(limb.data.polygons, "center")[:, 2]
    scene.choose_faces(limb, (middles > 0.033) & (middles < 0.087))
    limb.wovenfit.only_selected = True
    scene.flatten()
    scene.near(scene.result()["height_mm"], 56.0, 0.5)
    heights = scene.vectors(limb.data.vertices, "co")[:, 2]
    known = np.isfinite(scene.values(limb.data, "wovenfit_warp_strain"))
    assert known[(heights > 0.033) & (heights < 0.087)].all()
    assert not known[(heights < 0.031) | (heights > 0.089)].any()
    scene.choose_faces(limb, np.zeros(len(middles)))
    scene.refused(bpy.ops.wovenfit.flatten, "no face is selected")
    limb.wovenfit.only_selected = False
    scene.flatten()
    scene.near(scene.result()["height_mm"], 120.0, 0.5)
