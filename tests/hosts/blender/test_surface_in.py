"""What the add-on reads: units, scales, modifiers, polygons; and what it refuses."""

import itertools
import json

import bpy
import numpy as np
import scene


def width_of(limb):
    """The pattern's width in mm, read off the flat mesh and the unit of its surface."""
    unit = json.loads(limb.wovenfit.result)["unit_mm"]
    return float(np.ptp(scene.vectors(limb.wovenfit.flat.data.vertices, "co")[:, 0])) * unit


def test_check_says_what_the_command_line_says():
    limb, _ = scene.arm()
    assert bpy.ops.wovenfit.check() == {"FINISHED"}
    found = json.loads(limb.wovenfit.check)
    assert found["shape"].startswith("tube"), found["shape"]
    points, faces, _ = scene.sample()
    assert found["triangles"] == len(faces)
    for got, wanted in zip(found["size_mm"], np.ptp(points, axis=0)):
        scene.near(got, wanted, 0.01)
    assert found["defects"] == [] and found["warnings"] == []
    assert 200.0 < min(girth for _, girth in found["girths"]) < 300.0


def test_a_limb_in_a_wrong_unit_is_refused_with_the_remedy_of_this_host():
    # A scan in mm whose units became metres: 222 m of arm.
    limb, _ = scene.arm(unit=1.0)
    assert bpy.ops.wovenfit.check() == {"FINISHED"}
    said = json.loads(limb.wovenfit.check)["defects"][0]["message"]
    assert "set Units to mm in the panel Surface" in said, said
    text = scene.refused(
        bpy.ops.wovenfit.flatten, "set Units to mm in the panel Surface", "taken as 1000 mm"
    )
    assert "--" not in text, text
    assert limb.wovenfit.error in text
    assert limb.wovenfit.flat is None
    limb.wovenfit.units = "mm"
    scene.flatten()
    assert limb.wovenfit.error == ""
    scene.near(limb.wovenfit.flat.dimensions[0], scene.result()["width_mm"], 0.01)


def test_scene_scale_and_object_scale_give_the_same_pattern():
    widths = []
    limb, _ = scene.arm()
    scene.flatten()
    widths.append(width_of(limb))
    scene.clear()
    limb, _ = scene.arm(unit=1.0)
    bpy.context.scene.unit_settings.scale_length = 0.001
    scene.flatten()
    widths.append(width_of(limb))
    # At true size: a unit of the scene is a millimetre.
    scene.near(limb.wovenfit.flat.dimensions[0], widths[0], 0.05)
    scene.clear()
    limb, _ = scene.arm(unit=1.0)
    limb.scale = (0.001, 0.001, 0.001)
    bpy.context.view_layer.update()
    scene.flatten()
    widths.append(width_of(limb))
    scene.near(limb.wovenfit.flat.dimensions[0], widths[0] / 1000.0, 0.00005)
    for width in widths[1:]:
        scene.near(width, widths[0], 0.05)


def test_a_mirrored_limb_is_as_wide_and_not_inside_out():
    limb = scene.pinned_arm()
    scene.flatten()
    width = width_of(limb)
    scene.clear()
    limb = scene.pinned_arm()
    limb.scale = (-1.0, 1.0, 1.0)
    # As the triangles face, not as the shape shows: inside out nothing would press.
    limb.wovenfit.design.facing = "outward"
    bpy.context.view_layer.update()
    scene.flatten()
    scene.near(width_of(limb), width, 0.5)
    assert all(row["met"] for row in scene.result()["pressures"])
    # The flat mesh shows its outside: all normals along its own z.
    normals = scene.vectors(limb.wovenfit.flat.data.polygons, "normal")
    assert (normals[:, 2] > 0.99).all()


def test_a_modifier_that_only_moves_vertices_is_on_and_the_result_is_on_the_limb():
    limb = scene.tube()
    scene.flatten()
    plain = width_of(limb)
    cast = limb.modifiers.new("wider", "CAST")
    cast.cast_type, cast.use_x, cast.use_y, cast.use_z = "CYLINDER", True, True, False
    cast.factor, cast.use_radius_as_size, cast.size = 1.0, False, 0.05
    scene.flatten()
    assert limb.wovenfit.worn is None
    # A cylinder of 50 instead of 45 mm.
    scene.near(width_of(limb) / plain, 50.0 / 45.0, 0.005)
    assert "wovenfit" in limb.data.uv_layers


def test_a_modifier_that_makes_faces_puts_the_result_onto_a_copy():
    limb = scene.tube(quads=True)
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    limb.modifiers.new("finer", "SUBSURF").levels = 1
    scene.flatten()
    worn = limb.wovenfit.worn
    assert worn is not None and "wovenfit" not in limb.data.uv_layers
    assert len(worn.data.polygons) == 4 * len(limb.data.polygons)
    assert any(
        "copy with the modifiers applied" in one["message"] for one in scene.result()["warnings"]
    )
    assert np.isfinite(scene.values(worn.data, "wovenfit_warp_strain")).all()
    # Its pressure is found on the finer surface; and again it is the same copy.
    assert scene.result()["pressures"][0]["met"]
    scene.flatten()
    assert limb.wovenfit.worn == worn


