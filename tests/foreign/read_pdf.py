"""Renders the PDF files of a pattern (pdftoppm, 300 dpi) and measures boxes and outline on the pixels.

Usage: read_pdf.py FOLDER DESIGN. pdfinfo tells the pages' sizes.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys
import tempfile

import numpy
from pattern_truth import Truth
from PIL import Image

Image.MAX_IMAGE_PIXELS = None
DPI = 300
MM = 25.4 / DPI

folder, design = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
truth = Truth(folder, design)


def pages(name: str) -> list[tuple[float, float]]:
    """The sizes of a file's pages in mm, by pdfinfo."""
    command = ["pdfinfo", "-l", "999", folder / name]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    sizes = re.findall(r"Page +\d+ size: +([\d.]+) x ([\d.]+) pts", text)
    return [(float(w) * 25.4 / 72, float(h) * 25.4 / 72) for w, h in sizes]


def rendered(name: str, page: int) -> numpy.ndarray:
    """A page as red, green, blue."""
    with tempfile.TemporaryDirectory() as work:
        target = pathlib.Path(work) / "page"
        command = ["pdftoppm", "-r", str(DPI), "-f", str(page), "-l", str(page), "-singlefile"]
        subprocess.run([*command, folder / name, target], check=True)
        return numpy.asarray(Image.open(target.with_suffix(".ppm")).convert("RGB")).astype(int)


def ink(picture: numpy.ndarray) -> numpy.ndarray:
    """How much of each pixel is black, from 0 to 1: cut lines, boxes and words, no coloured lines."""
    return numpy.clip((150 - picture.max(axis=2)) / 150, 0.0, 1.0)


def lines(profile: numpy.ndarray) -> list[float]:
    """The middles of the lines that a row of pixels crosses, in mm: what is inked, weighed by how much."""
    padded = numpy.concatenate([[False], profile > 0.1, [False]])
    steps = numpy.flatnonzero(padded[1:] != padded[:-1])
    found = []
    for first, end in zip(steps[::2], steps[1::2]):
        weights = profile[first:end]
        found.append((float((weights * numpy.arange(first, end)).sum() / weights.sum()) + 0.5) * MM)
    return found


def extent(part: numpy.ndarray) -> tuple[float, float]:
    """Width and height in mm of a rectangle of lines, from middle to middle of the outermost: the
    median over the middle half of its rows and columns."""
    rows, columns = (numpy.flatnonzero((part > 0.5).any(axis=k)) for k in (1, 0))
    sides = []
    for across, along in ((part, rows), (part.T, columns)):
        quarter = len(along) // 4
        spans = []
        for k in along[quarter:-quarter]:
            crossed = lines(across[k])
            if len(crossed) > 1:
                spans.append(crossed[-1] - crossed[0])
        sides.append(float(numpy.median(spans)))
    return sides[0], sides[1]


def boxes(part: numpy.ndarray, what: str) -> int:
    """Measures the two boxes on a page; gives the row of their upper edge."""
    # Level lines of the boxes are the only black ones that go on for 90 to 110 mm.
    found = []
    for row in range(part.shape[0]):
        padded = numpy.concatenate([[False], part[row] > 0.5, [False]])
        steps = numpy.flatnonzero(padded[1:] != padded[:-1])
        for first, end in zip(steps[::2], steps[1::2]):
            if 99 < (end - first) * MM < 103:
                found.append((row, int(first), int(end)))
    if not found:
        raise SystemExit(f"{what}: there are no boxes")
    top, bottom = found[0][0], found[-1][0]
    left, right = min(f for _, f, _ in found), max(e for _, _, e in found)
    edge = round(3 / MM)
    window = part[top - edge : bottom + edge, left - edge : right + edge]
    # A tenth inside the boxes, where no words are.
    level = window[edge + (bottom - top) // 10]
    upright = window[:, edge + (right - left) // 20]
    for name, profile, outer, inner in (
        ("width", level, 101.6, 100.0),
        ("height", upright, 50.8, 50.0),
    ):
        crossed = lines(profile)
        if len(crossed) != 4:
            raise SystemExit(f"{what}, {name}: {len(crossed)} lines of boxes, 4 are wanted")
        truth.compare(f"{what}, outer box, {name}", crossed[3] - crossed[0], outer)
        truth.compare(f"{what}, inner box, {name}", crossed[2] - crossed[1], inner)
    return top


print("pattern.pdf")
whole = pages("pattern.pdf")
picture = rendered("pattern.pdf", 1)
truth.compare("page, width", picture.shape[1] * MM, whole[0][0])
page = ink(picture)
above = boxes(page, "sheet")
# What is cut is all that is black above the boxes and the title.
width, height = extent(page[: above - round(5 / MM)])
truth.compare("cut line, width", width, truth.cut[0])
truth.compare("cut line, height", height, truth.cut[1])
for size in whole[1:]:
    truth.compare("workshop sheet, width", size[0], 210.0)

for name, paper in (("pattern-a4.pdf", (210.0, 297.0)), ("pattern-letter.pdf", (215.9, 279.4))):
    print(name)
    tiles = pages(name)
    for size in tiles:
        if abs(size[0] - paper[0]) > 0.1 or abs(size[1] - paper[1]) > 0.1:
            raise SystemExit(f"{name}: a page is {size} mm")
    boxes(ink(rendered(name, 1)), "overview")
    text = subprocess.run(["pdftotext", "-layout", folder / name, "-"], check=True,
                          capture_output=True, text=True).stdout
    named = re.findall(r"row (\d+) of (\d+), column (\d+) of (\d+); page (\d+) of (\d+)", text)
    rows, columns, count = int(named[0][1]), int(named[0][3]), int(named[0][5])
    if len(named) != count:
        raise SystemExit(f"{name}: {len(named)} of {count} pages are named")
    # The tiles joined as their overlap says: 10 mm border, 8 mm foot, 15 mm overlap.
    window = (paper[0] - 20, paper[1] - 28)
    pixel = [round(x / MM) for x in window]
    step = [window[0] - 15, window[1] - 15]
    size = [round((step[k] * (n - 1) + window[k]) / MM) + 2 for k, n in ((0, columns), (1, rows))]
    joined = numpy.zeros((size[1], size[0]))
    for row, _, column, _, page, _ in named:
        picture = ink(rendered(name, int(page) + 1))
        top, left = round(10 / MM), round(10 / MM)
        part = picture[top : top + pixel[1], left : left + pixel[0]]
        y, x = round(step[1] * (int(row) - 1) / MM), round(step[0] * (int(column) - 1) / MM)
        place = joined[y : y + part.shape[0], x : x + part.shape[1]]
        numpy.maximum(place, part, out=place)
    above = boxes(joined, "joined tiles")
    width, height = extent(joined[: above - round(5 / MM)])
    truth.compare("joined cut line, width", width, truth.cut[0])
    truth.compare("joined cut line, height", height, truth.cut[1])

text = subprocess.run(["pdftotext", "-layout", folder / "pattern.pdf", "-"], check=True,
                      capture_output=True, text=True).stdout
for wanted in ("workshop sheet", "Stretch when worn", "Putting it on", "SHA-256 of the design file",
               "computed, not measured", "Curvature read over a radius", "Girths", "power weave"):
    if wanted not in text:
        raise SystemExit(f"the workshop sheet does not say `{wanted}`")
digest = subprocess.run(["sha256sum", design], check=True, capture_output=True, text=True).stdout
if digest.split()[0] not in re.sub(r"\s+", "", text):
    raise SystemExit("the workshop sheet's hash is not that of the design file")
