"""Reads a pattern with a foreign SVG reader (svgelements) and compares its size with the report.

Usage: read_svg.py FOLDER, one that `wovenfit flatten` wrote without allowances. The reader has 96
pixels to the inch as CSS does, so a drawing in pixels or with a scaled view comes out at another
size.
"""

import json
import pathlib
import sys

import svgelements

MM_PER_PIXEL = 25.4 / 96.0

folder = pathlib.Path(sys.argv[1])
wanted = json.loads((folder / "report.json").read_text())["pattern"]
drawing = svgelements.SVG.parse(folder / "pattern.svg", ppi=96.0)
cut = [
    element
    for element in drawing.elements()
    if isinstance(element, svgelements.Group) and str(element.id or "").startswith("cut")
]
if len(cut) != 1:
    sys.exit(f"{len(cut)} groups are named cut…, 1 is needed")
left, top, right, bottom = (MM_PER_PIXEL * x for x in cut[0].bbox(with_stroke=False))
for name, got in (("width_mm", right - left), ("height_mm", bottom - top)):
    gap = abs(got - wanted[name])
    print(f"{name}: {got:.3f} read, {wanted[name]:.3f} reported")
    if not gap < 0.1:
        sys.exit(f"{name} differs by {gap:.3f} mm")
