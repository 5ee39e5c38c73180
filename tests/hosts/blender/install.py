"""Installs a built package into this Blender as a user does, and enables it.

The packages are found in the folder that the environment's WOVENFIT_PACKAGES names: the extension
for Blender 4.2 and later, else the legacy add-on.
"""

import os
from pathlib import Path

import addon_utils
import bpy


def package():
    """The zip file for this Blender."""
    folder = Path(os.environ["WOVENFIT_PACKAGES"])
    legacy = bpy.app.version < (4, 2)
    found = [one for one in folder.glob("*.zip") if one.stem.endswith("-legacy") == legacy]
    assert len(found) == 1, f"one package is needed in {folder}, there are {found}"
    return found[0]


def install():
    """The module's name."""
    if bpy.app.version < (4, 2):
        name = "wovenfit_blender"
        bpy.ops.preferences.addon_install(filepath=str(package()))
        bpy.ops.preferences.addon_enable(module=name)
    else:
        name = "bl_ext.user_default.wovenfit_blender"
        bpy.ops.extensions.package_install_files(
            filepath=str(package()), repo="user_default", enable_on_install=True, overwrite=True
        )
    assert addon_utils.check(name)[1], f"{name} is not enabled"
    return name
