"""Dialogs are made from the library's tables, and what is typed reaches the library."""

import re
from pathlib import Path

import bpy
import scene


def properties(group):
    """The properties of a group by name."""
    return {one.identifier: one for one in group.bl_rna.properties}


def test_every_parameter_is_a_property_with_its_range_default_and_text():
    limb = scene.tube()
    have = properties(limb.wovenfit.settings)
    library = scene.addon("wovenfit")
    for row in library.parameter_table():
        if row.name == "units":
            continue
        one = have[row.name]
        assert row.summary in one.description
        assert row.unit in one.name
        if row.kind in (library.ParameterKind.NUMBER, library.ParameterKind.INTEGER):
            scene.near(one.hard_min, row.least, 1e-6 * abs(row.least))
            scene.near(one.hard_max, row.most, 1e-6 * abs(row.most))
            scene.near(one.default, row.default, 1e-6 * abs(row.default))
        elif row.kind is library.ParameterKind.CHOICE:
            assert {item.identifier for item in one.enum_items} == set(row.choices)
            assert one.default == row.default
        else:
            assert one.default == row.default
    units = properties(limb.wovenfit)["units"]
    named = {item.identifier for item in units.enum_items}
    assert named == {"scene", "mm", "cm", "m", "in"}


def test_untouched_settings_are_the_librarys_defaults_to_the_last_bit():
    limb = scene.tube()
    values = scene.addon("wishes").parameters_of(limb)
    for row in scene.addon("wovenfit").parameter_table():
        assert values[row.name] == row.default, row.name


def test_settings_reach_the_solver():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    scene.flatten()
    steps = scene.result()["steps"]
    limb.wovenfit.settings.newton_steps = 1
    scene.flatten()
    assert scene.result()["steps"] == 1 < steps and not scene.result()["converged"]
    limb.wovenfit.settings.newton_steps = 100
    limb.wovenfit.settings.curvature_radius = 14.0
    scene.flatten()
    scene.near(scene.result()["curvature_radius_mm"], 14.0, 1e-9)


def test_every_wish_of_the_design_file_is_a_property():
    limb = scene.tube()
    have = properties(limb.wovenfit.design)
    schema = scene.addon("wovenfit").design_schema()["properties"]
    for key, one in schema["fabric"]["properties"].items():
        shown = have[f"fabric_{key}"]
        assert shown.description == one["description"]
    assert "N/mm" in have["fabric_warp"].name
    for name in ("pressure_model", "facing", "limits_max_kpa", "piece_name", "piece_reference"):
        assert name in have
    scene.near(have["fabric_max_strain"].hard_max, 3.0, 1e-6)


def test_a_stiffer_fabric_is_strained_less():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    for stiffness in (0.5, 1.0):
        limb.wovenfit.design.fabric_warp = stiffness
        scene.flatten()
        strain = scene.result()["pressures"][0]["warp_strain"]
        scene.near(strain, 2e-3 * scene.RADIUS / stiffness, 0.004)


def test_the_fabrics_to_begin_with_can_be_taken_and_own_ones_kept():
    limb = scene.tube()
    fabric = limb.wovenfit.design
    assert bpy.ops.wovenfit.take_fabric(fabric="anisotropic") == {"FINISHED"}
    assert (fabric.fabric_warp, fabric.fabric_weft) == (0.5, 5.0)
    fabric.fabric_warp, fabric.fabric_name = 0.75, "my power net"
    assert bpy.ops.wovenfit.keep_fabric(name="my power net") == {"FINISHED"}
    assert bpy.ops.wovenfit.take_fabric(fabric="isotropic") == {"FINISHED"}
    assert fabric.fabric_warp == 0.5
    kept = [
        path
        for folder in bpy.utils.preset_paths("wovenfit/fabric")
        for path in bpy.utils._os.scandir(folder)
        if path.name.startswith("my_power_net")
    ]
    assert len(kept) == 1
    done = bpy.ops.script.execute_preset(filepath=kept[0].path, menu_idname="WOVENFIT_MT_fabrics")
    assert done == {"FINISHED"}
    scene.near(fabric.fabric_warp, 0.75, 1e-6)
    assert fabric.fabric_name == "my power net"


def test_the_piece_is_named_on_the_pattern():
    limb = scene.tube()
    limb.wovenfit.design.piece_name = "Elbow brace 17"
    assert b"Elbow brace 17" in scene.flatten().pattern.file("pattern.svg")


def test_the_pressure_model_is_the_one_that_is_chosen():
    limb = scene.tube()
    scene.pin(limb, 15 * scene.SIDES, 2.0)
    strains = {}
    for model in ("laplace", "paper"):
        limb.wovenfit.design.pressure_model = model
        scene.flatten()
        strains[model] = scene.result()["pressures"][0]["warp_strain"]
    # On a cylinder the paper's formula gives pi/2 of Laplace's pressure, to first order.
    assert 1.4 < strains["laplace"] / strains["paper"] < 1.8, strains


def test_every_icon_that_a_panel_shows_is_there():
    icons = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys()
    folder = Path(scene.addon("panels").__file__).parent
    used = {
        icon
        for path in folder.glob("*.py")
        for icon in re.findall(r'"([A-Z][A-Z_]+)"', path.read_text(encoding="utf-8"))
        if f'icon="{icon}"' in path.read_text(encoding="utf-8")
        or f'"{icon}", alert' in path.read_text(encoding="utf-8")
    }
    assert len(used) > 15 and used <= set(icons), used - set(icons)
