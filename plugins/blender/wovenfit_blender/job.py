"""The one job that may run: begun, polled, cancelled, and its outcome put into the file.

The solver has threads of its own; everything here runs on Blender's. Between beginning and end the
file may change in any way, so the limb is remembered by its name.
"""

import json
from dataclasses import dataclass, field

import bpy

from . import limb as limbs
from . import result
from .plain.record import of_check, written
from .plain.solve import Memory, Solving
from .plain.wording import in_host_words
from .wishes import design_of, fields_of, parameters_of
from .wovenfit import Cancelled, Check, SurfaceError, UnitError, WovenfitError

memory = Memory()
running = None
"""The `Running` job, or None."""


@dataclass
class Running:
    """A job and what its outcome needs."""

    limb: str
    surface: object
    solving: Solving
    remarks: list = field(default_factory=list)
    share: float = 0.0
    stage: str = "Starting"

    def poll(self, seconds=0.0):
        """Waits at most so long; whether it has ended."""
        ended = self.solving.wait(seconds)
        self.share, self.stage = (1.0, "Done") if ended else self.solving.progress()
        return ended


class Refused(Exception):
    """Nothing was found; the text is for the designer."""


def begin(limb, context, warm):
    """Starts a job on a limb; `warm` goes on from its last pattern, if the surface is the same.

    Raises:
        Refused: if it cannot start; the limb then says why.
    """
    global running
    if running is not None:
        raise Refused("a pattern is being made already: wait for it, or press Esc")
    surface = None
    try:
        with limbs.object_mode(limb):
            surface = limbs.read(limb, context)
            mesh = surface.mesh()
            design, remarks = design_of(limb, surface, mesh, context)
        print_ = surface.fingerprint
        earlier = None
        if warm:
            earlier = memory.find(limb.wovenfit.solved)
            if earlier is None or earlier.surface != print_:
                earlier = memory.on(print_)
        solving = Solving(mesh, print_, design, parameters_of(limb), earlier)
    except WovenfitError as error:
        raise _refused(limb, surface, error) from error
    limb.wovenfit.error = limb.wovenfit.faults = ""
    running = Running(limb.name, surface, solving, remarks)


def finish(context):
    """Puts the outcome of the job that has ended into the file; the limb and what was solved.

    Raises:
        Refused: if it found nothing.
    """
    global running
    ended, running = running, None
    limb = context.scene.objects.get(ended.limb)
    try:
        solved = ended.solving.outcome()
    except Cancelled as error:
        raise Refused("cancelled: nothing was changed") from error
    except WovenfitError as error:
        if limb is None:
            raise Refused(in_host_words(str(error))) from error
        raise _refused(limb, ended.surface, error) from error
    finally:
        ended.solving.close()
    if limb is None:
        raise Refused(f"the limb {ended.limb!r} is gone since Flatten was pressed")
    with limbs.object_mode(limb):
        surface = ended.surface
        if surface.own and len(limb.data.loops) != len(surface.corner_vertices):
            raise Refused(f"the mesh of {limb.name!r} was changed meanwhile: press Flatten again")
        result.write(limb, surface, solved, ended.remarks, context)
    memory.keep(solved)
    return limb, solved


def drop():
    """Stops what runs and waits for it: the file or the add-on goes."""
    global running
    if running is not None:
        running.solving.close()
        running = None


def check(limb, context):
    """Looks at the limb's surface; what is found is kept with it. Whether it is sound.

    Raises:
        Refused: if it cannot be looked at.
    """
    kept = limb.wovenfit
    surface = None
    try:
        with limbs.object_mode(limb):
            surface = limbs.read(limb, context)
        # Of the design the facing bears on the check.
        design = fields_of(limb, surface)
        with surface.mesh() as mesh, Check(mesh, design, parameters_of(limb)) as found:
            kept.check = written(of_check(found))
            kept.error = ""
            kept.faults = _faults(surface, found.defects)
            return found.sound
    except WovenfitError as error:
        raise _refused(limb, surface, error) from error


def _refused(limb, surface, error):
    """Why nothing was found, kept with the limb together with the faulty elements."""
    text = in_host_words(str(error))
    if isinstance(error, UnitError) and surface is not None:
        text = text.rstrip(".") + (
            f". One unit of {limb.name!r} is taken as {surface.unit:g} mm: see Units in the panel "
            "Surface, the scene's unit scale and the object's scale."
        )
    limb.wovenfit.error = text
    defects = error.defects if isinstance(error, SurfaceError) else ()
    limb.wovenfit.faults = _faults(surface, defects) if surface is not None else ""
    return Refused(text)


def _faults(surface, defects):
    vertices = [vertex for defect in defects for vertex in defect.vertices]
    triangles = [triangle for defect in defects for triangle in defect.triangles]
    vertices, polygons = result.faulty(surface, vertices, triangles)
    return json.dumps({"vertices": vertices, "polygons": polygons}) if vertices or polygons else ""


def redraw():
    """Draws all 3D views anew."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
