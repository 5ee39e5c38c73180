"""The tab "WovenFit" in the 3D view's sidebar, from surface to files, and the Object menu."""

import bpy

from . import job
from .limb import unit_of
from .plain.fields import Kind, design_fields, parameter_fields
from .plain.record import read
from .plain.wording import MMHG, first_clause, millimetres, pressure, wrapped
from .preferences import pressure_unit
from .presets import fabric_fields
from .properties import PAINTED, limb_of

_PIXELS_PER_LETTER = 6.4
"""Of the interface's font at scale 1, a little more than its mean, so that no line is cut off."""
_MARGIN = 45
"""Pixels of a panel's line that hold no text."""


def letters(context):
    """Characters that fit into a line of the sidebar."""
    scale = context.preferences.system.ui_scale
    return int((context.region.width / scale - _MARGIN) / _PIXELS_PER_LETTER)


def paragraph(layout, context, text, icon="NONE", alert=False, less=0):
    """A text of several lines, `less` letters narrower than the panel."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    column.alert = alert
    width = letters(context) - less - (4 if icon != "NONE" else 0)
    for index, line in enumerate(wrapped(text, width)):
        if index == 0:
            column.label(text=line, icon=icon)
        else:
            column.label(text=line, icon="BLANK1" if icon != "NONE" else "NONE")


def note(layout, context, one, icon, alert=False, full=True):
    """A warning or defect, whole or its first clause, with a button to its place if it has one."""
    row = layout.row(align=True)
    text = one["message"] if full else first_clause(one["message"])
    paragraph(row, context, text, icon, alert, len("→→") if one.get("at") else 0)
    if one.get("at"):
        row.operator("wovenfit.show_place", text="", icon="PIVOT_CURSOR", emboss=False).at = one[
            "at"
        ]


def notes(layout, context, kept, all_of_them):
    """Warnings: what each is, and on request where and what to do."""
    if not all_of_them:
        return
    count = len(all_of_them)
    row = layout.split(factor=0.68)
    row.label(text=f"{count} warning{'s' if count > 1 else ''}", icon="ERROR")
    row.prop(kept, "full_notes", toggle=True)
    for one in all_of_them:
        note(layout, context, one, "DOT", full=kept.full_notes)


def kpa_or_mmhg(layout, context, group, name, label):
    """A field that holds kPa, in the unit that the designer prefers."""
    if pressure_unit(context) == MMHG:
        layout.prop(group, "mmhg" if name == "kpa" else f"{name}_mmhg", text=f"{label} (mmHg)")
    else:
        layout.prop(group, name, text=f"{label} (kPa)")


def field_row(layout, context, group, field):
    """A field that was made from the library's tables."""
    name = field.identifier
    if field.optional and field.kind is Kind.NUMBER:
        row = layout.row(align=True)
        row.prop(group, f"use_{name}", text="")
        layout = row.row(align=True)
        layout.active = getattr(group, f"use_{name}")
    # A number has its name within, where there is room for its unit.
    layout.use_property_split = field.kind in (Kind.TEXT, Kind.CHOICE)
    layout.use_property_decorate = False
    if field.unit == "kPa":
        kpa_or_mmhg(layout, context, group, name, field.label.partition(" (")[0])
    else:
        layout.prop(group, name)


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "WovenFit"

    def limb(self, context):
        """The limb; without one the panel says so."""
        limb = limb_of(context)
        if limb is None:
            self.layout.label(text="Select the limb: a mesh", icon="INFO")
        return limb


class WOVENFIT_PT_surface(_Panel, bpy.types.Panel):
    bl_label = "Surface"
    bl_order = 0

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, kept = self.layout, limb.wovenfit
        layout.label(text=limb.name, icon="MESH_DATA")
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(kept, "units")
        row = layout.row()
        row.alignment = "RIGHT"
        row.label(text=f"1 unit is {unit_of(limb, context.scene):g} mm")
        layout.operator("wovenfit.check", icon="VIEWZOOM")
        if not kept.check:
            return
        found = read(kept.check)
        column = layout.column(align=True)
        if found.get("shape"):
            column.label(text=found["shape"].capitalize())
        if found.get("size_mm"):
            size = " × ".join(f"{x:.0f}" for x in found["size_mm"])
            column.label(text=f"{size} mm, {found['triangles']} triangles")
        for one in found["defects"]:
            note(layout, context, one, "CANCEL", alert=True)
        notes(layout, context, kept, found["warnings"])
        if kept.faults:
            layout.operator("wovenfit.select_faults", icon="RESTRICT_SELECT_OFF")


class WOVENFIT_PT_girths(_Panel, bpy.types.Panel):
    bl_label = "Girths"
    bl_parent_id = "WOVENFIT_PT_surface"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        limb = limb_of(context)
        return limb is not None and limb.wovenfit.check != ""

    def draw(self, context):
        found = read(limb_of(context).wovenfit.check)
        grid = self.layout.column(align=True)
        if found.get("length_mm"):
            grid.label(text=f"{millimetres(found['length_mm'])} along the limb")
        for length in found["openings"]:
            grid.label(text=f"Opening, {millimetres(length)} round")
        for at, girth in found["girths"]:
            row = grid.row()
            row.label(text=f"at {at:.0f} mm")
            row.label(text=millimetres(girth))
        if found["more_girths"]:
            grid.label(text=f"and {found['more_girths']} more")