def test_quads_are_split_and_mapped_back_corner_by_corner():
    limb = scene.tube(quads=True)
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    pattern = scene.flatten().pattern
    uv = scene.corner_uv(limb.data) * 1000.0
    corners = np.array([list(face.vertices) for face in limb.data.polygons])
    four = uv.reshape(-1, 4, 2)
    # No face is torn: its sides are the tube's, drawn together along warp by the strain there.
    sides = np.linalg.norm(four - np.roll(four, -1, axis=1), axis=2)
    wanted = scene.GIRTH / scene.SIDES
    assert sides[:, ::2].max() < 1.02 * wanted and sides[:, ::2].min() > 0.7 * wanted
    scene.near(float(sides[:, 1::2].mean()), scene.LENGTH / (scene.RINGS - 1), 0.1)
    # Together they cover the pattern.
    x, y = four[..., 0], four[..., 1]
    area = 0.5 * np.abs((x * np.roll(y, -1, 1) - np.roll(x, -1, 1) * y).sum(axis=1)).sum()
    scene.near(area / pattern.figures.area_mm2, 1.0, 0.002)
    assert corners.shape == (48 * 30, 4)


def test_quads_through_which_a_seam_runs_are_not_torn():
    limb = scene.tube(quads=True)
    # A staircase of edges, which is drawn straight and so runs through faces.
    steps = [(0, 5)]
    for ring in range(1, scene.RINGS):
        steps.append((ring, steps[-1][1]))
        if ring % 3 == 0 and ring < scene.RINGS - 1:
            steps.append((ring, steps[-1][1] + 1))
    line = [ring * scene.SIDES + side for ring, side in steps]
    wanted = {tuple(sorted(pair)) for pair in itertools.pairwise(line)}
    for edge in limb.data.edges:
        edge.use_seam = tuple(sorted(edge.vertices)) in wanted
    pattern = scene.flatten().pattern
    flat = pattern.given_corner_coordinates
    split = np.linalg.norm(flat[0::2, 0] - flat[1::2, 0], axis=1) > 20.0
    assert split.any(), "the seam runs through no face: nothing is tried here"
    four = (scene.corner_uv(limb.data) * 1000.0).reshape(-1, 4, 2)
    sides = np.linalg.norm(four - np.roll(four, -1, axis=1), axis=2)
    assert sides.max() < 1.3 * scene.GIRTH / scene.SIDES, sides.max()


def test_without_a_mesh_nothing_can_be_pressed():
    for operator in (bpy.ops.wovenfit.flatten, bpy.ops.wovenfit.check):
        assert not operator.poll()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    scene.activate(camera)
    for operator in (bpy.ops.wovenfit.flatten, bpy.ops.wovenfit.add_pressure):
        assert not operator.poll()
        scene.refused(operator, "poll")


def test_an_empty_mesh_is_refused_in_words():
    limb = scene.place([], [])
    scene.refused(bpy.ops.wovenfit.flatten)
    assert limb.wovenfit.error, "the panel says nothing"


def test_a_closed_mesh_is_refused():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.06, segments=32, ring_count=24)
    limb = bpy.context.object
    scene.refused(bpy.ops.wovenfit.flatten)
    assert limb.wovenfit.error and limb.wovenfit.flat is None
    assert "the surface is closed" in limb.wovenfit.error
    assert "switch on Selected faces only" in limb.wovenfit.error, limb.wovenfit.error
    # Which is what helps.
    heights = scene.vectors(limb.data.polygons, "center")[:, 2]
    scene.choose_faces(limb, np.abs(heights) < 0.025)
    limb.wovenfit.only_selected = True
    scene.flatten()
    assert 40.0 < scene.result()["height_mm"] < 65.0


def test_faulty_elements_are_named_and_selected_on_request():
    limb = scene.tube()
    points = scene.vectors(limb.data.vertices, "co")
    faces = [list(face.vertices) for face in limb.data.polygons]
    scene.clear()
    # A fin: a third triangle at one edge.
    edge = faces[700][:2]
    limb = scene.place(
        np.vstack([points, points[edge].mean(axis=0) * [1.3, 1.3, 1.0]]),
        [*faces, [*edge, len(points)]],
    )
    assert bpy.ops.wovenfit.check() == {"FINISHED"}
    assert json.loads(limb.wovenfit.check)["defects"]
    scene.refused(bpy.ops.wovenfit.flatten)
    assert limb.wovenfit.error and limb.wovenfit.faults
    assert bpy.ops.wovenfit.select_faults() == {"FINISHED"}
    assert limb.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    chosen = {vertex.index for vertex in limb.data.vertices if vertex.select}
    assert set(edge) <= chosen and len(chosen) < 10, chosen


def test_edit_mode_is_no_hindrance():
    limb = scene.tube()
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.wovenfit.check() == {"FINISHED"}
    scene.flatten()
    assert limb.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "wovenfit" in limb.data.uv_layers
