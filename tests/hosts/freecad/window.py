"""What a designer does in the window: the workbench, clicks, panels, progress, cancel."""

from __future__ import annotations

import os
import sys
import time
import traceback

sys.path.insert(0, os.environ["TESTS"])

import FreeCAD
import FreeCADGui
import limbs
import Mesh
import numpy as np
import wovenfit
import wovenfit_freecad as tools
from hands import (
    answering,
    click,
    labels,
    one_brace,
    panel,
    picture,
    scale_texts,
    type_into,
    unlike,
    view,
    wait,
    wait_for,
)
from harness import SCRATCH, check, close, run_all
from PySide import QtCore, QtGui

NAMES = (
    "NewBrace",
    "AddPressure",
    "Orientation",
    "Seam",
    "Region",
    "Flatten",
    "Export",
    "Page",
    "Report",
)


FRONT = -np.pi / 2
"""The angle of the prism's side that faces the front view."""


@check
def the_workbench_has_its_commands_with_icons_menu_and_tooltips():
    FreeCADGui.activateWorkbench("WovenfitWorkbench")
    bench = FreeCADGui.activeWorkbench()
    assert not QtGui.QIcon(bench.Icon).pixmap(32, 32).isNull()
    wait(0.3)
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtGui.QToolBar) if bar.objectName() == "Wovenfit"]
    shown = [action for action in bars[0].actions() if action.isVisible()]
    assert len(shown) == len(NAMES), [action.text() for action in shown]
    for action in shown:
        assert not action.icon().isNull() and len(action.toolTip()) > 10, action.text()
    menus = [
        menu for menu in window.menuBar().actions() if menu.text().replace("&", "") == "Wovenfit"
    ]
    assert len(menus[0].menu().actions()) == len(NAMES)
    for name in NAMES:
        assert f"Wovenfit_{name}" in FreeCADGui.listCommands()
    for name in (*NAMES, "Brace", "Pattern", "Worn", "Wovenfit"):
        from wovenfit_freecad.gui.resources import icon

        drawn = QtGui.QIcon(icon(name)).pixmap(64, 64).toImage()
        shades = {drawn.pixel(x, y) for x in range(64) for y in range(64)}
        assert len(shades) > 8, f"the icon {name} is empty"


@check
def a_new_brace_from_the_selected_mesh_is_one_step_of_undo():
    document, brace = one_brace()
    assert brace.isValid(), brace.getStatusString()
    assert [child.Name for child in brace.ViewObject.Proxy.claimChildren()] == ["Pattern", "Worn"]
    document.undo()
    wait(0.2)
    assert [obj.Name for obj in document.Objects] == ["Scan"], [
        obj.Name for obj in document.Objects
    ]
    document.redo()
    wait(0.2)
    assert document.Brace.isValid() and document.Pattern.Shape.Wires[0].isClosed()


@check
def a_new_brace_from_a_face_is_tessellated():
    one_brace()
    document = FreeCAD.newDocument("Face")
    cylinder = document.addObject("Part::Cylinder", "Cylinder")
    cylinder.Radius, cylinder.Height = 45, 90
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.Name, "Cylinder", "Face1")
    asked = QtGui.QInputDialog.getDouble
    QtGui.QInputDialog.getDouble = staticmethod(lambda *_: (6.0, True))
    try:
        FreeCADGui.runCommand("Wovenfit_NewBrace")
    finally:
        QtGui.QInputDialog.getDouble = asked
    brace = document.Brace
    assert brace.Source == (cylinder, ["Face1"]) and brace.EdgeLength.Value == 6.0
    assert brace.isValid(), brace.getStatusString()


@check
def a_click_and_a_typed_value_add_a_pressure_with_its_label():
    document, brace = one_brace()
    steps = document.UndoCount
    opened = panel("AddPressure")
    place = limbs.on_prism(FRONT, 50.0)
    click(place)
    assert opened.table.rowCount() == 1, "the click was not picked"
    type_into(opened.box(0), "18")
    picture("pressures")
    opened.accept()
    wait(0.2)
    assert FreeCADGui.Control.activeDialog() is False
    close(brace.Pressure1.getValueAs("Torr").Value, 18.0, 1e-9)
    # Two pixels.
    close((brace.PressurePlace1 - FreeCAD.Vector(*place)).Length, 0.0, 1.5)
    assert brace.isValid(), brace.getStatusString()
    close(brace.PressureComputed1.getValueAs("Torr").Value, 18.0, 0.2)
    assert labels(brace) == ["1: 18.0 mmHg"], labels(brace)
    assert document.UndoCount == steps + 1, document.UndoNames
    document.undo()
    wait(0.3)
    assert not hasattr(brace, "Pressure1") and labels(brace) == [], labels(brace)
    # Nothing asked for, nothing strained: the pattern follows without being told.
    close(brace.Width.Value, limbs.girth(), 0.01 * limbs.girth())
    document.redo()
    wait(0.3)
    assert labels(brace) == ["1: 18.0 mmHg"] and brace.isValid()
    assert brace.Width.Value < 0.9 * limbs.girth()


