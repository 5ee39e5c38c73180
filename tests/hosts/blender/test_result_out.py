"""The flat mesh, the UV map, attributes and colours; Update after a change."""

import bpy
import numpy as np
import scene

VALUES = ("wovenfit_warp_strain", "wovenfit_weft_strain", "wovenfit_pressure_kpa")


def test_the_flat_mesh_is_the_pattern_at_true_size_beside_the_limb():
    limb = scene.pinned_arm()
    pattern = scene.flatten().pattern
    flat = limb.wovenfit.flat
    mesh = flat.data
    assert flat.wovenfit.limb == limb and bpy.context.object == limb
    got = 1000.0 * scene.vectors(mesh.vertices, "co")
    assert np.abs(got[:, :2] - pattern.coordinates).max() < 1e-3
    assert (got[:, 2] == 0.0).all()
    corners = np.array([list(face.vertices) for face in mesh.polygons])
    assert (corners == pattern.triangles).all()
    # Upright, to the right of the limb, at its foot.
    bpy.context.view_layer.update()
    there, own = scene.world(flat), scene.world(limb)
    assert there[:, 0].min() > own[:, 0].max()
    scene.near(float(there[:, 2].min()), float(own[:, 2].min()), 1e-5)
    scene.near(float(np.ptp(there[:, 2])), pattern.figures.height_mm / 1000.0, 1e-5)
    # The active object may be the pattern: panels are still about the limb.
    scene.activate(flat)
    assert scene.limb_now() == limb


def test_the_outline_is_marked_and_as_long_as_it_is():
    limb = scene.pinned_arm()
    pattern = scene.flatten().pattern
    mesh = limb.wovenfit.flat.data
    cut = np.empty(len(mesh.edges), bool)
    mesh.attributes["wovenfit_outline"].data.foreach_get("value", cut)
    places = 1000.0 * scene.vectors(mesh.vertices, "co")
    ends = np.array([list(edge.vertices) for edge in mesh.edges])[cut]
    got = np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1).sum()
    wanted = sum(
        np.linalg.norm(loop - np.roll(loop, -1, axis=0), axis=1).sum() for loop in pattern.outlines
    )
    scene.near(got, wanted, 0.05)
    # The boundary, and nothing else.
    uses = {}
    for face in mesh.polygons:
        for pair in face.edge_keys:
            uses[pair] = uses.get(pair, 0) + 1
    assert {tuple(sorted(pair)) for pair in ends.tolist()} == {k for k, n in uses.items() if n == 1}


def test_the_uv_map_is_the_pattern_in_metres():
    limb = scene.pinned_arm()
    pattern = scene.flatten().pattern
    uv = 1000.0 * scene.corner_uv(limb.data)
    # A face through which the seam runs goes on beyond it, by a face at most.
    assert uv.min() > -8.0 and uv[:, 0].max() < pattern.figures.width_mm + 8.0
    vertices = np.array([loop.vertex_index for loop in limb.data.loops])
    own = pattern.vertex_to_given_vertex
    uncut = np.unique(own[own != 0xFFFFFFFF], return_counts=True)
    once = set(uncut[0][uncut[1] == 1].tolist())
    torn = {v for edge in limb.data.edges if edge.use_seam for v in edge.vertices}
    at = {int(v): pattern.coordinates[i] for i, v in enumerate(own)}
    inside = [k for k, v in enumerate(vertices) if v in once and v not in torn]
    assert len(inside) > 0.9 * len(vertices)
    wanted = np.array([at[int(vertices[k])] for k in inside])
    assert np.abs(uv[inside] - wanted).max() < 0.02
    # Every triangle's area, with its sign: none is turned over, together they are the pattern.
    corner = uv.reshape(-1, 3, 2)
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert (area > 0.0).all()
    scene.near(area.sum() / pattern.figures.area_mm2, 1.0, 0.002)


def test_strains_are_those_of_the_geometry():
    limb = scene.pinned_arm()
    scene.flatten()
    # From the two meshes alone: a short step along warp in the pattern against the one on the limb.
    uv = 1000.0 * scene.corner_uv(limb.data).reshape(-1, 3, 2)
    places = 1000.0 * scene.vectors(limb.data.vertices, "co")
    vertices = np.array([list(face.vertices) for face in limb.data.polygons])
    sides = np.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=2)
    worn = places[vertices]
    edges = np.stack([worn[:, 1] - worn[:, 0], worn[:, 2] - worn[:, 0]], axis=2)
    along = edges @ np.linalg.inv(sides)
    for name, axis in (("wovenfit_warp_strain", 0), ("wovenfit_weft_strain", 1)):
        by_face = np.linalg.norm(along[:, :, axis], axis=1) - 1.0
        kept = scene.values(limb.data, name)[vertices].mean(axis=1)
        assert np.isfinite(kept).all()
        scene.near(float(np.sqrt(np.mean((by_face - kept) ** 2))), 0.0, 0.006)


