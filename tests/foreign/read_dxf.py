"""Reads the DXF files of a pattern with ezdxf: audits them, and compares layers, blocks and sizes.

Usage: read_dxf.py FOLDER DESIGN UNIT, UNIT mm or in, as the files were written.
"""

from __future__ import annotations

import pathlib
import sys

import ezdxf
from ezdxf.lldxf.encoding import decode_dxf_unicode
from pattern_truth import Truth, bounds

folder, design, unit = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
truth = Truth(folder, design)
MM = {"mm": 1.0, "in": 25.4}[unit]


def need(holds: bool, what: str) -> None:
    """Ends the program unless something holds."""
    if not holds:
        raise SystemExit(what)


def audited(name: str) -> ezdxf.document.Drawing:
    """A file without a single error or repair."""
    drawing = ezdxf.readfile(folder / name)
    audit = drawing.audit()
    need(not audit.errors, f"{name}: {[e.message for e in audit.errors]}")
    need(not audit.fixes, f"{name} needs repair: {[e.message for e in audit.fixes]}")
    (folder / name).read_bytes().decode("ascii")
    return drawing


def corners(entity: ezdxf.entities.DXFEntity) -> list[tuple[float, float]]:
    """The corners of a polyline in mm."""
    if entity.dxftype() == "LWPOLYLINE":
        return [(MM * x, MM * y) for x, y in entity.get_points("xy")]
    if entity.dxftype() == "LINE":
        ends = entity.dxf.start, entity.dxf.end
        return [(MM * p.x, MM * p.y) for p in ends]
    return [(MM * p.x, MM * p.y) for p in entity.points()]


def sizes(what: str, got: tuple[float, float], wanted: tuple[float, float]) -> None:
    """Compares width and height."""
    truth.compare(f"{what}, width", got[0], wanted[0])
    truth.compare(f"{what}, height", got[1], wanted[1])


def plain() -> None:
    """pattern.dxf"""
    print("pattern.dxf")
    drawing = audited("pattern.dxf")
    need(drawing.dxfversion == "AC1015", "pattern.dxf is not R2000")
    need(drawing.header["$INSUNITS"] == {"mm": 4, "in": 1}[unit], "pattern.dxf: $INSUNITS")
    need(drawing.header["$MEASUREMENT"] == {"mm": 1, "in": 0}[unit], "pattern.dxf: $MEASUREMENT")
    model = drawing.modelspace()
    outlines = [e for e in model.query("LWPOLYLINE") if e.dxf.layer == "CUT_LINE"]
    need(len(outlines) == 1 and outlines[0].closed, "pattern.dxf: one closed cut line is wanted")
    sizes("cut line", bounds(corners(outlines[0])), truth.cut)
    sewn = [p for e in model.query("LWPOLYLINE") if e.dxf.layer == "SEW_LINE" for p in corners(e)]
    # The sew lines of the sides go on to the cut edges.
    sizes("sew lines", bounds(sewn), (truth.sewn[0], truth.cut[1]))
    boxes = [e for e in model.query("LWPOLYLINE LINE") if e.dxf.layer == "SCALE"]
    sizes("outer box", bounds([p for e in boxes for p in corners(e)]), (101.6, 50.8))
    for layer in ("NOTCHES", "GRAIN", "STRETCH", "MARKS", "TEXT"):
        need(any(e.dxf.layer == layer for e in model), f"pattern.dxf: nothing on {layer}")
    need(not any(e.dxf.layer == "0" for e in model), "pattern.dxf: something is on layer 0")
    texts = [decode_dxf_unicode(e.dxf.text) for e in model.query("TEXT")]
    need(truth.piece["name"] in texts, f"the name is not among {texts}")


