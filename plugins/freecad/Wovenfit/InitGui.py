"""The workbench, as FreeCAD's window finds it."""

import FreeCADGui


class WovenfitWorkbench(FreeCADGui.Workbench):
    """Menu and toolbar; all else is in the package wovenfit_freecad."""

    MenuText = "Wovenfit"
    ToolTip = "Flat patterns of elastic medical braces from scanned limbs"

    def __init__(self):
        from wovenfit_freecad.gui.resources import icon

        self.__class__.Icon = icon("Wovenfit")

    def GetClassName(self):
        return "Gui::PythonWorkbench"

    def Initialize(self):
        from wovenfit_freecad.gui.workbench import begin

        names = begin()
        self.appendToolbar("Wovenfit", names)
        self.appendMenu("Wovenfit", names)


FreeCADGui.addWorkbench(WovenfitWorkbench())