def test_attributes_agree_on_limb_and_pattern():
    limb = scene.pinned_arm()
    pattern = scene.flatten().pattern
    own = pattern.vertex_to_given_vertex
    known = own != 0xFFFFFFFF
    for name in VALUES:
        flat = scene.values(limb.wovenfit.flat.data, name)
        worn = scene.values(limb.data, name)
        assert len(flat) == len(pattern.coordinates) and len(worn) == len(limb.data.vertices)
        gap = np.abs(flat[known] - worn[own[known]])
        # On the seam a vertex has a value on either side.
        assert np.median(gap) < 1e-6 and gap.max() < 0.2 * np.ptp(flat)
    pressures = scene.result()["pressures"]
    for one, row in zip(limb.wovenfit.pressures, pressures):
        near = scene.values(limb.data, VALUES[2])[one.mark.vertex]
        scene.near(float(near), row["got_kpa"], 0.25 * row["got_kpa"])


def test_colours_show_what_is_chosen_from_dark_to_bright():
    limb = scene.pinned_arm()
    scene.flatten()
    for shown, name in zip(("warp", "weft", "pressure"), VALUES):
        limb.wovenfit.shown = shown
        for mesh in (limb.data, limb.wovenfit.flat.data):
            assert mesh.color_attributes.active_color.name == "wovenfit_colour"
            colour = scene.vectors(mesh.attributes["wovenfit_colour"].data, "color", 4)
            light = colour[:, :3] @ [0.2126, 0.7152, 0.0722]
            value = scene.values(mesh, name)
            known = np.isfinite(value)
            order = np.argsort(value[known])
            ranked = light[known][order]
            assert (np.diff(ranked) > -1e-4).all()
            assert ranked[-1] > ranked[0] + 0.5
        least, most = limb.wovenfit.scale_least, limb.wovenfit.scale_most
        inside = (value >= least) & (value <= most)
        assert 0.95 < inside[known].mean() < 1.0


def test_update_goes_on_from_the_last_pattern_and_agrees_with_flatten():
    limb = scene.pinned_arm()
    first = scene.flatten()
    flat = limb.wovenfit.flat
    flat.location.x += 0.5
    assert not first.warm and not limb.wovenfit.stale
    limb.wovenfit.pressures[2].kpa = 1.5
    assert limb.wovenfit.stale
    warm = scene.update()
    assert warm.warm and not limb.wovenfit.stale
    assert limb.wovenfit.flat == flat and len(bpy.data.objects) == 2
    got = scene.result()["pressures"][2]
    assert got["met"]
    scene.near(got["asked_kpa"], 1.5, 1e-6)
    cold = scene.flatten()
    assert not cold.warm
    assert np.abs(warm.pattern.coordinates - cold.pattern.coordinates).max() < 0.2
    # It is still where the designer put it.
    scene.near(flat.location.x, limb.wovenfit.flat.location.x, 0.0)


def test_update_after_a_new_seam_or_a_moved_limb_begins_anew_by_itself():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES + 20, 2.0)
    scene.flatten()
    for edge in limb.data.edges:
        a, b = edge.vertices
        edge.use_seam = a % scene.SIDES == b % scene.SIDES == 40
    seamed = scene.update()
    assert not seamed.warm
    along = seamed.pattern.positions[seamed.pattern.seams[0].left]
    wanted = 2 * np.pi * 40 / scene.SIDES
    scene.near(float(np.arctan2(along[:, 1], along[:, 0]).mean() % (2 * np.pi)), wanted, 0.01)
    limb.scale = (1.1, 1.1, 1.0)
    bpy.context.view_layer.update()
    assert not scene.update().warm
    assert scene.result()["pressures"][0]["met"]


def test_the_limbs_own_mesh_is_left_as_it_is():
    limb = scene.pinned_arm()
    limb.data.uv_layers.new(name="texture")
    before = scene.vectors(limb.data.vertices, "co")
    corners = [loop.vertex_index for loop in limb.data.loops]
    scene.flatten()
    assert (scene.vectors(limb.data.vertices, "co") == before).all()
    assert [loop.vertex_index for loop in limb.data.loops] == corners
    assert "texture" in limb.data.uv_layers
    assert limb.data.uv_layers["texture"].active_render
