"""The operators that say what is wanted where: pressures at vertices, paint, orientation."""

import bmesh
import bpy
import numpy as np

from .limb import object_mode
from .marks import find, mark, points_of, renew
from .properties import PAINTED, PINNED, changed, limb_of

GROUP = "brace pressure"
"""The vertex group that Paint makes."""


def selected_vertices(limb):
    """The selected vertices, in the order in which they were selected where Blender knows it."""
    if limb.mode == "EDIT":
        edited = bmesh.from_edit_mesh(limb.data)
        chosen = [one.index for one in edited.verts if one.select]
        history = [
            one.index
            for one in edited.select_history
            if isinstance(one, bmesh.types.BMVert) and one.select
        ]
        return history + [index for index in chosen if index not in set(history)]
    flags = np.empty(len(limb.data.vertices), bool)
    limb.data.vertices.foreach_get("select", flags)
    return [int(index) for index in np.flatnonzero(flags)]


def _edited_limb(cls, context):
    limb = limb_of(context)
    if limb is None or limb is not context.object:
        cls.poll_message_set("Select the limb: a mesh object")
        return False
    return True


class WOVENFIT_OT_add_pressure(bpy.types.Operator):
    """Ask for a pressure at each selected vertex (edit mode). Type its value in the list"""

    bl_idname = "wovenfit.add_pressure"
    bl_label = "Add Pressure"
    bl_options = {"REGISTER", "UNDO"}

    kpa: bpy.props.FloatProperty(
        name="kPa",
        description="Wanted pressure in kPa; 0 for that of the last in the list",
        min=0.0,
    )

    MOST = 50
    """More selected vertices are taken for a slip of the hand: there is Paint for them."""

    @classmethod
    def poll(cls, context):
        return _edited_limb(cls, context)

    def execute(self, context):
        limb = limb_of(context)
        chosen = selected_vertices(limb)
        if not chosen:
            self.report({"ERROR"}, "No vertex is selected: select one in edit mode, then Add")
            return {"CANCELLED"}
        if len(chosen) > self.MOST:
            self.report(
                {"ERROR"},
                f"{len(chosen)} vertices are selected, over {self.MOST}: select single ones, or "
                "paint the pressure",
            )
            return {"CANCELLED"}
        kept = limb.wovenfit
        with object_mode(limb):
            points = points_of(limb.data)
            there = {find(one.mark, points).vertex for one in kept.pressures}
            for vertex in chosen:
                if vertex in there:
                    self.report({"WARNING"}, f"Vertex {vertex} has a pressure already")
                    continue
                last = kept.pressures[-1].kpa if kept.pressures else None
                one = kept.pressures.add()
                mark(one.mark, limb.data, vertex)
                if self.kpa or last is not None:
                    one.kpa = self.kpa or last
        kept.source = PINNED
        kept.active_pressure = len(kept.pressures) - 1
        changed(kept, context)
        return {"FINISHED"}


class WOVENFIT_OT_remove_pressure(bpy.types.Operator):
    """Take the chosen pressure out of the list"""

    bl_idname = "wovenfit.remove_pressure"
    bl_label = "Remove Pressure"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        limb = limb_of(context)
        return limb is not None and len(limb.wovenfit.pressures) > 0

    def execute(self, context):
        kept = limb_of(context).wovenfit
        kept.pressures.remove(min(kept.active_pressure, len(kept.pressures) - 1))
        kept.active_pressure = max(0, min(kept.active_pressure, len(kept.pressures) - 1))
        changed(kept, context)
        return {"FINISHED"}


class WOVENFIT_OT_move_pressure(bpy.types.Operator):
    """Move the chosen pressure to the selected vertex (edit mode)"""

    bl_idname = "wovenfit.move_pressure"
    bl_label = "Move to Vertex"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return _edited_limb(cls, context) and len(limb_of(context).wovenfit.pressures) > 0

    def execute(self, context):
        limb = limb_of(context)
        chosen = selected_vertices(limb)
        if len(chosen) != 1:
            self.report({"ERROR"}, f"{len(chosen)} vertices are selected: select one in edit mode")
            return {"CANCELLED"}
        kept = limb.wovenfit
        with object_mode(limb):
            mark(kept.pressures[kept.active_pressure].mark, limb.data, chosen[0])
        changed(kept, context)
        return {"FINISHED"}


