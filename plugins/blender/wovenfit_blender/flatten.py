"""The operators that make a pattern: Check, Flatten, Update and Cancel."""

import bpy

from . import job
from .properties import limb_of

_TICK = 0.05
"""Seconds between two looks at the job."""


def _limb_there(cls, context):
    if limb_of(context) is None:
        cls.poll_message_set("Select the limb: a mesh object")
        return False
    return True


class WOVENFIT_OT_check(bpy.types.Operator):
    """Look at the surface: shape, unit, girths, and everything that stands in a pattern's way"""

    bl_idname = "wovenfit.check"
    bl_label = "Check Surface"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return _limb_there(cls, context)

    def execute(self, context):
        limb = limb_of(context)
        try:
            sound = job.check(limb, context)
        except job.Refused as refused:
            self.report({"ERROR"}, str(refused))
            return {"CANCELLED"}
        if sound:
            self.report({"INFO"}, f"{limb.name} can be flattened")
        else:
            self.report({"WARNING"}, f"{limb.name} has defects: see the panel Surface")
        return {"FINISHED"}


class _Solves:
    """What Flatten and Update share: the way through a job while the window stays alive."""

    bl_options = {"UNDO"}
    warm = False

    def invoke(self, context, event):
        del event
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if not self._begin(context):
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TICK, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        context.workspace.status_text_set("WovenFit: making the pattern   |   Esc: cancel")
        job.redraw()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if job.running is None:
            # The file was closed or the add-on left.
            self._leave(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            job.running.solving.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        ended = job.running.poll()
        context.window_manager.progress_update(100 * job.running.share)
        job.redraw()
        if not ended:
            return {"PASS_THROUGH"}
        self._leave(context)
        return self._finish(context)

    def cancel(self, context):
        """Blender ends the operator, as when the file is closed."""
        job.drop()
        self._leave(context)

    def execute(self, context):
        """Without a window, or from a script: returns when the pattern is there."""
        if not self._begin(context):
            return {"CANCELLED"}
        while not job.running.poll(_TICK):
            pass
        return self._finish(context)

    def _begin(self, context):
        try:
            job.begin(limb_of(context), context, self.warm)
        except job.Refused as refused:
            self.report({"ERROR"}, str(refused))
            return False
        return True

    def _finish(self, context):
        cancelled = job.running.solving.cancelled
        try:
            limb, solved = job.finish(context)
        except job.Refused as refused:
            self.report({"WARNING" if cancelled else "ERROR"}, str(refused))
            job.redraw()
            return {"CANCELLED"}
        figures = solved.pattern.figures
        said = f"{limb.wovenfit.flat.name}: {figures.width_mm:.1f} mm by {figures.height_mm:.1f} mm"
        warnings = len(solved.pattern.warnings)
        if warnings:
            said += f", {warnings} warning{'s' if warnings > 1 else ''}: see the panel Result"
        self.report({"WARNING" if warnings else "INFO"}, said)
        job.redraw()
        return {"FINISHED"}

    def _leave(self, context):
        if getattr(self, "_timer", None) is None:
            return
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        self._timer = None


def _idle(cls, context):
    if not _limb_there(cls, context):
        return False
    if job.running is not None:
        cls.poll_message_set("A pattern is being made: wait for it, or press Esc")
        return False
    return True


class WOVENFIT_OT_flatten(_Solves, bpy.types.Operator):
    """Make the flat pattern of a brace on this limb. Esc cancels"""

    bl_idname = "wovenfit.flatten"
    bl_label = "Flatten"

    @classmethod
    def poll(cls, context):
        return _idle(cls, context)


class WOVENFIT_OT_update(_Solves, bpy.types.Operator):
    """Solve again after a change."""

    bl_idname = "wovenfit.update"
    bl_label = "Update"
    bl_description = (
        "Solve again after a change, going on from the last pattern: a part of the time. Flatten "
        "begins anew; the two agree within the solver's tolerance"
    )
    warm = True

    @classmethod
    def poll(cls, context):
        if not _idle(cls, context):
            return False
        if not limb_of(context).wovenfit.result:
            cls.poll_message_set("There is no pattern yet: press Flatten")
            return False
        return True


class WOVENFIT_OT_cancel(bpy.types.Operator):
    """Stop making the pattern; nothing is changed"""

    bl_idname = "wovenfit.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        del cls, context
        return job.running is not None

    def execute(self, context):
        del context
        job.running.solving.cancel()
        return {"FINISHED"}


CLASSES = (WOVENFIT_OT_check, WOVENFIT_OT_flatten, WOVENFIT_OT_update, WOVENFIT_OT_cancel)


def unregister():
    job.drop()
    job.memory.clear()
