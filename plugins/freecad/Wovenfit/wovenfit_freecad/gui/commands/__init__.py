"""Commands, one a file; `register` makes them known to FreeCAD."""

from __future__ import annotations

import FreeCADGui

from .export import Export
from .flatten import Flatten
from .new_brace import NewBrace
from .orientation import Orientation
from .page import Page
from .pressure import AddPressure
from .region import Region
from .report import Report
from .seam import Seam

COMMANDS = (
    NewBrace(),
    AddPressure(),
    Orientation(),
    Seam(),
    Region(),
    Flatten(),
    Export(),
    Page(),
    Report(),
)
"""In the order of a designer's work."""


def register() -> list[str]:
    """Makes the commands known; their names."""
    for command in COMMANDS:
        FreeCADGui.addCommand(command.name, command)
    return [command.name for command in COMMANDS]
