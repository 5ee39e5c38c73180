"""Writes a cylinder of radius 40 mm and 150 mm long as OBJ, and a design with allowances for it.

Usage: cylinder.py FOLDER. Its pattern is a rectangle: every size is known.
"""

import json
import math
import pathlib
import sys

SIDES, ROWS, RADIUS, LENGTH = 72, 40, 40.0, 150.0

folder = pathlib.Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)
lines = []
for row in range(ROWS + 1):
    for side in range(SIDES):
        angle = math.tau * side / SIDES
        x, y = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
        lines.append(f"v {x:.9f} {y:.9f} {LENGTH * row / ROWS:.9f}")
for row in range(ROWS):
    for side in range(SIDES):
        a, b = row * SIDES + side + 1, row * SIDES + (side + 1) % SIDES + 1
        lines.append(f"f {a} {b} {b + SIDES}")
        lines.append(f"f {a} {b + SIDES} {a + SIDES}")
(folder / "limb.obj").write_text("\n".join(lines) + "\n")
design = {
    "units": "mm",
    "fabric": {"name": "weave", "warp": 0.5, "weft": 0.5, "diagonal": 0.05},
    "pressures": [{"at": [-RADIUS, 0, 50], "kpa": 2}, {"at": [-RADIUS, 0, 100], "kpa": 2}],
    "orientation": [[-RADIUS, 0, 140], [-RADIUS, 0, 10]],
    "seams": [[[RADIUS, 0, 0], [RADIUS, 0, LENGTH]]],
    "piece": {
        "name": "Ärmel",
        "reference": "job 17",
        "date": "26-11-2026",
        "quantity": 2,
        "material": "power weave",
        "seam_allowance_mm": 9,
        "top_allowance_mm": 21,
        "bottom_allowance_mm": 14,
    },
}
(folder / "design.json").write_text(json.dumps(design, ensure_ascii=False), encoding="utf-8")
