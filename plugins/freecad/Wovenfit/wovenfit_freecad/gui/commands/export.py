"""Export: the library's files into a folder."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtGui

from ... import files
from .command import Command


class Export(Command):
    """Asks for a folder."""

    name = "Wovenfit_Export"
    picture = "Export"
    text = "Export"
    tip = "Write all files of the brace into a folder: " + ", ".join(files.file_names())

    def run(self, brace: Any) -> None:
        folder = QtGui.QFileDialog.getExistingDirectory(
            FreeCADGui.getMainWindow(), "A folder for the files of the brace"
        )
        if folder:
            written = files.export(brace, folder)
            FreeCAD.Console.PrintMessage(
                f"{brace.Label}: {', '.join(path.name for path in written)} in {folder}\n"
            )