class WOVENFIT_OT_select_pressure(bpy.types.Operator):
    """Select the vertex of the chosen pressure in edit mode"""

    bl_idname = "wovenfit.select_pressure"
    bl_label = "Select Vertex"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return WOVENFIT_OT_move_pressure.poll(context)

    def execute(self, context):
        limb = limb_of(context)
        kept = limb.wovenfit
        with object_mode(limb):
            points = points_of(limb.data)
            one = kept.pressures[kept.active_pressure].mark
            found = find(one, points)
            renew(one, found, points)
        if found.vertex < 0:
            self.report(
                {"ERROR"}, "Its vertex is gone since the mesh was edited: Move it to another"
            )
            return {"CANCELLED"}
        select(limb, [found.vertex], [])
        return {"FINISHED"}


class WOVENFIT_OT_paint(bpy.types.Operator):
    """Paint where the brace is to press: weights times the highest pressure"""

    bl_idname = "wovenfit.paint"
    bl_label = "Paint"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return _edited_limb(cls, context)

    def execute(self, context):
        limb = limb_of(context)
        kept = limb.wovenfit
        if kept.group not in limb.vertex_groups:
            kept.group = (limb.vertex_groups.get(GROUP) or limb.vertex_groups.new(name=GROUP)).name
        limb.vertex_groups.active_index = limb.vertex_groups[kept.group].index
        kept.source = PAINTED
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
        return {"FINISHED"}


class WOVENFIT_OT_set_orientation(bpy.types.Operator):
    """Two selected vertices stand above each other in the pattern, the first near the body"""

    bl_idname = "wovenfit.set_orientation"
    bl_label = "Set from Two Vertices"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return _edited_limb(cls, context)

    def execute(self, context):
        limb = limb_of(context)
        chosen = selected_vertices(limb)
        if len(chosen) != 2:
            self.report(
                {"ERROR"}, f"{len(chosen)} vertices are selected: select two in edit mode, then Set"
            )
            return {"CANCELLED"}
        kept = limb.wovenfit
        with object_mode(limb):
            mark(kept.first, limb.data, chosen[0])
            mark(kept.second, limb.data, chosen[1])
        kept.oriented = True
        return {"FINISHED"}


class WOVENFIT_OT_swap_orientation(bpy.types.Operator):
    """Take the other vertex for the one near the body"""

    bl_idname = "wovenfit.swap_orientation"
    bl_label = "Swap"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        limb = limb_of(context)
        return limb is not None and limb.wovenfit.oriented

    def execute(self, context):
        kept = limb_of(context).wovenfit
        for name in ("vertex", "place", "vertices"):
            one, other = getattr(kept.first, name), getattr(kept.second, name)
            if name == "place":
                one, other = one[:], other[:]
            setattr(kept.first, name, other)
            setattr(kept.second, name, one)
        changed(kept, context)
        return {"FINISHED"}


class WOVENFIT_OT_select_faults(bpy.types.Operator):
    """Select the faulty vertices and faces in edit mode"""

    bl_idname = "wovenfit.select_faults"
    bl_label = "Select Faulty Elements"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        limb = limb_of(context)
        return limb is not None and limb.wovenfit.faults != ""

    def execute(self, context):
        from .plain.record import read

        limb = limb_of(context)
        faults = read(limb.wovenfit.faults)
        with object_mode(limb):
            if max(faults["vertices"], default=-1) >= len(limb.data.vertices) or max(
                faults["polygons"], default=-1
            ) >= len(limb.data.polygons):
                self.report({"ERROR"}, "The mesh was edited since: press Check Surface again")
                return {"CANCELLED"}
        context.view_layer.objects.active = limb
        select(limb, faults["vertices"], faults["polygons"])
        return {"FINISHED"}


def select(limb, vertices, polygons):
    """Selects vertices and polygons and nothing else, in edit mode, and shows them in it."""
    if limb.mode != "EDIT":
        bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    edited = bmesh.from_edit_mesh(limb.data)
    edited.verts.ensure_lookup_table()
    edited.faces.ensure_lookup_table()
    for element in (*edited.verts, *edited.edges, *edited.faces):
        element.select = False
    edited.select_history.clear()
    for index in vertices:
        edited.verts[index].hide = False
        edited.verts[index].select = True
    for index in polygons:
        edited.faces[index].hide_set(False)
        edited.faces[index].select_set(True)
    if len(vertices) == 1:
        edited.select_history.add(edited.verts[vertices[0]])
    bmesh.update_edit_mesh(limb.data)


CLASSES = (
    WOVENFIT_OT_add_pressure,
    WOVENFIT_OT_remove_pressure,
    WOVENFIT_OT_move_pressure,
    WOVENFIT_OT_select_pressure,
    WOVENFIT_OT_paint,
    WOVENFIT_OT_set_orientation,
    WOVENFIT_OT_swap_orientation,
    WOVENFIT_OT_select_faults,
)
