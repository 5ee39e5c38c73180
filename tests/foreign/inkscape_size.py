"""Asks Inkscape how large the cut line of a pattern's SVG is.

Usage: inkscape_size.py FOLDER DESIGN. Inkscape answers in pixels of 1/96 inch, with the line's width.
"""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import tempfile

from pattern_truth import Truth

folder, design = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
truth = Truth(folder, design)
with tempfile.TemporaryDirectory() as home:
    answer = subprocess.run(
        ["inkscape", "--query-all", folder / "pattern.svg"],
        check=True,
        capture_output=True,
        text=True,
        timeout=120,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "HOME": home, "XDG_CONFIG_HOME": home},
    ).stdout
objects = {}
for line in answer.splitlines():
    name, *numbers = line.split(",")
    if len(numbers) == 4:
        objects[name] = [25.4 / 96 * float(x) for x in numbers]
LINE = 0.3
for name, wanted in (
    ("outline", truth.cut),
    ("scale_box_100_by_50_mm", (100.0, 50.0)),
    ("scale_box_4_by_2_inch", (101.6, 50.8)),
):
    _, _, width, height = objects[name]
    truth.compare(f"{name}, width", width - LINE, wanted[0])
    truth.compare(f"{name}, height", height - LINE, wanted[1])