@check
def cancel_in_a_panel_takes_all_back():
    document, brace = one_brace()
    before = brace.Width.Value
    opened = panel("AddPressure")
    click(limbs.on_prism(FRONT, 50.0))
    assert hasattr(brace, "Pressure1")
    opened.reject()
    wait(0.2)
    assert not hasattr(brace, "Pressure1") and brace.Width.Value == before
    click(limbs.on_prism(FRONT, 50.0))
    assert not hasattr(brace, "Pressure1"), "the closed panel still hears clicks"


@check
def what_a_panel_breaks_is_said_when_it_is_closed():
    document, brace = one_brace()
    opened = panel("AddPressure")
    click(limbs.on_prism(FRONT, 50.0))
    type_into(opened.box(0), "150")
    with answering() as told:
        opened.accept()
        wait(0.2)
    assert "150 mmHg" in told[0] and "Pressure1" in told[0], told
    assert not brace.isValid() and document.Worn.Mesh.CountFacets == 0


@check
def closing_the_document_stops_its_job():
    document, brace = one_brace(Mesh.Mesh(str(SCRATCH / "large.obj")))
    opened = panel("Flatten")
    opened.fields["method"].set("diffusion")
    opened.start_button.click()
    wait(0.3)
    assert opened._job is not None
    FreeCAD.closeDocument(document.Name)
    wait_for(lambda: opened._job is None, "the end of the job", 10)
    if FreeCADGui.Control.activeDialog():
        FreeCADGui.Control.closeDialog()


@check
def a_click_beside_the_limb_is_no_pressure():
    _, brace = one_brace()
    opened = panel("AddPressure")
    click((90.0, 0.0, 20.0))
    click((0.0, -45.0, 130.0))
    assert opened.table.rowCount() == 0
    opened.reject()


@check
def orientation_seam_and_region_are_clicked():
    document, brace = one_brace()
    opened = panel("Orientation")
    click(limbs.on_prism(FRONT, 80.0))
    click(limbs.on_prism(FRONT, 30.0))
    opened.accept()
    assert len(brace.Orientation) == 2 and brace.Orientation[0].z > brace.Orientation[1].z
    assert brace.isValid(), brace.getStatusString()
    opened = panel("Seam")
    for height in (89.0, 45.0, 1.0):
        click(limbs.on_prism(FRONT + 0.4, height))
    click(limbs.on_prism(FRONT + 0.5, 20.0))
    opened.back()
    picture("seam")
    opened.accept()
    assert len(brace.Seam1) == 3, brace.Seam1
    assert brace.isValid(), brace.getStatusString()
    assert not any("automatic" in said for said in brace.Warnings), brace.Warnings
    opened = panel("Seam")
    opened.automatic()
    opened.accept()
    assert not hasattr(brace, "Seam1") and any("automatic" in said for said in brace.Warnings)
    opened = panel("Region")
    click(limbs.on_prism(FRONT, 80.0))
    click(limbs.on_prism(FRONT, 20.0))
    opened.accept()
    assert len(brace.RegionPlanes) == 2 and brace.isValid(), brace.getStatusString()
    close(brace.Height.Value, 60.0, 2.0)
    document.undo()
    wait(0.3)
    assert not brace.RegionPlanes
    close(brace.Height.Value, 90.0, 1.0)


@check
def flatten_shows_every_parameter_and_applies_them_in_one_step():
    document, brace = one_brace()
    steps = document.UndoCount
    opened = panel("Flatten")
    assert list(opened.fields) == [row.name for row in wovenfit.parameter_table()]
    for row in wovenfit.parameter_table():
        field = opened.fields[row.name]
        assert field.get() == row.default, row.name
        assert row.paragraph in field.widget.toolTip()
    opened.fields["curvature_radius"].set(14.0)
    opened.fields["equal_seams"].set(False)
    opened.start_button.click()
    wait_for(lambda: opened.stage.text().startswith("Done"), f"done: {opened.stage.text()}")
    assert brace.CurvatureRadius.Value == 14.0 and brace.EqualSeams is False
    close(brace.Proxy.pattern(brace).figures.curvature_radius_mm, 14.0, 1e-9)
    assert brace.State == ["Up-to-date"] and document.UndoCount == steps + 1
    picture("flatten")
    # What the library refuses is said, and changes nothing.
    opened.fields["units"].set("cm")
    opened.start_button.click()
    wait_for(lambda: "Units" in opened.stage.text(), "a refusal that names the property")
    assert brace.Units == "auto" and brace.State == ["Up-to-date"]
    opened.reject()
    document.undo()
    wait(0.3)
    assert brace.CurvatureRadius.Value == 10.0 and brace.EqualSeams is True and brace.isValid()


