"""The operators that write files: the report page for the browser, and every file of a pattern."""

import tempfile
import webbrowser
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper

from . import job
from .properties import limb_of
from .wovenfit import FILES, pattern_formats

_PAGE = "report.html"


def _solved(cls, context):
    limb = limb_of(context)
    if limb is None or not limb.wovenfit.result:
        cls.poll_message_set("There is no pattern yet: press Flatten")
        return False
    if job.memory.find(limb.wovenfit.solved) is None:
        cls.poll_message_set(
            "This pattern is not in memory any more (a file was opened): press Flatten again"
        )
        return False
    return True


def _pattern(context):
    return job.memory.find(limb_of(context).wovenfit.solved).pattern


class WOVENFIT_OT_open_report(bpy.types.Operator):
    """Open the report in the browser: read it before you cut"""

    bl_idname = "wovenfit.open_report"
    bl_label = "Open Report"

    @classmethod
    def poll(cls, context):
        return _solved(cls, context)

    def execute(self, context):
        # Not Blender's own temporary folder, which goes with Blender: the page stays open.
        folder = Path(tempfile.mkdtemp(prefix="wovenfit-"))
        page = folder / _PAGE
        page.write_bytes(_pattern(context).file(_PAGE))
        if not webbrowser.open(page.as_uri()):
            self.report({"ERROR"}, f"No browser could be opened; the report is {page}")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Report: {page}")
        return {"FINISHED"}


def _files(self, context):
    """The library's files, as Blender keeps them."""
    del self, context
    return _FILE_ITEMS


_FORMATS = {row.file_name: row for row in pattern_formats()}
_NAMES = [*(name for name in FILES if name not in _FORMATS), *_FORMATS]


def _what(name):
    row = _FORMATS.get(name)
    return f"The pattern: {row.summary}" if row else f"Write {name}, as the command line does"


_FILE_ITEMS = [(name, name, _what(name)) for name in _NAMES]


def _unit():
    """The property of both operators that write a pattern."""
    return bpy.props.EnumProperty(
        name="Unit",
        description="Of the pattern's numbers in SVG and DXF, and of the lengths written on it",
        items=[("mm", "Millimetres", "Lengths in mm"), ("in", "Inches", "Lengths in inches")],
    )


class WOVENFIT_OT_export_file(bpy.types.Operator, ExportHelper):
    """Write one file of the pattern"""

    bl_idname = "wovenfit.export_file"
    bl_label = "Export File"

    filename_ext = ""
    check_extension = None
    file: bpy.props.EnumProperty(name="File", description="Which file", items=_files)
    unit: _unit()

    @classmethod
    def poll(cls, context):
        return _solved(cls, context)

    def invoke(self, context, event):
        del event
        self.filepath = str(Path(_folder(self.filepath)) / self.file)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context):
        """Keeps the file's ending that of the chosen file."""
        del context
        path, ending = Path(self.filepath), Path(self.file).suffix
        if path.suffix == ending or not path.name:
            return False
        same_kind = {Path(name).suffix for name in _NAMES}
        bare = path.with_suffix("") if path.suffix in same_kind else path
        self.filepath = str(bare) + ending
        return True

    def execute(self, context):
        path = Path(bpy.path.abspath(self.filepath))
        try:
            path.write_bytes(self._contents(_pattern(context)))
        except OSError as error:
            self.report({"ERROR"}, f"{path} cannot be written: {error.strerror}")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Written: {path}")
        return {"FINISHED"}

    def _contents(self, pattern):
        row = _FORMATS.get(self.file)
        if row is None:
            return pattern.file(self.file)
        for note in pattern.export_notes(row.name, self.unit):
            self.report({"WARNING"}, note)
        return pattern.export(row.name, self.unit)


class WOVENFIT_OT_export_all(bpy.types.Operator):
    """Write all files of the pattern into a folder, in every format: all of them or none"""

    bl_idname = "wovenfit.export_all"
    bl_label = "Export All Files"

    directory: bpy.props.StringProperty(subtype="DIR_PATH")
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    unit: _unit()

    @classmethod
    def poll(cls, context):
        return _solved(cls, context)

    def invoke(self, context, event):
        del event
        self.directory = _folder(self.directory)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        folder = Path(bpy.path.abspath(self.directory))
        try:
            formats = [row.name for row in _FORMATS.values()]
            written = _pattern(context).write(folder, formats=formats, unit=self.unit)
        except OSError as error:
            self.report({"ERROR"}, f"{folder} cannot be written into: {error.strerror}")
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(written)} files written into {folder}")
        return {"FINISHED"}


def _folder(path):
    """The folder of a path that was given, else that of the Blender file, else the user's."""
    if path:
        given = Path(bpy.path.abspath(path))
        for folder in (given, given.parent):
            if folder.is_dir():
                return f"{folder}/"
    return f"{Path(bpy.data.filepath).parent if bpy.data.filepath else Path.home()}/"


CLASSES = (WOVENFIT_OT_open_report, WOVENFIT_OT_export_file, WOVENFIT_OT_export_all)
