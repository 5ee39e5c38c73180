"""What is drawn into 3D views: pressures with their values, orientation, pattern lines, scale."""

import math
from functools import lru_cache

import blf
import bpy
import gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from .limb import got
from .plain.colours import RAMP
from .plain.record import read
from .plain.wording import percent, pressure
from .preferences import preferences, pressure_unit
from .properties import PAINTED, PRESSURE, SHOWN, limb_of
from .result import OUTLINE, SEAM

WANTED = (1.0, 0.75, 0.1, 1.0)
MISSED = (1.0, 0.25, 0.2, 1.0)
BEHIND = 0.3
"""Opacity of what lies on the far side of the limb."""
MARKER = (0.3, 0.8, 1.0, 1.0)
CUT = (0.02, 0.02, 0.02, 1.0)
SEWN = (0.95, 0.25, 0.15, 1.0)
TEXT = (1.0, 1.0, 1.0, 1.0)
_FONT = 0
_handles = []


def _shader(name):
    """A built-in shader: before Blender 3.5 those of 3D space had a prefix."""
    try:
        return gpu.shader.from_builtin(name)
    except ValueError:
        return gpu.shader.from_builtin(f"3D_{name}")


def _scale():
    return bpy.context.preferences.system.ui_scale


def _lines(coordinates, colour, width):
    """Line segments, two points each, in the present matrix."""
    if not len(coordinates):
        return
    shader = _shader("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINES", {"pos": coordinates})
    shader.bind()
    viewport = gpu.state.viewport_get()
    shader.uniform_float("viewportSize", (viewport[2], viewport[3]))
    shader.uniform_float("lineWidth", width * _scale())
    shader.uniform_float("color", colour)
    batch.draw(shader)


def _disc(at, radius, colour):
    """A disc on the screen, with a dark rim."""
    shader = _shader("UNIFORM_COLOR")
    shader.bind()
    steps = 20
    circle = [
        (math.cos(2 * math.pi * k / steps), math.sin(2 * math.pi * k / steps)) for k in range(steps)
    ]
    for size, fill in ((radius + 1.5, (0.0, 0.0, 0.0, colour[3])), (radius, colour)):
        size *= _scale()
        corners = []
        for k in range(steps):
            (a, b), (c, d) = circle[k], circle[(k + 1) % steps]
            corners += [
                (at[0], at[1], 0.0),
                (at[0] + size * a, at[1] + size * b, 0.0),
                (at[0] + size * c, at[1] + size * d, 0.0),
            ]
        shader.uniform_float("color", fill)
        batch_for_shader(shader, "TRIS", {"pos": corners}).draw(shader)


def _text(text, at, size=12, colour=TEXT, centred=False):
    """A text on the screen, on a shade that keeps it readable."""
    blf.size(_FONT, int(size * _scale())) if bpy.app.version >= (4, 0) else blf.size(
        _FONT, int(size * _scale()), 72
    )
    width, height = blf.dimensions(_FONT, text)
    x = at[0] - width / 2 if centred else at[0]
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 5, 0.0, 0.0, 0.0, colour[3])
    blf.color(_FONT, *colour)
    blf.position(_FONT, x, at[1] - height / 2, 0)
    blf.draw(_FONT, text)
    blf.disable(_FONT, blf.SHADOW)


def _wanted(context):
    found = preferences(context)
    limb = limb_of(context)
    if limb is None or (found is not None and not found.overlay):
        return None
    return limb if limb.visible_get() else None


def _place(limb, mark):
    """Where a mark is drawn, in the limb's coordinates, and the normal there, if known."""
    mesh = limb.data
    if 0 <= mark.vertex < len(mesh.vertices) and mark.vertices == len(mesh.vertices):
        vertex = mesh.vertices[mark.vertex]
        return vertex.co, vertex.normal
    return Vector(mark.place), None


def _on_screen(context, limb, mark):
    """(x, y) of a mark in the view, and whether it faces it; None if it is out of the view."""
    place, normal = _place(limb, mark)
    at = limb.matrix_world @ place
    screen = location_3d_to_region_2d(context.region, context.region_data, at)
    if screen is None:
        return None
    facing = True
    if normal is not None:
        view = context.region_data
        towards = view.view_matrix.inverted().translation - at
        if not view.is_perspective:
            towards = view.view_matrix.inverted().to_3x3() @ Vector((0.0, 0.0, 1.0))
        facing = (limb.matrix_world.to_3x3() @ normal).dot(towards) > 0.0
    return screen, facing


def draw_flat():
    """Over the 3D view, in pixels."""
    context = bpy.context
    limb = _wanted(context)
    if limb is None:
        return
    gpu.state.blend_set("ALPHA")
    kept = limb.wovenfit
    if kept.source != PAINTED:
        _pressures(context, limb)
    if kept.oriented:
        _orientation(context, limb)
    flat = kept.flat
    if kept.result and flat is not None and flat.name in context.view_layer.objects:
        found = read(kept.result)
        if flat.visible_get():
            _pattern_labels(context, flat, found)
        shading = context.space_data.shading
        if shading.type == "SOLID" and shading.color_type == "VERTEX":
            _legend(context, kept)
    gpu.state.blend_set("NONE")


