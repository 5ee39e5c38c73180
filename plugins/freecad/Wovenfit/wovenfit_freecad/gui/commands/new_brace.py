"""New brace from what is selected."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from ... import edits
from ...quantities import LENGTH, quantity
from ...source import is_source
from ..telling import complain_if_invalid
from .command import Command


class NewBrace(Command):
    """A mesh, a shape, or faces of one become the source of a brace."""

    name = "Wovenfit_NewBrace"
    picture = "NewBrace"
    text = "New brace"
    tip = "Make a brace on the selected mesh, shape or faces; a shape is divided into triangles"

    def IsActive(self) -> bool:
        return _selected() is not None

    def Activated(self) -> None:
        chosen = _selected()
        if chosen is None:
            return
        source, faces = chosen
        edge_length = None if source.isDerivedFrom("Mesh::Feature") else _ask_edge_length()
        if edge_length == 0:
            return
        make(source, faces, edge_length)

    def run(self, brace: Any) -> None:
        """Needs no brace."""


def make(source: Any, faces: list[str], edge_length: float | None) -> Any:
    """Makes the brace as one step of undo; it is flattened as it stands, without pressures."""
    document = source.Document
    document.openTransaction("New brace")
    brace = edits.new_brace(document, source, faces)
    if edge_length is not None:
        brace.EdgeLength = quantity(edge_length, LENGTH)
    document.recompute()
    document.commitTransaction()
    complain_if_invalid("New brace", brace)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(brace)
    return brace


def _ask_edge_length() -> float:
    """The longest edge of a tessellation in mm; 0 if the designer thinks better of it."""
    from PySide import QtGui

    value, well = QtGui.QInputDialog.getDouble(
        FreeCADGui.getMainWindow(),
        "New brace",
        "Longest edge of the triangles into which the shape is divided, in mm.\n"
        "On a limb of radius r they depart from it by its square over 8 r.",
        4.0,
        0.5,
        30.0,
        1,
    )
    return value if well else 0.0


def _selected() -> tuple[Any, list[str]] | None:
    if FreeCAD.ActiveDocument is None:
        return None
    for chosen in FreeCADGui.Selection.getSelectionEx():
        if is_source(chosen.Object) and getattr(chosen.Object, "Brace", None) is None:
            return chosen.Object, [n for n in chosen.SubElementNames if n.startswith("Face")]
    return None
