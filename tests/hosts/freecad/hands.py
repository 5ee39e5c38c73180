"""A designer's hands and eyes in FreeCAD's window: clicks, keys, panels, labels, pictures."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import FreeCAD
import FreeCADGui
import limbs
from PySide import QtCore, QtGui

PICTURES = Path(os.environ["PICTURES"])


def wait(seconds: float) -> None:
    """Lets the window work."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QtGui.QApplication.processEvents()
        time.sleep(0.01)


def wait_for(holds, what: str, seconds: float = 60.0) -> None:
    """Lets the window work until something holds."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"after {seconds} s still not: {what}"
        wait(0.02)


def picture(name: str):
    """A picture of the whole window, kept."""
    wait(0.5)
    file = PICTURES / f"{name}.png"
    subprocess.run(["import", "-window", "root", str(file)], check=True, stdin=subprocess.DEVNULL)
    image = QtGui.QImage(str(file))
    shades = {
        image.pixel(x, y) for x in range(0, image.width(), 40) for y in range(0, image.height(), 40)
    }
    assert len(shades) > 10, f"{name} is empty"
    return image


def unlike(one, other) -> float:
    """The share of points of the 3D view that differ clearly between two pictures of the window."""
    points = [
        (x, y)
        for x in range(one.width() * 5 // 12, one.width() * 10 // 12, 4)
        for y in range(one.height() // 4, one.height() * 2 // 3, 4)
    ]
    clearly = 0
    for x, y in points:
        a, b = QtGui.QColor(one.pixel(x, y)), QtGui.QColor(other.pixel(x, y))
        steps = (a.red() - b.red(), a.green() - b.green(), a.blue() - b.blue())
        clearly += max(map(abs, steps)) > 30
    return clearly / len(points)


def view():
    return FreeCADGui.activeDocument().activeView()


def click(place) -> None:
    """A click of the left button on a place of the 3D view, as the mouse makes it."""
    area = view().graphicsView().viewport()
    x, y = view().getPointOnScreen(FreeCAD.Vector(*place))
    ratio = area.devicePixelRatioF()
    at = QtCore.QPointF(x / ratio, area.height() - 1 - y / ratio)
    kinds = (
        (QtCore.QEvent.MouseMove, QtCore.Qt.NoButton),
        (QtCore.QEvent.MouseButtonPress, QtCore.Qt.LeftButton),
        (QtCore.QEvent.MouseButtonRelease, QtCore.Qt.LeftButton),
    )
    for kind, button in kinds:
        held = button if kind == QtCore.QEvent.MouseButtonPress else QtCore.Qt.NoButton
        event = QtGui.QMouseEvent(kind, at, button, held, QtCore.Qt.NoModifier)
        QtGui.QApplication.sendEvent(area, event)
    wait(0.1)


def type_into(widget, text: str) -> None:
    """Keys, and Tab at the end."""
    for key, words in [*((0, c) for c in text), (QtCore.Qt.Key_Tab, "\t")]:
        for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
            event = QtGui.QKeyEvent(kind, key, QtCore.Qt.NoModifier, words)
            QtGui.QApplication.sendEvent(widget, event)
    wait(0.05)


def panel(command: str):
    """Runs a command and gives the task panel that it opens."""
    from wovenfit_freecad.gui.panels import panel as module

    opened = []
    show = module.show

    def remember(one):
        opened.append(one)
        return show(one)

    for name, loaded in list(sys.modules.items()):
        if name.startswith("wovenfit_freecad.gui") and getattr(loaded, "show", None) is show:
            loaded.show = remember
    try:
        FreeCADGui.runCommand(f"Wovenfit_{command}")
    finally:
        for name, loaded in list(sys.modules.items()):
            if (
                name.startswith("wovenfit_freecad.gui")
                and getattr(loaded, "show", None) is remember
            ):
                loaded.show = show
    wait(0.2)
    assert opened and FreeCADGui.Control.activeDialog(), f"{command} opened no panel"
    return opened[0]


def labels(brace) -> list[str]:
    """The texts in the view of a brace."""
    return texts_in(brace.ViewObject.Proxy._marks)


def scale_texts(worn) -> list[str]:
    """The texts of the scale of a worn surface, from its low end up, then its title."""
    return texts_in(worn.ViewObject.Proxy._scale)


def _unasked(*words):
    """A box that nobody expects would wait for an answer for ever."""
    raise AssertionError(f"a box came up: {words[-1]}")


QtGui.QMessageBox.warning = staticmethod(_unasked)


@contextmanager
def answering():
    """Closes the boxes with a warning; gives the list of what they said."""
    told = []
    warning = QtGui.QMessageBox.warning
    QtGui.QMessageBox.warning = staticmethod(lambda *words: told.append(words[-1]))
    try:
        yield told
    finally:
        QtGui.QMessageBox.warning = warning


def texts_in(scene) -> list[str]:
    """The framed labels of a scene."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setType(coin.SoType.fromName("SoFrameLabel"))
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(scene)
    paths = search.getPaths()
    return [
        str(paths[i].getTail().getField("string").get().getString()).strip('"')
        for i in range(paths.getLength())
    ]


def one_brace(mesh=None):
    """A document with a prism and a brace on it, made by the command."""
    # What a check that failed has left.
    if FreeCADGui.Control.activeDialog():
        FreeCADGui.Control.closeDialog()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    document = FreeCAD.newDocument("Window")
    scan = limbs.add_mesh(document, mesh or limbs.prism())
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(scan)
    FreeCADGui.runCommand("Wovenfit_NewBrace")
    wait(0.1)
    view().viewFront()
    view().fitAll()
    wait(0.3)
    return document, document.Brace
