"""Elastic medical braces in FreeCAD: limb, fabric and wanted pressures become a pattern.

A script begins here; nothing of the window is imported:

    import FreeCAD
    import wovenfit_freecad as brace_tools

    document = FreeCAD.newDocument("Elbow")
    brace = brace_tools.new_brace(document, scan)          # a mesh, or a shape's faces
    brace_tools.add_pressure(brace, (-40, 0, 20), "15 Torr")
    document.recompute()
    brace_tools.export(brace, "elbow")

Coordinates are in mm in the document's global frame. What is computed, and by which model, stands
in the documentation of the package `wovenfit`, which computes it.
"""

from .edits import (
    add_pressure,
    add_region_between,
    add_region_plane,
    add_seam,
    apply_design,
    clear_orientation,
    clear_region,
    clear_seams,
    design_of,
    new_brace,
    remove_pressure,
    set_orientation,
)
from .files import export, file_names, formats, write_report
from .page import make_page

__all__ = [
    "add_pressure",
    "add_region_between",
    "add_region_plane",
    "add_seam",
    "apply_design",
    "clear_orientation",
    "clear_region",
    "clear_seams",
    "design_of",
    "export",
    "file_names",
    "formats",
    "make_page",
    "new_brace",
    "remove_pressure",
    "set_orientation",
    "write_report",
]
