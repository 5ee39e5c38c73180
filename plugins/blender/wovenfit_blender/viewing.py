"""The operators that help to look: colours in the viewport, a warning's place."""

import bpy

from .properties import limb_of


class WOVENFIT_OT_show_colours(bpy.types.Operator):
    """Show the colour attribute in this 3D view (solid shading), or the view's own colours again"""

    bl_idname = "wovenfit.show_colours"
    bl_label = "Show Colours"

    @classmethod
    def poll(cls, context):
        if context.space_data is None or context.space_data.type != "VIEW_3D":
            cls.poll_message_set("Press this in a 3D view")
            return False
        return True

    def execute(self, context):
        shading = context.space_data.shading
        on = shading.type == "SOLID" and shading.color_type == "VERTEX"
        shading.type = "SOLID"
        shading.color_type = "MATERIAL" if on else "VERTEX"
        return {"FINISHED"}


class WOVENFIT_OT_show_place(bpy.types.Operator):
    """Move the 3D cursor to where this is and look there"""

    bl_idname = "wovenfit.show_place"
    bl_label = "Show Place"

    at: bpy.props.FloatVectorProperty(size=3)

    def execute(self, context):
        from .limb import unit_of

        limb = limb_of(context)
        if limb is None:
            return {"CANCELLED"}
        unit = unit_of(limb, context.scene)
        context.scene.cursor.location = [x / unit for x in self.at]
        if context.space_data is not None and context.space_data.type == "VIEW_3D":
            context.space_data.region_3d.view_location = context.scene.cursor.location
        return {"FINISHED"}


CLASSES = (WOVENFIT_OT_show_colours, WOVENFIT_OT_show_place)
