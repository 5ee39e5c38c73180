"""What needs FreeCAD's window: views, commands and task panels. Never imported in the console."""