@check
def a_manual_brace_is_flattened_by_the_panel():
    document, brace = one_brace()
    brace.Automatic = False
    brace.FabricWarp = "0.7 N/mm"
    document.recompute()
    assert "out of date" in brace.getStatusString()
    opened = panel("Flatten")
    opened.start_button.click()
    wait_for(lambda: opened.stage.text().startswith("Done"), "done")
    opened.reject()
    assert brace.isValid() and document.Pattern.isValid() and not document.Pattern.Shape.isNull()


@check
def a_brace_copied_alone_gets_its_pattern_from_the_panel():
    document, brace = one_brace()
    twin = document.copyObject(brace, False)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(twin)
    assert twin.ViewObject.Proxy.claimChildren() == []
    opened = panel("Flatten")
    opened.start_button.click()
    wait_for(lambda: opened.stage.text().startswith("Done"), "done")
    opened.reject()
    pattern, worn = twin.ViewObject.Proxy.claimChildren()
    assert twin.isValid() and pattern.isValid() and worn.Mesh.CountFacets > 0
    assert brace.ViewObject.Proxy.claimChildren() == [document.Pattern, document.Worn]


@check
def progress_is_shown_and_cancel_changes_nothing():
    mesh = Mesh.Mesh(str(SCRATCH / "large.obj"))
    document, brace = one_brace(mesh)
    key, before = brace.ComputedFor, limbs.wires(document.Pattern)[0]
    opened = panel("Flatten")
    opened.fields["method"].set("diffusion")
    opened.start_button.click()
    seen = []

    def under_way() -> bool:
        seen.append((opened.bar.value(), opened.stage.text()))
        return len({value for value, _ in seen}) > 3 and "Fitting the fabric" in seen[-1][1]

    wait_for(under_way, "progress in the fit")
    assert not opened.start_button.isEnabled() and opened.cancel_button.isEnabled()
    values = [value for value, _ in seen]
    assert values == sorted(values), "progress runs backwards"
    picture("progress")
    started = time.monotonic()
    opened.cancel_button.click()
    wait_for(lambda: opened.stage.text().startswith("Cancelled"), "cancelled", 20)
    assert time.monotonic() - started < 10
    assert opened.start_button.isEnabled() and not opened.cancel_button.isEnabled()
    assert brace.ComputedFor == key and brace.Method == "newton" and brace.isValid()
    assert np.array_equal(limbs.wires(document.Pattern)[0], before)
    # Closing the panel stops a job, too.
    opened.start_button.click()
    wait(0.3)
    opened.reject()
    assert opened._job is None and FreeCADGui.Control.activeDialog() is False


@check
def a_replaced_mesh_recomputes_by_itself():
    document, brace = one_brace()
    document.Scan.Mesh = limbs.prism(radius=50.0)
    wait_for(lambda: brace.Width.Value > limbs.girth(50.0) * 0.99, "a new pattern", 10)
    assert brace.State == ["Up-to-date"]


@check
def the_report_and_the_files():
    document, brace = one_brace()
    opened = panel("AddPressure")
    click(limbs.on_prism(FRONT, 50.0))
    opened.accept()
    opened = panel("Report")
    said = brace.Proxy.pattern(brace).pressures[0]
    close(float(opened.table.item(0, 1).text()), 15.0, 0.05)
    close(float(opened.table.item(0, 2).text()), said.got_kpa / 0.133322, 0.06)
    assert brace.Warnings[0] in opened.warnings.toPlainText()
    page = opened.write_page()
    assert page.read_bytes() == brace.Proxy.pattern(brace).file("report.html")
    opened.reject()
    folder = SCRATCH / "by-command"
    asked = QtGui.QFileDialog.getExistingDirectory
    QtGui.QFileDialog.getExistingDirectory = staticmethod(lambda *_: str(folder))
    try:
        FreeCADGui.runCommand("Wovenfit_Export")
    finally:
        QtGui.QFileDialog.getExistingDirectory = asked
    assert {path.name for path in folder.iterdir()} == set(tools.file_names())
    # An invalid brace has no files: the reason is shown.
    brace.Pressure1 = "20 kPa"
    document.recompute()
    with answering() as told:
        FreeCADGui.runCommand("Wovenfit_Report")
    assert "is invalid" in told[0], told
    assert not document.Worn.VertexColors