class WOVENFIT_UL_pressures(bpy.types.UIList):
    """Wanted pressures."""

    def draw_item(self, context, layout, data, item, icon, active_data, active_propname, index=0):
        del icon, active_data, active_propname
        row = layout.split(factor=0.25)
        row.label(text=f"{index + 1}")
        name = "mmhg" if pressure_unit(context) == MMHG else "kpa"
        row.prop(item, name, text="", emboss=False)
        del data


class WOVENFIT_PT_pressures(_Panel, bpy.types.Panel):
    bl_label = "Pressures"
    bl_order = 1

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, kept = self.layout, limb.wovenfit
        layout.row().prop(kept, "source", expand=True)
        if kept.source == PAINTED:
            row = layout.row(align=True)
            row.prop_search(kept, "group", limb, "vertex_groups", text="")
            row.operator("wovenfit.paint", icon="BRUSH_DATA")
            kpa_or_mmhg(layout, context, kept, "most_kpa", "At weight 1")
            return
        layout.label(text=f"Wanted, in {pressure_unit(context)}")
        row = layout.row()
        row.template_list(
            "WOVENFIT_UL_pressures", "", kept, "pressures", kept, "active_pressure", rows=4
        )
        side = row.column(align=True)
        side.operator("wovenfit.add_pressure", text="", icon="ADD")
        side.operator("wovenfit.remove_pressure", text="", icon="REMOVE")
        if kept.pressures:
            row = layout.row(align=True)
            row.operator("wovenfit.select_pressure")
            row.operator("wovenfit.move_pressure")
        elif limb.mode != "EDIT":
            paragraph(layout, context, "In edit mode select a vertex, then press +.", "INFO")


class WOVENFIT_PT_fabric(_Panel, bpy.types.Panel):
    bl_label = "Fabric"
    bl_order = 2

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, group = self.layout, limb.wovenfit.design
        row = layout.row(align=True)
        row.menu("WOVENFIT_MT_fabrics", text="Presets")
        row.operator("wovenfit.keep_fabric", text="", icon="ADD")
        row.operator("wovenfit.keep_fabric", text="", icon="REMOVE").remove_active = True
        column = layout.column(align=True)
        for field in fabric_fields():
            field_row(column, context, group, field)


class WOVENFIT_PT_seams(_Panel, bpy.types.Panel):
    bl_label = "Seams and Orientation"
    bl_order = 3

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, kept = self.layout, limb.wovenfit
        paragraph(
            layout,
            context,
            "Seams are the edges marked as seam. On a tube without any the shortest way is taken "
            "and then marked.",
            "INFO",
        )
        if limb.mode == "EDIT":
            row = layout.row(align=True)
            row.operator("mesh.mark_seam", text="Mark Seam").clear = False
            row.operator("mesh.mark_seam", text="Clear Seam").clear = True
        layout.separator()
        layout.prop(kept, "oriented", text="Orientation by two vertices")
        row = layout.row(align=True)
        row.operator("wovenfit.set_orientation")
        row.operator("wovenfit.swap_orientation", text="", icon="FILE_REFRESH")
        layout.separator()
        layout.prop(kept, "only_selected")


class WOVENFIT_PT_flatten(_Panel, bpy.types.Panel):
    bl_label = "Flatten"
    bl_order = 4

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, kept = self.layout, limb.wovenfit
        if job.running is not None:
            _progress(layout, context, job.running)
            return
        column = layout.column(align=True)
        row = column.row(align=True)
        row.scale_y = 1.4
        row.operator("wovenfit.flatten", icon="MOD_CLOTH")
        row.operator("wovenfit.update", icon="FILE_REFRESH")
        if kept.error:
            paragraph(layout, context, kept.error, "CANCEL", alert=True)
            if kept.faults:
                layout.operator("wovenfit.select_faults", icon="RESTRICT_SELECT_OFF")


def _progress(layout, context, running):
    if hasattr(layout, "progress"):
        layout.progress(factor=running.share, text=f"{running.stage} {100 * running.share:.0f} %")
    else:
        # Blender before 4.0 has no bar but that of a slider.
        row = layout.row()
        row.enabled = False
        row.prop(context.window_manager, "wovenfit_progress", text=running.stage, slider=True)
    layout.operator("wovenfit.cancel", text="Cancel (Esc)", icon="X")


class WOVENFIT_PT_wishes(_Panel, bpy.types.Panel):
    bl_label = "Piece and Limits"
    bl_parent_id = "WOVENFIT_PT_flatten"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        column = self.layout.column(align=True)
        for field in design_fields():
            if field.section != "fabric":
                field_row(column, context, limb.wovenfit.design, field)


