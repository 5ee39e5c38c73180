"""Runs the tests of the add-on inside a Blender, after installing the built package as a user does.

    blender -b --factory-startup --python-exit-code 1 --python run.py     (Blender itself)
    python run.py                                                         (PyPI's bpy)

Read from the environment: WOVENFIT_PACKAGES (the folder with the packages), WOVENFIT_LIMB (an OBJ
of `wovenfit sample`, its design beside it), WOVENFIT_PROGRAM (the command line), WOVENFIT_SCRATCH
(a folder), WOVENFIT_ONLY (tests whose name contains it). The last line says `N passed, M failed`.
"""

import importlib
import os
import sys
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
# Nothing of the checkout may stand in for what the package carries.
assert "WOVENFIT_LIBRARY" not in os.environ, "WOVENFIT_LIBRARY is set: unset it"

import bpy  # noqa: E402  Blender's module, after the path
import scene  # noqa: E402
from install import install  # noqa: E402

MODULES = ("surface_in", "pressures", "seams", "result_out", "files", "lifetime", "settings")


def main():
    scene.module_name = install()
    only = os.environ.get("WOVENFIT_ONLY", "")
    passed, failed = 0, []
    for name in MODULES:
        module = importlib.import_module(f"test_{name}")
        for test in [key for key in vars(module) if key.startswith("test_") and only in key]:
            scene.clear()
            try:
                getattr(module, test)()
                passed += 1
            except Exception:
                traceback.print_exc()
                print(f"FAILED: {name}.{test}")
                failed.append(test)
    print(f"Blender {bpy.app.version_string}: {passed} passed, {len(failed)} failed")
    sys.stdout.flush()
    # A Blender that is left in the usual way may still crash while it frees everything.
    os._exit(1 if failed or not passed else 0)


main()
