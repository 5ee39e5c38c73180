"""Makes the README's pictures from a folder that `wovenfit demo` wrote.

Usage: pictures.py FOLDER, with chromium and Pillow. Pictures are kept below 200 kB each.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

folder = pathlib.Path(sys.argv[1])
docs = pathlib.Path(__file__).parent
LARGEST = 200_000


def shot(page, width, height, to):
    """The upper part of a page, in few colours."""
    with tempfile.TemporaryDirectory() as scratch:
        raw = pathlib.Path(scratch) / "shot.png"
        root = ["--no-sandbox"] if os.geteuid() == 0 else []
        command = ["chromium", "--headless", "--disable-gpu", "--hide-scrollbars", *root]
        command += ["--disable-background-networking", f"--user-data-dir={scratch}/profile"]
        command += [f"--window-size={width},{height}", f"--screenshot={raw}", page.as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        picture = Image.open(raw).convert("RGB")
        picture.quantize(224, dither=Image.Dither.NONE).save(docs / to, optimize=True)
    size = (docs / to).stat().st_size
    print(f"{to}: {size // 1000} kB")
    if size > LARGEST:
        sys.exit(f"{to} is larger than {LARGEST // 1000} kB")


shot((folder / "report.html").resolve(), 1100, 1560, "demo-report.png")
with tempfile.TemporaryDirectory() as scratch:
    frame = pathlib.Path(scratch) / "pattern.html"
    drawing = (folder / "pattern.svg").read_text().split("?>", 1)[1]
    frame.write_text(
        '<!DOCTYPE html><meta charset="utf-8">'
        "<style>body{margin:0} svg{width:800px;height:auto;display:block}</style>" + drawing
    )
    shot(frame, 800, 1010, "demo-pattern.png")
