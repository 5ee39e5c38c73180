"""The surface in: an object's evaluated mesh as the arrays that the library takes.

Modifiers are on, coordinates are the world's, polygons are split as Blender splits them, and a
mirrored object's triangles are turned so that they face outward as they are seen.
"""

from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from .plain.fields import exact
from .plain.solve import fingerprint
from .properties import SCENE
from .wovenfit import Mesh
from .wovenfit.mesh import millimetres

AUTO_SEAM = "wovenfit_auto_seam"
"""Edge attribute: seams that the library chose and the add-on marked."""


@dataclass(frozen=True)
class Surface:
    """The evaluated mesh of a limb; n vertices, m triangles, c polygon corners."""

    positions: np.ndarray
    """(n, 3) 64-bit places in the world, in `unit`."""
    triangles: np.ndarray
    """(m, 3) vertices."""
    corners: np.ndarray
    """(m, 3) the polygons' corner (loop) that each triangle's corner is."""
    polygons: np.ndarray
    """(m,) the polygon of each triangle."""
    corner_vertices: np.ndarray
    """(c,) the vertex of each corner."""
    unit: float
    """Millimetres in one unit of the positions."""
    own: bool
    """Whether its elements are, one by one, those of the object's own mesh."""
    seams: np.ndarray
    """(k, 2) edges that are marked as seams by the designer."""
    selected: np.ndarray
    """(m,) whether each triangle's polygon is selected."""

    def mesh(self):
        """The mesh for the library."""
        return Mesh(self.positions, self.triangles, self.unit)

    @property
    def fingerprint(self):
        """What tells it from others."""
        return fingerprint(self.positions, self.triangles, self.unit)


def unit_of(limb, scene):
    """Millimetres in one unit of the limb's world coordinates."""
    chosen = limb.wovenfit.units
    if chosen != SCENE:
        return millimetres(chosen)
    settings = scene.unit_settings
    # Without a system Blender shows no unit and its unit scale says nothing: a unit is a metre.
    scale = 1.0 if settings.system == "NONE" else exact(settings.scale_length)
    return 1000.0 * scale


@contextmanager
def object_mode(limb):
    """The limb in object mode, in which its mesh can be read and written; then as it was.

    Only where it is edited: sculpting and painting need no change.
    """
    edited = limb.mode == "EDIT"
    if edited:
        bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        if edited:
            bpy.ops.object.mode_set(mode="EDIT")


def got(collection, name, dtype, *row):
    """A property of all elements of a collection of the mesh, as an array."""
    width = int(np.prod(row)) if row else 1
    values = np.empty(len(collection) * width, dtype)
    if len(collection):
        collection.foreach_get(name, values)
    return values.reshape(-1, *row)


def in_world(limb, points):
    """(n, 3) points of the object in the world, with 64 bits."""
    matrix = np.array(limb.matrix_world, np.float64)
    return np.asarray(points, np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


@contextmanager
def evaluated_mesh(limb, depsgraph):
    """The mesh of a limb with its modifiers, for reading."""
    evaluated = limb.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
    try:
        yield mesh
    finally:
        evaluated.to_mesh_clear()


def read(limb, context):
    """The surface of a limb, which is in object mode."""
    depsgraph = context.evaluated_depsgraph_get()
    with evaluated_mesh(limb, depsgraph) as mesh:
        mesh.calc_loop_triangles()
        triangles = got(mesh.loop_triangles, "vertices", np.int32, 3)
        corners = got(mesh.loop_triangles, "loops", np.int32, 3)
        polygons = got(mesh.loop_triangles, "polygon_index", np.int32)
        corner_vertices = got(mesh.loops, "vertex_index", np.int32)
        own = _same_elements(mesh, limb.data, corner_vertices)
        positions = in_world(limb, got(mesh.vertices, "co", np.float32, 3))
        if np.linalg.det(np.array(limb.matrix_world, np.float64)[:3, :3]) < 0.0:
            triangles, corners = triangles[:, ::-1], corners[:, ::-1]
        chosen = got(mesh.polygons, "select", bool)
        return Surface(
            positions=np.ascontiguousarray(positions),
            triangles=np.ascontiguousarray(triangles, np.uint32),
            corners=np.ascontiguousarray(corners, np.uint32),
            polygons=polygons.astype(np.uint32),
            corner_vertices=corner_vertices,
            unit=unit_of(limb, context.scene),
            own=own,
            seams=_designers_seams(mesh),
            selected=chosen[polygons] if len(polygons) else np.zeros(0, bool),
        )


def weights(limb, context, name):
    """(n,) weights of a vertex group at the vertices of the evaluated mesh, 0 outside of it."""
    index = limb.vertex_groups[name].index
    with evaluated_mesh(limb, context.evaluated_depsgraph_get()) as mesh:
        found = np.zeros(len(mesh.vertices))
        for vertex in mesh.vertices:
            for one in vertex.groups:
                if one.group == index:
                    found[vertex.index] = exact(one.weight)
    return found


def seam_edges(mesh):
    """(n,) whether each edge is marked as a seam, and whether the add-on marked it."""
    marked = got(mesh.edges, "use_seam", bool)
    ours = np.zeros(len(marked), bool)
    attribute = mesh.attributes.get(AUTO_SEAM)
    if attribute is not None and attribute.domain == "EDGE" and len(attribute.data) == len(marked):
        ours = got(attribute.data, "value", bool)
    return marked, ours


def _designers_seams(mesh):
    """Seams that are not just as the library chose them: those are found again."""
    marked, ours = seam_edges(mesh)
    if (marked == ours).all():
        return np.empty((0, 2), np.uint32)
    return got(mesh.edges, "vertices", np.int32, 2)[marked].astype(np.uint32)


def _same_elements(mesh, base, corner_vertices):
    return (
        len(mesh.vertices) == len(base.vertices)
        and len(mesh.polygons) == len(base.polygons)
        and len(corner_vertices) == len(base.loops)
        and bool((corner_vertices == got(base.loops, "vertex_index", np.int32)).all())
    )
