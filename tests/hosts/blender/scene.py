"""What the tests share: limbs as objects, selecting, and reading back what the add-on wrote."""

import importlib
import json
import os
from pathlib import Path

import bpy
import numpy as np

module_name = ""
"""The add-on's module, which depends on how it was installed."""

LIMB = Path(os.environ["WOVENFIT_LIMB"])
SCRATCH = Path(os.environ["WOVENFIT_SCRATCH"])


def addon(name):
    """A module of the installed add-on."""
    return importlib.import_module(f"{module_name}.{name}")


def clear():
    """An empty scene in metres, the add-on stays enabled."""
    addon("job").drop()
    addon("job").memory.clear()
    active = bpy.context.view_layer.objects.active
    if active is not None and active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    for one in list(bpy.data.meshes):
        bpy.data.meshes.remove(one)
    settings = bpy.context.scene.unit_settings
    settings.system, settings.scale_length = "METRIC", 1.0


def place(points, faces, name="limb"):
    """A mesh object, active and alone selected."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(points).tolist(), [], [list(map(int, face)) for face in faces])
    limb = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(limb)
    activate(limb)
    bpy.context.view_layer.update()
    return limb


def activate(limb):
    """Makes an object the active one and the only one that is selected."""
    # What was made or removed a moment ago comes into the view layer with its update.
    bpy.context.view_layer.update()
    for one in bpy.context.view_layer.objects:
        one.select_set(one == limb)
    bpy.context.view_layer.objects.active = limb


def sample():
    """Points in mm and triangles of the sample limb, and its design."""
    points, faces = [], []
    for line in LIMB.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    design = json.loads(LIMB.with_suffix(".design.json").read_text(encoding="utf-8"))
    return np.array(points), np.array(faces), design


def arm(unit=0.001):
    """The sample limb, one unit of the scene being `1 / unit` mm, and its design."""
    points, faces, design = sample()
    return place(points * unit, faces), design


def pinned_arm():
    """The sample limb in metres with the pressures of its design at the nearest vertices."""
    limb, design = arm()
    points, _, _ = sample()
    for wanted in design["pressures"]:
        nearest = int(np.argmin(np.linalg.norm(points - wanted["at"], axis=1)))
        pin(limb, nearest, wanted["kpa"])
    return limb


def pin(limb, vertex, kpa):
    """Selects a vertex and adds a pressure there, as the designer does."""
    choose(limb, [vertex])
    done = bpy.ops.wovenfit.add_pressure(kpa=kpa)
    assert done == {"FINISHED"}, done


def choose(limb, vertices):
    """Selects vertices and nothing else, in object mode."""
    mesh = limb.data
    # By the operator: Blender 5.0.1 crashes where a script writes the flags of edges.
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    flags = np.zeros(len(mesh.vertices), bool)
    flags[list(vertices)] = True
    mesh.vertices.foreach_set("select", flags)


def choose_faces(limb, flags):
    """Selects polygons and nothing else, in object mode."""
    choose(limb, [])
    limb.data.polygons.foreach_set("select", np.asarray(flags, bool))
    limb.data.update()


RADIUS, LENGTH, SIDES, RINGS = 45.0, 120.0, 48, 31
"""Of the tube, in mm."""


def tube(quads=False, unit=0.001):
    """A cylinder along z, open at both ends; ring r begins at vertex r SIDES."""
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    points, faces = [], []
    for ring in range(RINGS):
        z = LENGTH * ring / (RINGS - 1)
        points += [[RADIUS * np.cos(a), RADIUS * np.sin(a), z] for a in angle]
    for ring in range(RINGS - 1):
        for side in range(SIDES):
            a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
            c, d = b + SIDES, a + SIDES
            faces += [[a, b, c, d]] if quads else [[a, b, c], [a, c, d]]
    return place(np.array(points) * unit, faces)


GIRTH = 2 * SIDES * RADIUS * np.sin(np.pi / SIDES)
"""Of the tube's polygon, in mm."""


def flatten():
    """Presses Flatten; it must find a pattern. What was solved."""
    done = bpy.ops.wovenfit.flatten()
    assert done == {"FINISHED"}, done
    return solved()


def update():
    """Presses Update."""
    done = bpy.ops.wovenfit.update()
    assert done == {"FINISHED"}, done
    return solved()


def limb_now():
    """The limb of the active object."""
    return addon("properties").limb_of(bpy.context)


def solved():
    """The pattern in memory of the active limb."""
    return addon("job").memory.find(limb_now().wovenfit.solved)


def result():
    """What the panel Result shows."""
    return json.loads(limb_now().wovenfit.result)


def refused(operator, *words):
    """Presses something that must be refused with an error that has these words; its text."""
    try:
        done = operator()
    except RuntimeError as error:
        text = str(error)
    else:
        raise AssertionError(f"it was not refused: {done}")
    for word in words:
        assert word in text, f"{word!r} is not in {text!r}"
    return text


def values(mesh, name):
    """A float attribute, as an array."""
    data = mesh.attributes[name].data
    found = np.empty(len(data), np.float32)
    data.foreach_get("value", found)
    return found


def vectors(collection, name, width=3):
    """A vector of every element of a collection."""
    found = np.empty(len(collection) * width, np.float32)
    collection.foreach_get(name, found)
    return found.reshape(-1, width).astype(float)


def world(limb):
    """(n, 3) the vertices in the world, worked out here, in 64 bits."""
    matrix = np.array(limb.matrix_world, float)
    return vectors(limb.data.vertices, "co") @ matrix[:3, :3].T + matrix[:3, 3]


def corner_uv(mesh, name="wovenfit"):
    """(c, 2) UV coordinates of all corners."""
    return vectors(mesh.uv_layers[name].data, "uv", 2)


def near(got, wanted, within):
    """Fails unless two numbers are as close as that."""
    assert abs(got - wanted) <= within, f"{got} is not within {within} of {wanted}"
