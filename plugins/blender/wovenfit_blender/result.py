"""The result out: a flat mesh beside the limb, and a UV map, attributes and colours on both."""

import bpy
import numpy as np

from .limb import AUTO_SEAM, got
from .plain import colours
from .plain.record import of_pattern, written
from .properties import PRESSURE, WARP, WEFT
from .wovenfit import NONE, polygon_corners, torn_edges

UV = "wovenfit"
"""The UV map on the limb: 1 UV unit is 1 m of fabric."""
MM_PER_UV = 1000.0
VALUES = {
    WARP: "wovenfit_warp_strain",
    WEFT: "wovenfit_weft_strain",
    PRESSURE: "wovenfit_pressure_kpa",
}
"""Float attributes by what they are; NaN where the brace does not reach."""
COLOUR = "wovenfit_colour"
OUTLINE = "wovenfit_outline"
"""Edge attribute on the flat mesh: what is cut."""
SEAM = "wovenfit_seam"
"""Edge attribute on the flat mesh: the number of the seam, from 1, on both of its sides; else 0."""
_GAP = 0.15
"""Distance of the flat mesh from the limb, as a share of the limb's width."""


def write(limb, surface, solved, remarks, context):
    """Puts a pattern into the file. `limb` is in object mode."""
    pattern = solved.pattern
    kept = limb.wovenfit
    worn = limb
    if not surface.own or limb.data.library is not None:
        worn = kept.worn = _worn(limb, surface, context)
        remarks = [
            *remarks,
            f"the limb's modifiers change its faces: UV map and attributes are on {worn.name!r}, a "
            "copy with the modifiers applied",
        ]
    else:
        kept.worn = None
    _write_worn(worn.data, surface, pattern)
    kept.flat = _flat(limb, surface, pattern, context)
    kept.result = written(of_pattern(pattern, remarks, surface.unit))
    kept.solved = solved.name
    kept.error = kept.faults = ""
    kept.stale = False
    recolour(limb)


def recolour(limb):
    """Writes the colour attribute of limb and pattern from the values that are to be shown."""
    kept = limb.wovenfit
    if not kept.result or kept.flat is None:
        return
    name = VALUES[kept.shown]
    flat = kept.flat.data
    values = got(flat.attributes[name].data, "value", np.float32).astype(np.float64)
    between = colours.range_of(values)
    kept.scale_least, kept.scale_most = between
    for mesh in (flat, (kept.worn or limb).data):
        attribute = mesh.attributes.get(name)
        if attribute is None or len(attribute.data) != len(mesh.vertices):
            continue
        values = got(attribute.data, "value", np.float32).astype(np.float64)
        _put(mesh, COLOUR, "FLOAT_COLOR", "POINT", "color", colours.coloured(values, between))
        mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]
        mesh.update()


def _write_worn(mesh, surface, pattern):
    """UV map, values and the automatic seam on the mesh of the limb."""
    flat = polygon_corners(
        pattern.given_corner_coordinates,
        surface.corners,
        surface.polygons,
        surface.positions[surface.corner_vertices],
    )
    layer = mesh.uv_layers.get(UV) or mesh.uv_layers.new(name=UV, do_init=False)
    if layer is None:
        raise RuntimeError(
            "the limb has as many UV maps as Blender allows: remove one in its mesh properties"
        )
    uv = np.where(np.isfinite(flat), flat / MM_PER_UV, 0.0)
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())
    mesh.uv_layers.active = mesh.uv_layers[UV]
    for what, values in (
        (WARP, pattern.given_warp_strain),
        (WEFT, pattern.given_weft_strain),
        (PRESSURE, pattern.given_pressure_kpa),
    ):
        _put(mesh, VALUES[what], "FLOAT", "POINT", "value", values)
    if not len(surface.seams):
        _mark_automatic(mesh, torn_edges(pattern.given_corner_coordinates, surface.triangles))
    mesh.update()


def _mark_automatic(mesh, edges):
    """Marks the seams that the library chose, instead of those that it chose before."""
    ours = np.zeros(len(mesh.edges), bool)
    ours[_edge_indices(mesh, edges)] = True
    mesh.edges.foreach_set("use_seam", ours)
    _put(mesh, AUTO_SEAM, "BOOLEAN", "EDGE", "value", ours)


