"""What the commands share: texts, the brace that is meant, and how a reason is shown."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from ...brace import is_brace
from ..resources import icon
from ..telling import complain


class Command:
    """A command of the menu and the toolbar. Subclasses say what it is and what it does."""

    name = ""
    picture = ""
    text = ""
    tip = ""

    def GetResources(self) -> dict[str, str]:
        return {"Pixmap": icon(self.picture), "MenuText": self.text, "ToolTip": self.tip}

    def IsActive(self) -> bool:
        return FreeCADGui.Control.activeDialog() is False and the_brace() is not None

    def Activated(self) -> None:
        try:
            self.run(the_brace())
        except Exception as error:  # shown to the designer, whatever it is
            complain(self.text, str(error))

    def run(self, brace: Any) -> None:
        """Does it to a brace."""
        raise NotImplementedError


def the_brace() -> Any:
    """The brace that is selected, itself or by what shows it; or the only one of the document."""
    document = FreeCAD.ActiveDocument
    if document is None:
        return None
    for obj in FreeCADGui.Selection.getSelection(document.Name):
        if is_brace(obj):
            return obj
        owner = getattr(obj, "Brace", None)
        if owner is not None and is_brace(owner):
            return owner
    braces = [obj for obj in document.Objects if is_brace(obj)]
    return braces[0] if len(braces) == 1 else None
