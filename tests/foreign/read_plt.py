"""Reads the HPGL of a pattern with ezdxf's HPGL/2 reader, and the PNG with Pillow; measures both.

Usage: read_plt.py FOLDER DESIGN.
"""

from __future__ import annotations

import pathlib
import sys

import numpy
from ezdxf.addons.hpgl2 import api
from pattern_truth import Truth
from PIL import Image

folder, design = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
truth = Truth(folder, design)

print("pattern.plt")
drawing = api.to_dxf((folder / "pattern.plt").read_bytes(), rotation=0)
layers: dict[str, list[tuple[float, float]]] = {}
for entity in drawing.modelspace().query("LWPOLYLINE POLYLINE LINE"):
    if entity.dxftype() == "LINE":
        points = [entity.dxf.start, entity.dxf.end]
    else:
        points = list(entity.vertices_in_wcs() if hasattr(entity, "vertices_in_wcs") else entity.points())
    layers.setdefault(entity.dxf.layer, []).extend((p.x / 40, p.y / 40) for p in points)
print(f"  pens: {({name: len(points) for name, points in layers.items()})}")
cut = [points for name, points in layers.items() if name.rstrip().endswith("1")]
if len(cut) != 1 or len(layers) != 6:
    raise SystemExit(f"six pens are wanted, pen 1 among them: {list(layers)}")
xs, ys = zip(*cut[0])
truth.compare("cut line, width", max(xs) - min(xs), truth.cut[0])
truth.compare("cut line, height", max(ys) - min(ys), truth.cut[1])

print("pattern.png")
picture = Image.open(folder / "pattern.png")
density = picture.info["dpi"][0] / 25.4
dark = numpy.asarray(picture.convert("L")).astype(int) < 200
columns = numpy.nonzero(dark.any(axis=0))[0]
if not density > 1 or columns.size == 0:
    raise SystemExit("the preview is empty or states no size")
# A border of 10 mm, within a pixel.
truth.compare("border", columns[0] / density, 10.0, 1.5 / density)