def _pressures(context, limb):
    kept = limb.wovenfit
    unit = pressure_unit(context)
    rows = read(kept.result)["pressures"] if kept.result and not kept.stale else []
    for index, one in enumerate(kept.pressures):
        seen = _on_screen(context, limb, one.mark)
        if seen is None:
            continue
        at, facing = seen
        missed = len(rows) == len(kept.pressures) and not rows[index]["met"]
        opacity = 1.0 if facing else BEHIND
        colour = (*(MISSED if missed else WANTED)[:3], opacity)
        chosen = index == kept.active_pressure
        _disc(at, 6.0 if chosen else 4.5, colour)
        _text(
            f"{index + 1}: {pressure(one.kpa, unit)}",
            (at[0] + 11 * _scale(), at[1]),
            colour=(1.0, 1.0, 1.0, opacity),
        )


def _orientation(context, limb):
    kept = limb.wovenfit
    seen = [_on_screen(context, limb, one) for one in (kept.first, kept.second)]
    for text, one in zip(("body", "weft"), seen):
        if one is not None:
            at, facing = one
            opacity = 1.0 if facing else BEHIND
            _disc(at, 4.0, (*MARKER[:3], opacity))
            _text(text, (at[0] + 10 * _scale(), at[1]), 11, (*MARKER[:3], opacity))


def _pattern_labels(context, flat, found):
    """The seams' numbers on both of their sides, and which way the threads run."""
    unit = found["unit_mm"]

    def screen(x, y):
        at = flat.matrix_world @ Vector((x / unit, y / unit, 0.0))
        return location_3d_to_region_2d(context.region, context.region_data, at)

    for number, middles in enumerate(found["seam_middles"], 1):
        for x, y in middles:
            at = screen(x, y)
            if at is not None:
                _text(f"seam {number}", at, 11, (1.0, 0.6, 0.5, 1.0), centred=True)
    x, y = found["width_mm"] / 2, found["height_mm"] / 2
    at = screen(x, y + 0.14 * found["height_mm"])
    if at is not None:
        _text("weft", at, 11, MARKER, centred=True)


def _legend(context, kept):
    """The colours' scale at the lower left."""
    scale = _scale()
    x, y, width, height = 60 * scale, 40 * scale, 200 * scale, 12 * scale
    shader = _shader("SMOOTH_COLOR")
    corners, colours = [], []
    steps = len(RAMP) - 1
    for k in range(steps):
        a, b = x + width * k / steps, x + width * (k + 1) / steps
        one, other = (*RAMP[k], 1.0), (*RAMP[k + 1], 1.0)
        corners += [(a, y, 0), (b, y, 0), (b, y + height, 0), (a, y, 0), (b, y + height, 0)]
        corners.append((a, y + height, 0))
        colours += [one, other, other, one, other, one]
    shader.bind()
    batch_for_shader(shader, "TRIS", {"pos": corners, "color": colours}).draw(shader)
    name = next(label for key, label, _ in SHOWN if key == kept.shown)
    if kept.shown == PRESSURE:
        unit = pressure_unit(context)
        ends = [pressure(value, unit) for value in (kept.scale_least, kept.scale_most)]
    else:
        ends = [percent(value) for value in (kept.scale_least, kept.scale_most)]
    _text(name, (x, y + height + 12 * scale))
    _text(ends[0], (x, y - 12 * scale), 11)
    _text(ends[1], (x + width, y - 12 * scale), 11, centred=True)


@lru_cache(maxsize=4)
def _pattern_lines(name, solved):
    """Segments of outline and seams of a pattern, in its object's coordinates."""
    del solved  # tells one content of the mesh from the next
    mesh = bpy.data.objects[name].data
    places = got(mesh.vertices, "co", np.float32, 3)
    ends = places[got(mesh.edges, "vertices", np.int32, 2)]
    sewn = got(mesh.attributes[SEAM].data, "value", np.int32) > 0
    cut = got(mesh.attributes[OUTLINE].data, "value", bool) & ~sewn
    return ends[cut].reshape(-1, 3), ends[sewn].reshape(-1, 3)


def _arrow(found):
    """Segments of an arrow along weft in the middle of the pattern."""
    unit = found["unit_mm"]
    x, y, half = found["width_mm"] / 2, found["height_mm"] / 2, 0.1 * found["height_mm"]
    points = [(x, y - half), (x, y + half), (x, y + half), (x - half / 4, y + 0.7 * half)]
    points += [(x, y + half), (x + half / 4, y + 0.7 * half)]
    return [(a / unit, b / unit, 0.0) for a, b in points]


def draw_deep():
    """In the 3D view, where depth hides."""
    context = bpy.context
    limb = _wanted(context)
    if limb is None:
        return
    kept = limb.wovenfit
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    if kept.oriented:
        world = limb.matrix_world
        ends = [world @ _place(limb, one)[0] for one in (kept.first, kept.second)]
        _lines(ends, MARKER, 2.0)
    flat = kept.flat
    if (
        kept.result
        and flat is not None
        and flat.name in context.view_layer.objects
        and flat.visible_get()
        and flat.mode == "OBJECT"
        and OUTLINE in flat.data.attributes
    ):
        cut, sewn = _pattern_lines(flat.name, kept.solved)
        with gpu.matrix.push_pop():
            gpu.matrix.multiply_matrix(flat.matrix_world)
            _lines(cut, CUT, 2.5)
            _lines(sewn, SEWN, 3.0)
            _lines(_arrow(read(kept.result)), MARKER, 2.0)
    gpu.state.blend_set("NONE")
    gpu.state.depth_test_set("NONE")


def register():
    if bpy.app.background:
        return
    add = bpy.types.SpaceView3D.draw_handler_add
    _handles.append(add(draw_deep, (), "WINDOW", "POST_VIEW"))
    _handles.append(add(draw_flat, (), "WINDOW", "POST_PIXEL"))


def unregister():
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    _pattern_lines.cache_clear()
