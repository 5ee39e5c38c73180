"""Presets of fabrics: the library's to begin with, and the designer's own, which Blender keeps."""

import bpy
from bl_operators.presets import AddPresetBase

from .plain.fields import design_fields
from .properties import limb_of
from .wovenfit import FABRICS

_FOLDER = "wovenfit/fabric"


def fabric_fields():
    """The numbers and the name of a fabric; first those that every fabric has, in their order."""
    first = list(dict.fromkeys(f"fabric.{key}" for fabric in FABRICS.values() for key in fabric))
    fields = [field for field in design_fields() if field.section == "fabric"]
    return sorted(
        fields,
        key=lambda one: (one.name not in first, first.index(one.name) if one.name in first else 0),
    )


class WOVENFIT_MT_fabrics(bpy.types.Menu):
    """Fabrics"""

    bl_label = "Fabric Presets"
    preset_subdir = _FOLDER
    preset_operator = "script.execute_preset"

    def draw(self, context):
        for name in FABRICS:
            row = self.layout.operator("wovenfit.take_fabric", text=f"Paper: {name}")
            row.fabric = name
        self.layout.separator()
        bpy.types.Menu.draw_preset(self, context)


class WOVENFIT_OT_take_fabric(bpy.types.Operator):
    """A test fabric of Wang and Tang, to begin with: measure yours at working strain"""

    bl_idname = "wovenfit.take_fabric"
    bl_label = "Take Fabric"
    bl_options = {"REGISTER", "UNDO"}

    fabric: bpy.props.StringProperty()

    @classmethod
    def poll(cls, context):
        return limb_of(context) is not None

    def execute(self, context):
        group = limb_of(context).wovenfit.design
        chosen = FABRICS[self.fabric]
        for field in fabric_fields():
            setattr(
                group, field.identifier, chosen.get(field.name.partition(".")[2], field.default)
            )
        return {"FINISHED"}


class WOVENFIT_OT_keep_fabric(AddPresetBase, bpy.types.Operator):
    """Keep this fabric as a preset for all files, or remove the chosen preset"""

    bl_idname = "wovenfit.keep_fabric"
    bl_label = "Keep Fabric"
    preset_menu = "WOVENFIT_MT_fabrics"
    preset_subdir = _FOLDER
    preset_defines = [
        "limb = bpy.context.object.wovenfit.limb or bpy.context.object",
        "design = limb.wovenfit.design",
    ]

    @property
    def preset_values(self):
        """What a preset holds."""
        return [f"design.{field.identifier}" for field in fabric_fields()]


CLASSES = (WOVENFIT_MT_fabrics, WOVENFIT_OT_take_fabric, WOVENFIT_OT_keep_fabric)
