"""The add-on's preferences: one for all files."""

import bpy

from .plain.wording import KPA, MMHG


class WovenfitPreferences(bpy.types.AddonPreferences):
    """Shown under Preferences > Add-ons."""

    bl_idname = __package__

    pressure_unit: bpy.props.EnumProperty(
        name="Pressure in",
        description="Unit in which pressures are typed and shown. Files keep kPa",
        items=[
            (MMHG, MMHG, "Millimetres of mercury, as compression classes are stated"),
            (KPA, KPA, "Kilopascal. 1 mmHg is 0.133322 kPa"),
        ],
        default=MMHG,
    )
    overlay: bpy.props.BoolProperty(
        name="Draw in the viewport",
        description="Pressures, orientation, outline, seams and the colour scale in 3D views",
        default=True,
    )

    def draw(self, context):
        self.layout.prop(self, "pressure_unit", expand=True)
        self.layout.prop(self, "overlay")


def preferences(context):
    """The preferences; None while the add-on is not enabled."""
    addon = context.preferences.addons.get(__package__)
    return None if addon is None else addon.preferences


def pressure_unit(context):
    """The unit in which pressures are shown: `MMHG` or `KPA`."""
    found = preferences(context)
    return MMHG if found is None else found.pressure_unit


CLASSES = (WovenfitPreferences,)