class WOVENFIT_PT_settings(_Panel, bpy.types.Panel):
    bl_label = "Settings"
    bl_parent_id = "WOVENFIT_PT_flatten"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        column = self.layout.column(align=True)
        for field in parameter_fields():
            field_row(column, context, limb.wovenfit.settings, field)


class WOVENFIT_PT_result(_Panel, bpy.types.Panel):
    bl_label = "Result"
    bl_order = 5

    def draw(self, context):
        limb = self.limb(context)
        if limb is None:
            return
        layout, kept = self.layout, limb.wovenfit
        if not kept.result:
            layout.label(text="No pattern yet", icon="INFO")
            return
        found = read(kept.result)
        if kept.stale:
            paragraph(
                layout,
                context,
                "The wishes were changed since: press Update.",
                "FILE_REFRESH",
                True,
            )
        if not found["converged"]:
            paragraph(layout, context, "The fit has not converged.", "ERROR", True)
        notes(layout, context, kept, found["warnings"])
        layout.label(
            text=f"{found['width_mm']:.1f} × {found['height_mm']:.1f} mm, "
            f"{found['area_mm2'] / 100:.0f} cm²"
        )
        for number, (left, right) in enumerate(found["seams"], 1):
            layout.label(text=f"Seam {number}: {left:.1f} and {right:.1f} mm")
        _table(layout, context, found["pressures"])
        row = layout.row(align=True)
        row.prop(kept, "shown", text="")
        row.operator("wovenfit.show_colours", text="Colours", icon="COLOR")
        layout.operator("wovenfit.open_report", icon="URL")


def _table(layout, context, rows):
    """Wanted and computed, with the reason under a row that is missed."""
    if not rows:
        return
    unit = pressure_unit(context)
    layout.label(text=f"Pressures in {unit}")
    box = layout.box().column(align=True)

    def line(number, icon, wanted, computed):
        row = box.split(factor=0.24)
        row.label(text=number, icon=icon)
        row = row.split(factor=0.46)
        row.label(text=wanted)
        row.label(text=computed)
        return row

    line("#", "NONE", "wanted", "computed")
    missed = sum(not one["met"] for one in rows)
    for number, one in enumerate(rows, 1):
        values = (pressure(one[key], unit).partition(" ")[0] for key in ("asked_kpa", "got_kpa"))
        line(str(number), "CHECKMARK" if one["met"] else "CANCEL", *values)
        if one["reason"]:
            paragraph(box, context, one["reason"], "BLANK1", alert=True)
    layout.label(
        text=f"{len(rows) - missed} of {len(rows)} reached",
        icon="CANCEL" if missed else "CHECKMARK",
    )
    layout.label(text="Computed, not measured", icon="INFO")


class WOVENFIT_PT_export(_Panel, bpy.types.Panel):
    bl_label = "Export"
    bl_order = 6

    def draw(self, context):
        if self.limb(context) is None:
            return
        layout = self.layout
        # In the file dialog a default would come before what the operator sets.
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("wovenfit.export_all", icon="EXPORT")
        layout.operator_menu_enum(
            "wovenfit.export_file", "file", text="Export One File", icon="FILE"
        )


class WOVENFIT_MT_object(bpy.types.Menu):
    bl_label = "WovenFit"

    def draw(self, context):
        del context
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("wovenfit.check")
        layout.operator("wovenfit.add_pressure")
        layout.operator("wovenfit.paint")
        layout.operator("wovenfit.set_orientation")
        layout.separator()
        layout.operator("wovenfit.flatten")
        layout.operator("wovenfit.update")
        layout.separator()
        layout.operator("wovenfit.open_report")
        layout.operator("wovenfit.export_all")
        layout.operator_menu_enum("wovenfit.export_file", "file", text="Export File")


def _in_object_menu(self, context):
    del context
    self.layout.separator()
    self.layout.menu("WOVENFIT_MT_object")


CLASSES = (
    WOVENFIT_UL_pressures,
    WOVENFIT_PT_surface,
    WOVENFIT_PT_girths,
    WOVENFIT_PT_pressures,
    WOVENFIT_PT_fabric,
    WOVENFIT_PT_seams,
    WOVENFIT_PT_flatten,
    WOVENFIT_PT_wishes,
    WOVENFIT_PT_settings,
    WOVENFIT_PT_result,
    WOVENFIT_PT_export,
    WOVENFIT_MT_object,
)


def register():
    bpy.types.VIEW3D_MT_object.append(_in_object_menu)
    bpy.types.WindowManager.wovenfit_progress = bpy.props.FloatProperty(
        name="Progress",
        description="How much of the pattern is done",
        subtype="PERCENTAGE",
        min=0.0,
        max=100.0,
        precision=0,
        get=lambda self: 0.0 if job.running is None else 100.0 * job.running.share,
    )


def unregister():
    del bpy.types.WindowManager.wovenfit_progress
    bpy.types.VIEW3D_MT_object.remove(_in_object_menu)
