"""Pressures at vertices and painted: what they give, and what edits of the mesh do to them."""

import json

import bpy
import numpy as np
import scene

STIFFNESS = 0.5
"""Of the default fabric along warp, in N/mm."""


def test_a_cylinder_has_the_width_that_laplaces_law_gives():
    limb = scene.tube()
    kpa = 2.0
    for ring in (5, 15, 25):
        scene.pin(limb, ring * scene.SIDES, kpa)
    scene.flatten()
    # Tension is pressure times radius, strain is tension over stiffness: 0.18.
    strain = kpa * 1e-3 * scene.RADIUS / STIFFNESS
    flat = scene.vectors(limb.wovenfit.flat.data.vertices, "co")
    middle = np.abs(flat[:, 1] - scene.LENGTH / 2000.0) < 0.003
    width = 1000.0 * float(np.ptp(flat[middle, 0]))
    scene.near(width / (scene.GIRTH / (1.0 + strain)), 1.0, 0.01)
    rows = scene.result()["pressures"]
    assert [row["met"] for row in rows] == [True] * 3
    for row in rows:
        scene.near(row["got_kpa"], kpa, 0.02)


def test_the_samples_pressures_are_reached():
    limb = scene.pinned_arm()
    assert [round(one.kpa, 3) for one in limb.wovenfit.pressures] == [1.6, 1.733, 2.0, 1.867]
    scene.flatten()
    rows = scene.result()["pressures"]
    assert len(rows) == 4 and all(row["met"] for row in rows)
    for row, one in zip(rows, limb.wovenfit.pressures):
        scene.near(row["asked_kpa"], one.kpa, 1e-6)
        scene.near(row["got_kpa"], row["asked_kpa"], 0.05 * row["asked_kpa"])
        place = 1000.0 * np.array(limb.data.vertices[one.mark.vertex].co)
        assert np.linalg.norm(place - row["at"]) < 0.01


def test_what_cannot_be_reached_is_said_with_its_reason():
    limb = scene.tube()
    for ring, kpa in ((14, 1.0), (15, 6.0), (16, 1.0)):
        scene.pin(limb, ring * scene.SIDES + 3 * ring, kpa)
    scene.flatten()
    missed = [row for row in scene.result()["pressures"] if not row["met"]]
    assert missed and all(row["reason"] for row in missed)


def test_add_takes_selected_vertices_in_edit_mode_and_refuses_none_and_many():
    limb = scene.tube()
    scene.choose(limb, [100, 200])
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.wovenfit.add_pressure(kpa=1.5) == {"FINISHED"}
    assert limb.mode == "EDIT"
    assert [one.mark.vertex for one in limb.wovenfit.pressures] == [100, 200]
    # Once more: they are there already.
    bpy.ops.wovenfit.add_pressure()
    assert len(limb.wovenfit.pressures) == 2
    bpy.ops.mesh.select_all(action="DESELECT")
    scene.refused(bpy.ops.wovenfit.add_pressure, "No vertex is selected")
    bpy.ops.mesh.select_all(action="SELECT")
    scene.refused(bpy.ops.wovenfit.add_pressure, "paint the pressure")
    bpy.ops.object.mode_set(mode="OBJECT")
    # The next takes the value of the last.
    scene.choose(limb, [300])
    bpy.ops.wovenfit.add_pressure()
    scene.near(limb.wovenfit.pressures[2].kpa, 1.5, 1e-6)
    limb.wovenfit.active_pressure = 0
    assert bpy.ops.wovenfit.remove_pressure() == {"FINISHED"}
    assert [one.mark.vertex for one in limb.wovenfit.pressures] == [200, 300]


def test_values_are_typed_in_mmhg_or_kpa():
    limb = scene.tube()
    scene.pin(limb, 500, 2.0)
    one = limb.wovenfit.pressures[0]
    one.mmhg = 12.0
    scene.near(one.kpa, 12.0 * 0.133322, 1e-6)
    one.kpa = 1.0
    scene.near(one.mmhg, 7.5006, 1e-3)
    limb.wovenfit.most_kpa_mmhg = 10.0
    scene.near(limb.wovenfit.most_kpa, 1.33322, 1e-5)


