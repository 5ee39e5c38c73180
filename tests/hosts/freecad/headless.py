"""What holds of the objects without a window: creation, recomputation, errors, undo, files."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, os.environ["TESTS"])

import FreeCAD
import limbs
import numpy as np
import Part
import wovenfit
import wovenfit_freecad as tools
from braces import STRAIN, is_nothing, is_right, on_prism
from harness import SCRATCH, check, close, refused, run_all


@check
def nothing_of_the_window_is_imported():
    assert not FreeCAD.GuiUp
    bad = [
        name for name in sys.modules if name.startswith(("wovenfit_freecad.gui", "PySide", "pivy"))
    ]
    assert not bad, bad
    assert "FreeCADGui" not in sys.modules


@check
def the_library_is_the_one_in_the_folder():
    from wovenfit.library import candidates

    assert Path(wovenfit.__file__).parent.parent.name == "Wovenfit", wovenfit.__file__
    assert candidates()[0].is_file(), candidates()


@check
def a_prism_is_as_wide_as_laplaces_law_says():
    document, brace, pattern, worn = on_prism()
    is_right(document, brace, STRAIN)
    close(brace.Height.Value, limbs.LENGTH, 0.01 * limbs.LENGTH)
    close(brace.PressureComputed1.getValueAs("kPa").Value, 2.0, 0.02)
    assert brace.AllPressuresMet
    assert worn.Mesh.CountPoints == len(worn.Values) == len(worn.VertexColors)
    close(float(np.median(worn.Values)), 2.0, 0.04)
    box = worn.Mesh.BoundBox
    close(box.ZLength, limbs.LENGTH, 1e-3)


@check
def the_shape_is_closed_wires_with_the_seams_edges_shared():
    _, brace, pattern, _ = on_prism()
    shape = pattern.Shape
    assert shape.ShapeType == "Compound"
    outline = shape.Wires[0]
    assert outline.isClosed() and outline.isValid()
    result = brace.Proxy.pattern(brace)
    seams = shape.Wires[1:3]
    for wire, length in zip(seams, (result.seams[0].left_mm, result.seams[0].right_mm)):
        close(wire.Length, length, 1e-9)
        assert all(any(e.isSame(o) for o in outline.Edges) for e in wire.Edges)
    # A cross of two lines, and the arrow.
    assert len(shape.Wires) == 1 + 2 + 2 + 1
    marks = 2 + 4
    assert len(shape.Edges) == len(outline.Edges) + marks
    assert Part.Face(outline).isValid()
    close(Part.Face(outline).Area, brace.Area.Value, 1e-6 * brace.Area.Value)
    pattern.Seams = pattern.Marks = False
    pattern.Document.recompute()
    assert [wire.isClosed() for wire in pattern.Shape.Wires] == [True]


@check
def the_marks_stand_on_their_places():
    _, brace, pattern, _ = on_prism()
    result = brace.Proxy.pattern(brace)
    shape = pattern.Shape.copy()
    shape.Placement = FreeCAD.Placement()
    across = shape.Wires[3].BoundBox.Center
    close(across.x, result.pressure_points[0, 0], 1e-9)
    close(across.y, result.pressure_points[0, 1], 1e-9)
    arrow = shape.Wires[5].OrderedVertexes
    close(arrow[0].X, arrow[1].X, 1e-3)
    assert arrow[1].Y > arrow[0].Y, "the arrow points to the end near the body, on top"


@check
def wires_are_the_command_lines_outline_for_the_same_buffers():
    document = FreeCAD.newDocument("Elbow")
    mesh, design = limbs.sample()
    scan = limbs.add_mesh(document, mesh)
    brace = tools.new_brace(document, scan)
    tools.apply_design(brace, design)
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    limbs.write_ply(SCRATCH / "same.ply", mesh)
    (SCRATCH / "same.json").write_text(tools.design_of(brace), encoding="utf-8")
    out = SCRATCH / "same"
    command = [os.environ["PROGRAM"], "flatten", str(SCRATCH / "same.ply"), "--quiet"]
    command += ["--design", str(SCRATCH / "same.json"), "--out", str(out)]
    command += ["--format", ",".join(tools.formats())]
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL)
    # flat.obj has the pattern's coordinates; its free edges are the outline.
    flat = np.array(
        [
            line.split()[1:3]
            for line in (out / "flat.obj").read_text().splitlines()
            if line[:2] == "v "
        ],
        float,
    )
    corners = limbs.wires(document.Pattern)[0]
    assert (corners[:, 2] == 0).all()
    # The file has six decimals or more: what it rounds is not the program's.
    for corner in corners[:, :2]:
        close(float(np.abs(flat - corner).max(axis=1).min()), 0.0, 1e-6)
    edges = boundary(out / "flat.obj")
    assert len(edges) == len(corners), (len(edges), len(corners))
    close(brace.Area.Value, limbs.report(out)["pattern"]["area_mm2"], 1e-6 * brace.Area.Value)
    # And the exported files are the command line's, byte for byte; the last page of a PDF says the
    # hash of the design's file, which there is none of in FreeCAD.
    for path in tools.export(brace, SCRATCH / "exported"):
        if path.suffix != ".pdf":
            assert without_hash(path) == without_hash(out / path.name), path.name
    assert tuple(sorted(tools.file_names())) == tuple(
        sorted(path.name for path in (SCRATCH / "exported").iterdir())
    )


def without_hash(path: Path) -> bytes:
    """A file's bytes; of the report without the row that says the design's hash."""
    if path.name != "report.html":
        return path.read_bytes()
    row = rb"SHA-256 of the design( file)?|\b[0-9a-f]{64}\b"
    bare, count = re.subn(row, b"", path.read_bytes())
    assert count == 2, count
    return bare


def boundary(obj: Path) -> list[tuple[int, int]]:
    """The edges of a mesh file that only one face has."""
    seen: dict[tuple[int, int], int] = {}
    for line in obj.read_text().splitlines():
        if line.startswith("f "):
            face = [int(part.split("/")[0]) for part in line.split()[1:]]
            for a, b in zip(face, face[1:] + face[:1]):
                edge = (min(a, b), max(a, b))
                seen[edge] = seen.get(edge, 0) + 1
    return [edge for edge, count in seen.items() if count == 1]


@check
def a_changed_pressure_changes_the_pattern_as_if_computed_anew():
    document, brace, pattern, _ = on_prism()
    brace.Pressure1 = "3 kPa"
    document.recompute()
    is_right(document, brace, 1.5 * STRAIN)
    fresh, other, again, _ = on_prism("3 kPa")
    assert np.array_equal(limbs.wires(pattern)[0], limbs.wires(again)[0])
    close(other.PressureComputed1.Value, 3.0, 0.03)


@check
def other_limbs_parameters_and_fabrics_change_it_too():
    document, brace, pattern, worn = on_prism()
    brace.FabricWarp = "1 N/mm"
    brace.FabricWeft = "1000 N/m"
    document.recompute()
    is_right(document, brace, STRAIN / 2)
    brace.CurvatureRadius = "12 mm"
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Proxy.pattern(brace).figures.curvature_radius_mm, 12.0, 1e-9)
    worn.Show = "Strain along warp"
    document.recompute()
    close(float(np.median(worn.Values)), STRAIN / 2, 0.002)


@check
def replacing_the_source_mesh_triggers_it():
    document, brace, pattern, _ = on_prism()
    before = brace.Width.Value
    document.Scan.Mesh = limbs.prism(radius=50.0)
    assert "Touched" in brace.State, brace.State
    # The pressure's place is now off the surface by 5 mm, which is taken.
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Width.Value, limbs.girth(50.0) / (1 + 2e-3 * 50 / 0.5), 0.01 * limbs.girth(50.0))
    assert brace.Width.Value > before + 10


@check
def what_cannot_be_makes_all_of_it_invalid_with_the_reason():
    document, brace, pattern, worn = on_prism()
    for spoil, words in (
        (lambda: setattr(brace, "Pressure1", "20 kPa"), "Pressure1` is 20"),
        (
            lambda: setattr(brace, "PressurePlace1", (0, 0, 500)),
            "Pressure1 at (0.0, 0.0, 500.0)",
        ),
        (lambda: setattr(brace, "CurvatureRadius", 100), "`CurvatureRadius` cannot be"),
        (lambda: setattr(brace, "FabricWarp", 0), "FabricWarp"),
        (lambda: setattr(brace, "Source", None), "no Source"),
    ):
        spoil()
        document.recompute()
        assert "Invalid" in brace.State, (words, brace.State)
        assert words in brace.getStatusString(), brace.getStatusString()
        assert brace.getStatusString() in pattern.getStatusString()
        assert brace.Width.Value == brace.PressureComputed1.Value == 0
        is_nothing(pattern, worn)
        refused(lambda: tools.export(brace, SCRATCH / "nothing"), "is invalid")
        assert not (SCRATCH / "nothing").exists()
        brace.Pressure1 = "2 kPa"
        brace.PressurePlace1 = limbs.on_prism(2.0, 45.0)
        brace.CurvatureRadius = "10 mm"
        brace.FabricWarp = "0.5 N/mm"
        brace.Source = document.Scan
        document.recompute()
        is_right(document, brace, STRAIN)
        assert pattern.isValid() and worn.isValid()


@check
def a_broken_mesh_is_named():
    document, brace, pattern, worn = on_prism()
    mesh = limbs.prism()
    # A vane on the tube: an edge with three facets.
    a, b, c = mesh.Facets[100].Points
    mesh.addFacet(*a, *b, 2 * a[0], 2 * a[1], a[2])
    document.Scan.Mesh = mesh
    document.recompute()
    assert "Invalid" in brace.State
    assert "edge" in brace.getStatusString(), brace.getStatusString()
    is_nothing(pattern, worn)


@check
def a_scan_in_metres_is_said_in_words_of_freecad():
    document, brace, pattern, worn = on_prism()
    document.Scan.Mesh = limbs.prism(radius=0.045, length=0.09)
    brace.PressurePlace1 = (0.045, 0.0, 0.045)
    document.recompute()
    said = " ".join([brace.getStatusString(), *brace.Warnings])
    assert "--" not in said, said
    assert "scale the mesh to mm" in said, said


@check
def what_the_library_names_is_named_as_properties_are():
    from wovenfit_freecad.words import in_words_of_the_host as told

    _, brace, _, _ = on_prism()
    tools.add_pressure(brace, limbs.on_prism(2.0, 20.0), "2 kPa")
    tools.add_pressure(brace, limbs.on_prism(2.0, 30.0), "2 kPa")
    tools.remove_pressure(brace, "Pressure1")
    for given, wanted in (
        ("raise newton-steps", "raise NewtonSteps"),
        ("set `keep_largest`, or `--close-holes`", "set `KeepLargest`, or `CloseHoles`"),
        ("`fabric.warp` is 0", "`FabricWarp` is 0"),
        ("`pressures[1].kpa` is 20", "`Pressure3` is 20"),
        ("thread of pressure 1 and 2 would", "thread of Pressure2 and Pressure3 would"),
        ("a pressure 5.3 kPa, pressure 12 mmHg", "a pressure 5.3 kPa, pressure 12 mmHg"),
        ("`orientation[1]` is", "`Orientation[1]` is"),
        ("set limits.max_kpa to 20", "set LimitsMaxPressure to 20"),
    ):
        assert told(brace, given) == wanted, told(brace, given)


@check
def not_automatic_means_marked_out_of_date_until_flattened():
    document, brace, pattern, worn = on_prism()
    brace.Automatic = False
    document.recompute()
    is_right(document, brace, STRAIN)
    brace.Pressure1 = "3 kPa"
    document.recompute()
    assert "out of date" in brace.getStatusString(), brace.getStatusString()
    is_nothing(pattern, worn)
    brace.Automatic = True
    document.recompute()
    is_right(document, brace, 1.5 * STRAIN)


@check
def saving_and_opening_keeps_all_without_computing_again():
    document, brace, pattern, _ = on_prism()
    tools.set_orientation(brace, limbs.on_prism(3.0, 80.0), limbs.on_prism(3.0, 10.0))
    tools.add_seam(
        brace, [limbs.on_prism(0.5, 90.0), limbs.on_prism(0.5, 45.0), limbs.on_prism(0.5, 0.0)]
    )
    brace.PieceName = "elbow"
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    before = limbs.wires(pattern)[0]
    key = brace.ComputedFor
    document.saveAs(str(SCRATCH / "saved.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(SCRATCH / "saved.FCStd"))
    brace, pattern = again.Brace, again.Pattern
    assert brace.ComputedFor == key
    assert np.array_equal(limbs.wires(pattern)[0], before)
    again.recompute()
    assert brace.State == ["Up-to-date"] and brace.ComputedFor == key
    assert not brace.Proxy.results._pattern, "it was computed again although nothing had changed"
    assert len(brace.Orientation) == 2 and len(brace.Seam1) == 3 and brace.PieceName == "elbow"
    close(brace.FabricWarp.getValueAs("N/mm").Value, 0.5, 1e-12)
    assert brace.FabricWarp.Unit == FreeCAD.Units.Unit("N/mm")
    # It is computed when it is asked for, and after a change.
    tools.export(brace, SCRATCH / "reopened")
    assert "elbow" in (SCRATCH / "reopened" / "report.json").read_text()
    brace.Pressure1 = "3 kPa"
    again.recompute()
    assert brace.isValid(), brace.getStatusString()
    assert not np.array_equal(limbs.wires(pattern)[0], before)
    again.Scan.Mesh = limbs.prism(radius=47.0)
    assert "Touched" in brace.State, "a source replaced after opening is not noticed"
    FreeCAD.closeDocument(again.Name)


@check
def what_was_saved_by_another_version_is_computed_again():
    document, brace, pattern, _ = on_prism()
    brace.setEditorMode("ComputedBy", 0)
    brace.ComputedBy = "0.0.0"
    document.saveAs(str(SCRATCH / "older.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(SCRATCH / "older.FCStd"))
    assert again.Brace.ComputedBy == "0.0.0"
    again.recompute()
    assert again.Brace.ComputedBy == wovenfit.version(), again.Brace.ComputedBy
    assert again.Brace.isValid() and again.Pattern.isValid()
    FreeCAD.closeDocument(again.Name)


@check
def an_invalid_brace_is_saved_empty_and_opened_invalid():
    document, brace, pattern, worn = on_prism()
    brace.Pressure1 = "20 kPa"
    document.recompute()
    document.saveAs(str(SCRATCH / "invalid.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(SCRATCH / "invalid.FCStd"))
    assert len(again.Pattern.Shape.Edges) == 2 and again.Worn.Mesh.CountFacets == 0
    again.recompute()
    assert "Invalid" in again.Brace.State
    is_nothing(again.Pattern, again.Worn)
    FreeCAD.closeDocument(again.Name)


@check
def a_copy_stands_alone():
    document, brace, pattern, worn = on_prism()
    copies = document.copyObject([brace, pattern, worn], False)
    other = next(obj for obj in copies if obj.Name.startswith("Brace"))
    twin = next(obj for obj in copies if obj.Name.startswith("Pattern"))
    document.recompute()
    assert twin.Brace == other and other.isValid(), other.getStatusString()
    other.Pressure1 = "3 kPa"
    document.recompute()
    is_right(document, brace, STRAIN)
    close(other.Width.Value, limbs.girth() / (1 + 1.5 * STRAIN), 0.01 * limbs.girth())
    close(twin.Shape.BoundBox.XLength, other.Width.Value, 1e-6)


@check
def every_edit_is_undone_and_done_again():
    document, brace, pattern, _ = on_prism()
    document.UndoMode = 1
    for title, edit in (
        ("pressure", lambda: tools.add_pressure(brace, limbs.on_prism(2.0, 20.0), "15 Torr")),
        ("remove", lambda: tools.remove_pressure(brace, "Pressure1")),
        (
            "orientation",
            lambda: tools.set_orientation(brace, limbs.on_prism(3.0, 80), limbs.on_prism(3.0, 10)),
        ),
        ("seam", lambda: tools.add_seam(brace, [limbs.on_prism(1.0, 90), limbs.on_prism(1.0, 0)])),
        ("region", lambda: tools.add_region_between(brace, (0, 0, 80), (0, 0, 10))),
    ):
        before = tools.design_of(brace), limbs.wires(pattern)[0]
        document.openTransaction(title)
        edit()
        document.recompute()
        document.commitTransaction()
        assert brace.isValid(), (title, brace.getStatusString())
        after = tools.design_of(brace), limbs.wires(pattern)[0]
        assert after[0] != before[0], title
        assert not np.array_equal(after[1], before[1]), title
        document.undo()
        document.recompute()
        assert tools.design_of(brace) == before[0], title
        assert np.array_equal(limbs.wires(pattern)[0], before[1]), title
        document.redo()
        document.recompute()
        assert tools.design_of(brace) == after[0], title
        assert np.array_equal(limbs.wires(pattern)[0], after[1]), title
        document.undo()
        document.recompute()
        is_right(document, brace, STRAIN)


@check
def a_removed_pressure_leaves_the_others_their_names():
    document, brace, _, _ = on_prism()
    second = tools.add_pressure(brace, limbs.on_prism(2.0, 20.0), "1.9 kPa")
    tools.remove_pressure(brace, "Pressure1")
    assert second == "Pressure2" and not hasattr(brace, "Pressure1")
    document.recompute()
    assert brace.isValid()
    close(brace.PressureComputed2.Value, 1.9, 0.02)
    # Removed by hand in the property editor.
    wide = brace.Width.Value
    tools.add_pressure(brace, limbs.on_prism(2.0, 70.0), "1 kPa")
    document.recompute()
    assert abs(brace.Width.Value - wide) > 1
    for name in ("Pressure3", "PressurePlace3", "PressureComputed3"):
        brace.removeProperty(name)
    document.recompute()
    close(brace.Width.Value, wide, 1e-9)
    brace.PressurePlace2 = (0, 0, 500)
    document.recompute()
    assert "Pressure2 at (0.0, 0.0, 500.0)" in brace.getStatusString(), brace.getStatusString()
    brace.removeProperty("PressurePlace2")
    document.recompute()
    assert "Pressure2 has no PressurePlace2" in brace.getStatusString(), brace.getStatusString()
    refused(lambda: tools.remove_pressure(brace, "Pressure7"), "has no Pressure7")


@check
def planes_bound_it_and_facets_too():
    document, brace, pattern, _ = on_prism()
    tools.add_region_between(brace, (0, 0, 80), (0, 0, 10))
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Height.Value, 70.0, 0.7)
    tools.clear_region(brace)
    assert not [obj for obj in document.Objects if obj.TypeId == "Part::Plane"]
    points, facets = limbs.arrays(document.Scan.Mesh)
    middle = points[facets].mean(axis=1)[:, 2]
    brace.RegionFacets = [int(i) for i in np.flatnonzero(middle < 60)]
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Height.Value, 60.0, 0.6)


@check
def files_have_at_most_some_500_lines():
    for path in Path(tools.__file__).parent.rglob("*.py"):
        assert len(path.read_text(encoding="utf-8").splitlines()) <= 500, path


run_all()
