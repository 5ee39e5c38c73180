"""What a brace takes and gives beyond itself, without a window: spreadsheets, shapes and parts,
design files, and that TechDraw, Draft and Path take its pattern."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

sys.path.insert(0, os.environ["TESTS"])

import FreeCAD
import limbs
import numpy as np
import Part
import wovenfit
import wovenfit_freecad as tools
from braces import STRAIN, is_right, on_prism
from harness import SCRATCH, check, close, refused, run_all


@check
def a_spreadsheet_drives_a_pressure():
    document, brace, pattern, _ = on_prism()
    sheet = document.addObject("Spreadsheet::Sheet", "Sheet")
    sheet.set("A1", "=3 kPa")
    sheet.setAlias("A1", "wanted")
    document.recompute()
    brace.setExpression("Pressure1", "Sheet.wanted")
    brace.setExpression("FabricWarp", "Sheet.wanted / (3 kPa) * 0.5 N/mm")
    document.recompute()
    is_right(document, brace, 1.5 * STRAIN)
    sheet.set("A1", "=15 Torr")
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Pressure1.getValueAs("kPa").Value, 1.99983, 1e-4)
    close(brace.FabricWarp.getValueAs("N/mm").Value, 0.5 * 1.99983 / 3, 1e-5)


@check
def a_design_file_goes_in_and_comes_out():
    document, brace, _, _ = on_prism()
    design = {
        "units": "cm",
        "fabric": {"name": "net", "warp": 0.4, "weft": 0.3, "diagonal": 0.03, "weft_strain": 0.01},
        "pressures": [{"at": [-4.5, 0, 4.5], "mmhg": 15}],
        "orientation": [[0, 4.5, 8], [0, 4.5, 1]],
        "region": [{"point": [0, 0, 1], "normal": [0, 0, 2]}],
        "limits": {"max_kpa": 5, "bony": [[0, -4.5, 4]]},
        "piece": {"name": "cuff", "reference": "17"},
        "pressure_model": "paper",
        "facing": "outward",
    }
    tools.apply_design(brace, design)
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    here, there = (
        json.loads(wovenfit.Design.from_json(text, "mm").to_json())
        for text in (tools.design_of(brace), design)
    )
    # A plane is the same whichever of its points is named.
    (mine,), (given,) = here.pop("region"), there.pop("region")
    for plane in (mine, given):
        plane["normal"] = [x / np.linalg.norm(plane["normal"]) for x in plane["normal"]]
    assert np.allclose(mine["normal"], given["normal"], atol=1e-9)
    close(mine["point"][2], given["point"][2], 1e-9)
    assert here == there, here
    refused(lambda: tools.apply_design(brace, {"presures": []}), "presures")
    assert brace.PieceName == "cuff"


@check
def a_shape_is_tessellated_to_the_chosen_length():
    document = FreeCAD.newDocument("Shape")
    cylinder = document.addObject("Part::Cylinder", "Cylinder")
    cylinder.Radius, cylinder.Height = limbs.RADIUS, limbs.LENGTH
    document.recompute()
    brace = tools.new_brace(document, cylinder, ["Face1"])
    brace.EdgeLength = "6 mm"
    tools.add_pressure(brace, limbs.on_prism(2.0, 45.0), "2 kPa")
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Width.Value, 2 * np.pi * limbs.RADIUS / (1 + STRAIN), 0.01 * limbs.girth())
    close(brace.Height.Value, limbs.LENGTH, 0.01 * limbs.LENGTH)
    coarse = document.Worn.Mesh.CountFacets
    brace.EdgeLength = "12 mm"
    document.recompute()
    assert document.Worn.Mesh.CountFacets < 0.7 * coarse
    # The shape is parametric, too.
    cylinder.Radius = 40.0
    brace.PressurePlace1 = (-40.0, 0.0, 45.0)
    document.recompute()
    assert brace.isValid(), brace.getStatusString()
    close(brace.Width.Value, 2 * np.pi * 40 / (1 + 2e-3 * 40 / 0.5), 0.015 * limbs.girth())
    brace.Source = (cylinder, ["Face9"])
    document.recompute()
    assert "has no Face9" in brace.getStatusString(), brace.getStatusString()
    brace.EdgeLength = 0
    brace.Source = (cylinder, ["Face1"])
    document.recompute()
    assert "EdgeLength is 0" in brace.getStatusString(), brace.getStatusString()


@check
def a_moved_limb_in_a_moved_part_is_where_it_is_seen():
    document, brace, _, worn = on_prism()
    part = document.addObject("App::Part", "Leg")
    part.addObject(document.Scan)
    move = FreeCAD.Placement(
        FreeCAD.Vector(100, 0, 0), FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 90)
    )
    part.Placement = move
    document.Scan.Placement.Base = FreeCAD.Vector(0, 10, 0)
    place = FreeCAD.Vector(*limbs.on_prism(2.0, 45.0)) + FreeCAD.Vector(0, 10, 0)
    brace.PressurePlace1 = move.multVec(place)
    brace.touch()
    document.recompute()
    is_right(document, brace, STRAIN)
    close(worn.Mesh.BoundBox.Center.x, 100.0, 0.1)
    close(worn.Mesh.BoundBox.Center.z, 10.0, 0.1)


@check
def every_parameter_and_wish_is_a_property():
    _, brace, _, _ = on_prism()
    for row in wovenfit.parameter_table():
        name = "".join(part.capitalize() for part in row.name.split("_"))
        assert name in brace.PropertiesList, row.name
        assert row.paragraph in brace.getDocumentationOfProperty(name), row.name
    assert brace.getTypeIdOfProperty("Spacing") == "App::PropertyLength"
    assert brace.getTypeIdOfProperty("Pressure1") == "App::PropertyPressure"
    assert brace.getTypeIdOfProperty("LimitsMaxPressure") == "App::PropertyPressure"
    assert brace.FabricWarp.Unit == FreeCAD.Units.Unit("N/mm")


@check
def techdraw_shows_it_at_true_size():
    document, brace, pattern, _ = on_prism()
    page = tools.make_page(pattern)
    document.recompute()
    view = page.Views[0]
    shown = Part.Compound(view.getVisibleEdges())
    close(view.getScale() if hasattr(view, "getScale") else view.Scale, 1.0, 1e-12)
    close(shown.BoundBox.XLength, pattern.Shape.BoundBox.XLength, 0.01)
    close(shown.BoundBox.YLength, pattern.Shape.BoundBox.YLength, 0.01)
    assert page.Template.Width >= pattern.Shape.BoundBox.XLength + 30
    # No drawing shows a pattern that is no longer valid.
    count = len(view.getVisibleEdges())
    brace.Pressure1 = "20 kPa"
    document.recompute()
    assert len(view.getVisibleEdges()) == 2, "the page shows the earlier pattern"
    refused(lambda: tools.make_page(pattern), "is invalid or empty")
    brace.Pressure1 = "2 kPa"
    document.recompute()
    assert len(view.getVisibleEdges()) == count


@check
def draft_takes_it():
    import Draft

    document, brace, pattern, _ = on_prism()
    pattern.Seams = pattern.Marks = False
    document.recompute()
    (face,) = Draft.upgrade([pattern], delete=False)[0]
    document.recompute()
    close(face.Shape.Area, brace.Area.Value, 1e-6 * brace.Area.Value)
    clone = Draft.make_clone(pattern)
    document.recompute()
    close(clone.Shape.BoundBox.XLength, pattern.Shape.BoundBox.XLength, 1e-6)


@check
def path_cuts_along_it():
    import PathScripts.PathJob as PathJob
    import PathScripts.PathProfile as PathProfile

    document, brace, pattern, _ = on_prism()
    job = PathJob.Create("Job", [pattern], None)
    profile = PathProfile.Create("Profile")
    count = len(pattern.Shape.Wires[0].Edges)
    model = job.Model.Group[0]
    profile.Base = [(model, [f"Edge{k + 1}" for k in range(count)])]
    profile.UseComp = False
    document.recompute()
    cut = sum_of_cuts(profile.Path)
    outline = pattern.Shape.Wires[0].Length
    close(cut, outline, 0.01 * outline)


def sum_of_cuts(path) -> float:
    """Length of the longest level of a tool's way, in mm."""
    levels: dict[float, float] = {}
    x = y = z = 0.0
    for command in path.Commands:
        a = command.Parameters.get("X", x), command.Parameters.get("Y", y)
        z = command.Parameters.get("Z", z)
        if command.Name == "G1":
            levels[z] = levels.get(z, 0.0) + float(np.hypot(a[0] - x, a[1] - y))
        x, y = a
    return max(levels.values(), default=0.0)


@check
def the_add_on_manager_reads_what_it_is():
    folder = Path(tools.__file__).parent.parent
    described = FreeCAD.Metadata(str(folder / "package.xml"))
    assert described.Name == "Wovenfit"
    assert described.Version == wovenfit.version(), described.Version
    (bench,) = described.Content["workbench"]
    assert f"class {bench.Classname}(" in (folder / "InitGui.py").read_text(encoding="utf-8")
    assert (folder / described.Icon).is_file()
    assert described.License[0]["name"] == "MIT"
    assert (folder / "LICENSE-MIT").is_file() and (folder / "LICENSE-APACHE").is_file()


@check
def a_document_for_the_window_is_made():
    document, brace, _, _ = on_prism()
    document.saveAs(str(SCRATCH / "console.FCStd"))
    assert (SCRATCH / "console.FCStd").is_file()


run_all()