@check
def colours_and_scale_follow_what_is_shown():
    document, brace = one_brace()
    import wovenfit_freecad as tools

    tools.add_pressure(brace, limbs.on_prism(2.0, 45.0), "2 kPa")
    document.recompute()
    worn = document.Worn
    for shown, unit in (("Strain along warp", ""), ("Pressure", "kPa")):
        worn.Show = shown
        document.recompute()
        assert worn.ViewObject.Coloring
        texts = scale_texts(worn)
        assert texts[-1] == f"{shown}, by the model" and len(texts) == 6, texts
        close(float(texts[4].split()[0]), worn.Most, 0.005)
        assert all(unit in text for text in texts[:5])
    worn.ViewObject.Visibility = False
    assert scale_texts(worn) == []


@check
def the_page_at_true_size_is_made_by_one_command():
    document, brace = one_brace()
    FreeCADGui.runCommand("Wovenfit_Page")
    wait(1.0)
    page = document.PatternPage
    assert page.Scale == 1.0 and page.Views[0].Scale == 1.0
    wait_for(lambda: len(page.Views[0].getVisibleEdges()) > 0, "a drawn view", 20)
    picture("page")
    document.undo()
    wait(0.2)
    assert document.getObject("PatternPage") is None


@check
def opened_again_it_looks_as_it_did():
    mesh, design = limbs.sample()
    document, brace = one_brace(mesh)
    import wovenfit_freecad as tools

    tools.apply_design(brace, design)
    brace.Label = "Elbow brace"
    document.recompute()
    # One that cannot be met: said in the label, in red.
    tools.add_pressure(brace, (-41.0, 0.3, 10.0), "11 kPa")
    document.recompute()
    if not brace.isValid():
        tools.remove_pressure(brace, "Pressure5")
        document.recompute()
    before = labels(brace)
    assert len(before) >= 6, before
    view().viewAxometric()
    view().fitAll()
    FreeCADGui.Selection.clearSelection()
    as_made = picture("elbow")
    document.saveAs(str(SCRATCH / "window.FCStd"))
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(str(SCRATCH / "window.FCStd"))
    wait(0.5)
    brace = document.Brace
    assert labels(brace) == before, (labels(brace), before)
    assert brace.ViewObject.Icon is not None and document.Worn.ViewObject.Coloring
    assert scale_texts(document.Worn)
    FreeCADGui.Selection.clearSelection()
    # Colours, labels and lines: all is drawn as before.
    assert unlike(picture("reopened"), as_made) < 0.01


@check
def made_in_the_console_it_is_dressed_when_opened_here():
    document = FreeCAD.openDocument(str(SCRATCH / "console.FCStd"))
    wait(0.5)
    from wovenfit_freecad.gui.view_brace import BraceView

    assert isinstance(document.Brace.ViewObject.Proxy, BraceView), document.Brace.ViewObject.Proxy
    assert labels(document.Brace) == ["1: 15.0 mmHg"], labels(document.Brace)
    assert document.Worn.ViewObject.Coloring and len(scale_texts(document.Worn)) == 6
    assert document.Brace.ViewObject.SwitchNode.whichChild.getValue() >= 0, (
        "the marks are not drawn"
    )
    view().viewIsometric()
    view().fitAll()
    picture("console")


@check
def deleting_a_brace_takes_what_shows_it():
    document, brace = one_brace()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(brace)
    # FreeCAD asks, since Pattern and Worn depend on it.
    asked = []

    def yes() -> None:
        box = QtGui.QApplication.activeModalWidget()
        if box is not None:
            asked.append(box.text())
            box.button(QtGui.QMessageBox.Yes).click()

    timer = QtCore.QTimer()
    timer.timeout.connect(yes)
    timer.start(200)
    FreeCADGui.runCommand("Std_Delete")
    timer.stop()
    wait(0.2)
    assert [obj.Name for obj in document.Objects] == ["Scan"]
    document.undo()
    wait(0.2)
    assert document.Pattern.Brace == document.Brace


def begin() -> None:
    """Once the window stands."""
    try:
        run_all()
    except BaseException:
        traceback.print_exc()
        os._exit(2)


TIMER = QtCore.QTimer()
TIMER.setSingleShot(True)
TIMER.timeout.connect(begin)
TIMER.start(1500)
