"""wovenfit in Blender: flat patterns of elastic medical braces from scanned limbs.

Importing registers nothing. `plain/` does what needs no Blender, `wovenfit/` is the Python package
with the shared library, put there when the add-on is built; everything else knows bpy.
"""

import bpy

from . import (
    drawing,
    files,
    flatten,
    job,
    marking,
    panels,
    preferences,
    presets,
    properties,
    viewing,
)

bl_info = {
    "name": "WovenFit",
    "author": "The wovenfit authors",
    "description": "Flat patterns of elastic medical braces from scanned limbs",
    "blender": (3, 4, 0),
    "version": (0, 0, 0),
    "location": "3D View > Sidebar > WovenFit",
    "category": "Object",
}

_MODULES = (preferences, properties, presets, marking, flatten, files, viewing, panels, drawing)
"""In the order in which they are registered."""


@bpy.app.handlers.persistent
def _another_file(*_):
    """Another file is opened: what runs is for the former one."""
    job.drop()
    job.memory.clear()


def register():
    """Called by Blender when the add-on is enabled."""
    for module in _MODULES:
        for one in getattr(module, "CLASSES", ()):
            bpy.utils.register_class(one)
        if hasattr(module, "register"):
            module.register()
    bpy.app.handlers.load_pre.append(_another_file)


def unregister():
    """Called by Blender when the add-on is disabled."""
    bpy.app.handlers.load_pre.remove(_another_file)
    for module in reversed(_MODULES):
        if hasattr(module, "unregister"):
            module.unregister()
        for one in reversed(getattr(module, "CLASSES", ())):
            bpy.utils.unregister_class(one)