def _flat(limb, surface, pattern, context):
    """The pattern as a mesh: the object of an earlier result, or a new one beside the limb."""
    flat = limb.wovenfit.flat
    # A duplicated limb still refers to the other limb's pattern.
    if flat is None or flat.wovenfit.limb != limb:
        flat = bpy.data.objects.new(
            f"{limb.name} pattern", bpy.data.meshes.new(f"{limb.name} pattern")
        )
        flat.wovenfit.limb = limb
        _beside(flat, surface)
    if not any(one.objects.get(flat.name) for one in _collections(context.scene)):
        home = limb.users_collection[0] if limb.users_collection else context.scene.collection
        home.objects.link(flat)
    mesh = flat.data
    coordinates = pattern.coordinates / surface.unit
    _fill(
        mesh,
        np.concatenate([coordinates, np.zeros((len(coordinates), 1))], axis=1),
        pattern.triangles,
    )
    for what, values in (
        (WARP, pattern.warp_strain),
        (WEFT, pattern.weft_strain),
        (PRESSURE, pattern.pressure_kpa),
    ):
        _put(mesh, VALUES[what], "FLOAT", "POINT", "value", values)
    layer = mesh.uv_layers.new(name=UV, do_init=False)
    uv = pattern.coordinates[pattern.triangles.ravel()] / MM_PER_UV
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())
    cut = np.zeros(len(mesh.edges), bool)
    for loop in pattern.outline_vertices:
        cut[_edge_indices(mesh, np.stack([loop, np.roll(loop, -1)], axis=1))] = True
    number = np.zeros(len(mesh.edges), np.int32)
    for index, seam in enumerate(pattern.seams, 1):
        for side in (seam.left, seam.right):
            number[_edge_indices(mesh, np.stack([side[:-1], side[1:]], axis=1))] = index
    _put(mesh, OUTLINE, "BOOLEAN", "EDGE", "value", cut)
    _put(mesh, SEAM, "INT", "EDGE", "value", number)
    mesh.edges.foreach_set("use_seam", number > 0)
    mesh.update()
    return flat


def _beside(flat, surface):
    """Puts a new pattern upright beside the limb, its lower edge at the limb's lower end."""
    least, most = surface.positions.min(axis=0), surface.positions.max(axis=0)
    flat.rotation_euler = (np.pi / 2, 0.0, 0.0)
    flat.location = (
        most[0] + _GAP * (most[0] - least[0]),
        (least[1] + most[1]) / 2,
        least[2],
    )


def _worn(limb, surface, context):
    """The evaluated limb as an object of its own, where the limb's own mesh has other faces."""
    worn = limb.wovenfit.worn
    depsgraph = context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(
        limb.evaluated_get(depsgraph), preserve_all_data_layers=True, depsgraph=depsgraph
    )
    mesh.name = f"{limb.name} worn"
    if worn is None or worn.wovenfit.limb != limb:
        worn = bpy.data.objects.new(f"{limb.name} worn", mesh)
        worn.wovenfit.limb = limb
        limb.users_collection[0].objects.link(worn)
    else:
        former, worn.data = worn.data, mesh
        bpy.data.meshes.remove(former)
    worn.matrix_world = limb.matrix_world
    assert len(mesh.vertices) == len(surface.positions)
    return worn


def _collections(scene):
    return [scene.collection, *scene.collection.children_recursive]


def _fill(mesh, positions, triangles):
    """Replaces what a mesh holds by triangles."""
    mesh.clear_geometry()
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.astype(np.float32).ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    if bpy.app.version < (4, 1):
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.update(calc_edges=True)


def _edge_indices(mesh, edges):
    """(k,) the mesh's edge of each pair of vertices. Pairs that are no edge are left out."""
    edges = np.asarray(edges, np.int64).reshape(-1, 2)
    count = len(mesh.vertices)
    have = np.sort(got(mesh.edges, "vertices", np.int32, 2).astype(np.int64), axis=1)
    keys = have[:, 0] * count + have[:, 1]
    order = np.argsort(keys)
    asked = np.sort(edges, axis=1)
    wanted = asked[:, 0] * count + asked[:, 1]
    at = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    found = order[at] if len(keys) else np.empty(0, np.int64)
    return found[keys[found] == wanted]


def _put(mesh, name, kind, domain, value, values):
    """Writes an attribute, which is made anew if there is another of this name."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != (kind, domain):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(name, kind, domain)
    if attribute.name != name:
        raise RuntimeError(f"the mesh uses the name {name!r} for something else: rename that")
    dtype = {"FLOAT": np.float32, "FLOAT_COLOR": np.float32, "INT": np.int32, "BOOLEAN": bool}[kind]
    attribute.data.foreach_set(value, np.ascontiguousarray(values, dtype).ravel())


def faulty(surface, vertices, triangles):
    """The vertices and polygons of the limb's own mesh that faulty elements are."""
    if not surface.own:
        return [], []
    triangles = np.asarray(triangles, np.int64)
    triangles = triangles[triangles != NONE]
    return sorted({int(v) for v in vertices}), sorted({int(p) for p in surface.polygons[triangles]})