def apparel(name: str, version: str) -> None:
    """An ASTM file."""
    print(name)
    drawing = audited(name)
    raw = (folder / name).read_text(encoding="ascii")
    if version == "AC1009":
        start = "  0\nSECTION\n  2\nHEADER\n  0\nENDSEC\n"
        need(raw.startswith(start), f"{name}: the header is not empty")
        need("TABLES" not in raw and "Model_Space" not in raw, f"{name}: has tables or layouts")
    else:
        need(f"$ACADVER\n  1\n{version}\n" in raw, f"{name}: is not {version}")
    need("LWPOLYLINE" not in raw, f"{name}: has a polyline newer than its release")
    pieces = [block for block in drawing.blocks if not block.name.startswith(("*", "_", "$"))]
    need([block.name for block in pieces] == ["AERMEL"], f"{name}: blocks {pieces}")
    inserts = [e.dxf.name for e in drawing.modelspace().query("INSERT")]
    need(inserts == ["AERMEL"], f"{name}: inserted are {inserts}")
    block = pieces[0]
    layers: dict[str, list] = {}
    for entity in block:
        layers.setdefault(entity.dxf.layer, []).append(entity)
    known = {"1", "2", "3", "4", "7", "8", "13", "14", "15", "84", "85", "87"}
    need(set(layers) == known, f"{name}: layers {sorted(layers)}")
    outlines = [e for e in layers["1"] if e.dxftype() == "POLYLINE"]
    need(len(outlines) == 1 and outlines[0].is_closed, f"{name}: one closed boundary is wanted")
    sizes("boundary", bounds(corners(outlines[0])), truth.cut)
    need(corners(layers["84"][0]) == corners(outlines[0]), f"{name}: layer 84 is no copy of 1")
    sewn = [p for e in layers["14"] for p in corners(e)]
    sizes("sew lines", bounds(sewn), (truth.sewn[0], truth.cut[1]))
    # Every corner of the boundary is a turn point or a curve point.
    marked = {(round(MM * e.dxf.location.x, 2), round(MM * e.dxf.location.y, 2))
              for layer in ("2", "3") for e in layers[layer]}
    for x, y in corners(outlines[0]):
        need((round(x, 2), round(y, 2)) in marked, f"{name}: ({x}, {y}) is no point of 2 or 3")
    # A slit begins on the cut line, 9 mm outside the sew line, and goes inward for half of that.
    low = min(x for x, _ in corners(outlines[0]))
    high = max(x for x, _ in corners(outlines[0]))
    slits = [(MM * e.dxf.location.x, MM * e.dxf.location.y, MM * e.dxf.thickness) for e in layers["4"]]
    left = sorted(y for x, y, _ in slits if abs(x - low) < 0.1)
    right = sorted(y for x, y, _ in slits if abs(x - high) < 0.1)
    need(len(slits) == len(left) + len(right) and len(left) > 2, f"{name}: notches {slits}")
    for one, other in zip(left, right):
        truth.compare("notches of both sides differ by", one - other, 0.0)
    need(all(abs(depth - 4.0) < 1e-3 for *_, depth in slits), f"{name}: depths {slits}")
    grain = [e for e in layers["7"] if e.dxftype() == "LINE"]
    need(len(grain) == 1 and abs(grain[0].dxf.start.x - grain[0].dxf.end.x) < 1e-6, f"{name}: grain")
    need(len(layers["13"]) == 2, f"{name}: {len(layers['13'])} drill holes")
    system = [e.dxf.text for e in layers["1"] if e.dxftype() == "TEXT"]
    for wanted in ("Piece Name: Aermel", "Quantity: 2,0", "Material: power weave"):
        need(wanted in system, f"{name}: no `{wanted}` among {system}")
    style = [e.dxf.text for e in drawing.modelspace().query("TEXT") if e.dxf.layer == "1"]
    units = {"mm": "METRIC", "in": "ENGLISH"}[unit]
    for wanted in ("Style Name: Aermel", "Creation Date: 26-11-2026", f"Units: {units}"):
        need(wanted in style, f"{name}: no `{wanted}` among {style}")


plain()
apparel("pattern-astm.dxf", "AC1012")
apparel("pattern-gerber.dxf", "AC1009")