def test_painted_weights_ask_for_the_highest_pressure_times_the_weight():
    limb = scene.tube()
    assert bpy.ops.wovenfit.paint() == {"FINISHED"}
    assert limb.mode == "WEIGHT_PAINT" and limb.wovenfit.source == "painted"
    bpy.ops.object.mode_set(mode="OBJECT")
    group = limb.vertex_groups[limb.wovenfit.group]
    scene.refused(bpy.ops.wovenfit.flatten, "nothing is painted", group.name)
    heights = scene.vectors(limb.data.vertices, "co")[:, 2]
    middle = np.flatnonzero((heights > 0.045) & (heights < 0.075)).tolist()
    group.add(middle, 0.5, "REPLACE")
    limb.wovenfit.most_kpa = 4.0
    scene.flatten()
    rows = scene.result()["pressures"]
    # 2 kPa, where it was painted and nowhere else.
    assert len(rows) > 10
    for row in rows:
        scene.near(row["asked_kpa"], 2.0, 1e-6)
        assert 44.0 < row["at"][2] < 76.0, row["at"]
        assert row["met"], row["reason"]
    strain = scene.values(limb.data, "wovenfit_warp_strain")
    scene.near(float(np.median(strain[middle])), 2e-3 * scene.RADIUS / STIFFNESS, 0.004)
    limb.wovenfit.group = "gone"
    scene.refused(bpy.ops.wovenfit.flatten, "'gone'", "Paint")


def test_a_painted_elbow_is_reached():
    limb, design = scene.arm()
    points, _, _ = scene.sample()
    group = limb.vertex_groups.new(name="paint")
    limb.wovenfit.source, limb.wovenfit.group = "painted", "paint"
    limb.wovenfit.most_kpa = 2.0
    # Round the forearm's end, where the design asks for 14 mmHg.
    near = np.linalg.norm(points - design["pressures"][3]["at"], axis=1) < 15.0
    group.add(np.flatnonzero(near).tolist(), 1.0, "REPLACE")
    scene.flatten()
    rows = scene.result()["pressures"]
    # One pressure over a patch of a real shape is more than a thread can give everywhere: within a
    # tenth of it, and the reason where that is a miss.
    assert len(rows) >= 3
    for row in rows:
        scene.near(row["got_kpa"], 2.0, 0.2)
        assert row["met"] or row["reason"]
    assert any("painted" in one["message"] for one in scene.result()["warnings"])


def test_a_mark_stays_with_its_vertex_when_that_is_moved():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    for vertex in limb.data.vertices:
        vertex.co.x *= 1.1
        vertex.co.y *= 1.1
    scene.flatten()
    scene.near(scene.result()["pressures"][0]["at"][0], 1.1 * scene.RADIUS, 0.01)
    assert limb.wovenfit.pressures[0].mark.vertex == 15 * scene.SIDES


def test_a_mark_finds_its_vertex_after_others_were_deleted():
    limb = scene.tube()
    vertex = 15 * scene.SIDES + 7
    scene.pin(limb, vertex, 2.0)
    # The lowest ring goes, and all indices with it.
    scene.choose(limb, range(scene.SIDES))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    scene.flatten()
    assert limb.wovenfit.pressures[0].mark.vertex == vertex - scene.SIDES
    assert not any("is gone" in one["message"] for one in scene.result()["warnings"])
    scene.near(scene.result()["pressures"][0]["at"][2], 60.0, 0.01)


def test_a_mark_whose_vertex_is_gone_keeps_its_place_and_says_so():
    limb = scene.tube()
    vertex = 15 * scene.SIDES + 7
    scene.pin(limb, vertex, 2.0)
    scene.choose(limb, [vertex])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.dissolve_verts()
    bpy.ops.mesh.quads_convert_to_tris()
    bpy.ops.object.mode_set(mode="OBJECT")
    scene.flatten()
    said = [one["message"] for one in scene.result()["warnings"]]
    assert any("the vertex of pressure 1 is gone" in one for one in said), said
    row = scene.result()["pressures"][0]
    scene.near(row["at"][2], 60.0, 1.0)
    # And it can be given another.
    scene.choose(limb, [300])
    assert bpy.ops.wovenfit.move_pressure() == {"FINISHED"}
    scene.flatten()
    assert not any("is gone" in one["message"] for one in scene.result()["warnings"])
    assert bpy.ops.wovenfit.select_pressure() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [one.index for one in limb.data.vertices if one.select] == [300]


def test_a_wish_above_the_limit_is_refused_until_the_limit_is_raised():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES, 20.0)
    # In this host's words.
    text = scene.refused(bpy.ops.wovenfit.flatten, "13.3", "pressure 1 is 20", "Piece and Limits")
    assert "limits.max_kpa" not in text and "[0]" not in text, text
    design = limb.wovenfit.design
    design.use_limits_max_kpa = True
    design.limits_max_kpa_mmhg = 160.0
    scene.flatten()
    scene.near(json.loads(limb.wovenfit.result)["pressures"][0]["asked_kpa"], 20.0, 1e-5)
