"""Cancel, save and reload, duplicates, leaving: what stays and what must not."""

import addon_utils
import bpy
import numpy as np
import scene


def test_cancel_changes_nothing():
    limb = scene.pinned_arm()
    job = scene.addon("job")
    job.begin(limb, bpy.context, warm=False)
    try:
        job.begin(limb, bpy.context, warm=False)
    except job.Refused as refused:
        assert "already" in str(refused)
    else:
        raise AssertionError("a second job began")
    assert not bpy.ops.wovenfit.flatten.poll()
    assert bpy.ops.wovenfit.cancel() == {"FINISHED"}
    while not job.running.poll(0.05):
        pass
    try:
        job.finish(bpy.context)
    except job.Refused as refused:
        assert "cancelled" in str(refused)
    else:
        raise AssertionError("a cancelled job found something")
    assert job.running is None and limb.wovenfit.flat is None and limb.wovenfit.result == ""
    assert "wovenfit" not in limb.data.uv_layers and len(bpy.data.objects) == 1
    # And the next one works.
    scene.flatten()


def test_a_limb_that_is_deleted_or_changed_meanwhile_is_said():
    limb = scene.tube()
    job = scene.addon("job")
    job.begin(limb, bpy.context, warm=False)
    bpy.data.objects.remove(limb)
    while not job.running.poll(0.05):
        pass
    try:
        job.finish(bpy.context)
    except job.Refused as refused:
        assert "is gone" in str(refused)
    else:
        raise AssertionError("a pattern of nothing")
    limb = scene.tube()
    job.begin(limb, bpy.context, warm=False)
    scene.choose(limb, range(scene.SIDES))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    while not job.running.poll(0.05):
        pass
    try:
        job.finish(bpy.context)
    except job.Refused as refused:
        assert "was changed" in str(refused)
    else:
        raise AssertionError("a pattern of another mesh")


def test_everything_survives_saving_and_opening():
    limb = scene.pinned_arm()
    kept = limb.wovenfit
    kept.design.fabric_name, kept.design.piece_name = "mine", "brace 7"
    kept.settings.spacing = 7.0
    scene.flatten()
    wanted = [(one.mark.vertex, one.kpa) for one in kept.pressures]
    table = scene.result()["pressures"]
    path = scene.SCRATCH / f"saved-{bpy.app.version[0]}-{bpy.app.version[1]}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    # With this one selected, and another file between.
    bpy.ops.wm.read_homefile(use_empty=True)
    assert "limb" not in bpy.data.objects
    bpy.ops.wm.open_mainfile(filepath=str(path))
    limb = bpy.data.objects["limb"]
    scene.activate(limb)
    kept = limb.wovenfit
    assert [(one.mark.vertex, one.kpa) for one in kept.pressures] == wanted
    assert (kept.design.fabric_name, kept.design.piece_name) == ("mine", "brace 7")
    assert kept.settings.spacing == 7.0
    assert scene.result()["pressures"] == table
    assert kept.flat is not None and kept.flat.wovenfit.limb == limb
    assert "wovenfit" in limb.data.uv_layers
    # The library's own result is not in a file; the operators say what to do.
    assert not bpy.ops.wovenfit.export_all.poll()
    flat = kept.flat
    scene.update()
    assert kept.flat == flat and bpy.ops.wovenfit.export_all.poll()
    assert scene.result()["pressures"] == table


def test_a_duplicate_has_its_own_wishes_and_its_own_pattern():
    limb = scene.pinned_arm()
    scene.flatten()
    flat = limb.wovenfit.flat
    scene.activate(limb)
    bpy.ops.object.duplicate()
    other = bpy.context.object
    assert other != limb and len(other.wovenfit.pressures) == 4
    other.wovenfit.pressures[0].kpa = 1.0
    scene.near(limb.wovenfit.pressures[0].kpa, 1.599864, 1e-6)
    before = scene.vectors(flat.data.vertices, "co")
    scene.flatten()
    assert other.wovenfit.flat not in (None, flat)
    assert other.wovenfit.flat.wovenfit.limb == other and limb.wovenfit.flat == flat
    assert (scene.vectors(flat.data.vertices, "co") == before).all()
    # Its mesh is its own, too: the limb's values stay.
    assert other.data != limb.data


def test_one_step_back_undoes_a_flatten():
    limb = scene.pinned_arm()
    bpy.ops.ed.undo_push(message="pinned")
    scene.flatten()
    bpy.ops.ed.undo_push(message="flattened")
    name = limb.name
    bpy.ops.ed.undo()
    limb = bpy.data.objects[name]
    assert limb.wovenfit.flat is None and limb.wovenfit.result == ""
    assert len(limb.wovenfit.pressures) == 4
    assert "wovenfit" not in limb.data.uv_layers
    assert not any(edge.use_seam for edge in limb.data.edges)
    assert not any("pattern" in one.name for one in bpy.data.objects)
    bpy.ops.ed.redo()
    limb = bpy.data.objects[name]
    assert limb.wovenfit.flat is not None and "wovenfit" in limb.data.uv_layers
    # The pattern is in memory still: it can be exported.
    scene.activate(limb)
    assert bpy.ops.wovenfit.export_all.poll()


def test_a_deleted_pattern_is_made_anew():
    limb = scene.tube()
    scene.flatten()
    bpy.data.objects.remove(limb.wovenfit.flat)
    assert limb.wovenfit.flat is None
    scene.flatten()
    assert limb.wovenfit.flat is not None
    # Deleted in the viewport it is only taken out of the scene.
    flat = limb.wovenfit.flat
    bpy.context.collection.objects.unlink(flat)
    scene.flatten()
    assert limb.wovenfit.flat.name in bpy.context.view_layer.objects


def test_two_flattens_give_the_same_bytes():
    limb = scene.pinned_arm()
    first = scene.flatten().pattern.file("pattern.svg")
    coordinates = scene.vectors(limb.wovenfit.flat.data.vertices, "co")
    assert scene.flatten().pattern.file("pattern.svg") == first
    assert (scene.vectors(limb.wovenfit.flat.data.vertices, "co") == coordinates).all()


def test_it_can_be_disabled_and_enabled_again():
    limb = scene.pinned_arm()
    scene.flatten()
    wanted = [(one.mark.vertex, one.kpa) for one in limb.wovenfit.pressures]
    addon_utils.disable(scene.module_name)
    assert not hasattr(bpy.types.Object, "wovenfit")
    assert not hasattr(bpy.types, "WOVENFIT_PT_flatten")
    addon_utils.enable(scene.module_name)
    assert addon_utils.check(scene.module_name)[1]
    assert [(one.mark.vertex, one.kpa) for one in limb.wovenfit.pressures] == wanted
    scene.flatten()
    assert np.isfinite(scene.values(limb.data, "wovenfit_warp_strain")).all()
