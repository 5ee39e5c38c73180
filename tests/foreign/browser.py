"""What is judged of any page of ours in Debian's chromium: screenshots at two widths, and a print.

Needs chromium, poppler-utils and Pillow. Pictures are left beside the page, in the folder `browser`,
for people to look at.
"""

import html
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from PIL import Image

DESK, PHONE = 1280, 390
# A4 in points, and the narrowest margin in the page's print style (12 mm) less rounding.
A4 = (595.28, 841.89)
MARGIN = 32.0

failures = []


def expect(good, words):
    if not good:
        failures.append(words)


def end():
    if failures:
        sys.exit("\n".join(failures))


def run(*command):
    return subprocess.run(command, capture_output=True, check=True, text=True).stdout


def browser(*arguments):
    """Runs chromium without network habits and with a profile of its own."""
    with tempfile.TemporaryDirectory() as profile:
        command = [
            "chromium",
            "--headless",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            f"--user-data-dir={profile}",
        ]
        # Root has no sandbox.
        command += ["--no-sandbox"] if os.geteuid() == 0 else []
        done = subprocess.run([*command, *arguments], capture_output=True, timeout=180)
        if done.returncode != 0:
            sys.exit(f"chromium failed: {done.stderr.decode(errors='replace')[-2000:]}")
        return done.stdout.decode(errors="replace")


def measured(page, width):
    """Sizes of the page's elements at a width, from a copy that may run a script.

    The copy stands in a frame: a window of chromium is never narrower than 500 px.
    """
    script = """<script>
      addEventListener('load', () => {
        const wide = document.documentElement.clientWidth;
        const out = [...document.querySelectorAll('body *')]
          .filter(e => { const r = e.getBoundingClientRect();
                         return r.width > 0 && (r.right > wide + 0.5 || r.left < -0.5); })
          .map(e => e.tagName + '.' + (e.getAttribute('class') || ''));
        const small = [...document.querySelectorAll('svg text')]
          .map(e => e.getBoundingClientRect().height).filter(h => h > 0);
        const told = { wide, scroll: document.documentElement.scrollWidth,
                       high: document.documentElement.scrollHeight, out: out.slice(0, 9),
                       least: Math.min(...small) };
        parent.document.documentElement.setAttribute('data-told', JSON.stringify(told));
      });
    </script>"""
    text = page.read_text()
    copy, count = re.subn(r'<meta[^>]*Content-Security-Policy[^>]*/>', script, text)
    expect(count == 1, "the page has no content security policy")
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "frame.html"
        frame = f'<iframe style="border:0" width="{width}" height="900" srcdoc="{html.escape(copy)}">'
        file.write_text(f'<!DOCTYPE html><meta charset="utf-8"><body>{frame}</iframe></body>')
        dom = browser(
            "--window-size=1600,1200", "--virtual-time-budget=4000", "--dump-dom", file.as_uri()
        )
    told = re.search(r'<html[^>]*data-told="([^"]*)"', dom)
    if not told:
        sys.exit("the measuring script did not run")
    return json.loads(html.unescape(told.group(1)))


def ink(image):
    """Share of pixels that are not white, and the number of colours among them."""
    colours = image.convert("RGB").getcolors(1 << 24)
    white = sum(n for n, colour in colours if min(colour) > 250)
    return 1.0 - white / (image.width * image.height), len(colours)


def on_screens(page, pictures):
    """Screenshots at the width of a desk and of a phone."""
    for width, name in [(DESK, "desk"), (PHONE, "phone")]:
        told = measured(page, width)
        print(f"{name}: {told}")
        expect(told["wide"] == width, f"{name}: laid out {told['wide']} px wide, not {width}")
        expect(told["scroll"] <= width, f"{name}: {told['scroll']} px wide: it scrolls sideways")
        expect(not told["out"], f"{name}: outside the page: {told['out']}")
        # 8 px of box is lettering of some 7 px: the least that is still read.
        expect(told["least"] >= 8.0, f"{name}: lettering of {told['least']:.1f} px")
        shot = pictures / f"{name}.png"
        browser(f"--window-size={width},{told['high']}", f"--screenshot={shot}", page.as_uri())
        image = Image.open(shot)
        expect(image.width == width, f"{name}: the picture is {image.width} px wide")
        share, colours = ink(image)
        print(f"{name}: {100 * share:.1f} % inked, {colours} colours")
        expect(0.03 < share < 0.6 and colours > 100, f"{name}: blank or drowned")


def on_paper(page, pictures, least, most):
    """A print to PDF on A4, of `least` to `most` sheets; its words."""
    pdf = pictures / f"{page.stem}.pdf"
    browser("--no-pdf-header-footer", f"--print-to-pdf={pdf}", page.as_uri())
    info = run("pdfinfo", str(pdf))
    pages = int(re.search(r"Pages:\s+(\d+)", info).group(1))
    size = [float(x) for x in re.search(r"Page size:\s+([\d.]+) x ([\d.]+)", info).groups()]
    print(f"print: {pages} pages of {size}")
    expect(all(abs(a - b) < 1.0 for a, b in zip(size, A4)), f"print: pages of {size}, not A4")
    expect(least <= pages <= most, f"print: {pages} pages")

    boxes = run("pdftotext", "-bbox", str(pdf), "-")
    for left, right, word in re.findall(r'<word xMin="([\d.]+)".*?xMax="([\d.]+)".*?>(.*?)</word>', boxes):
        if float(left) < MARGIN or float(right) > A4[0] - MARGIN:
            failures.append(f"print: `{word}` runs into the margin ({left} to {right})")
    run("pdftoppm", "-r", "50", "-png", str(pdf), str(pictures / "print"))
    sheets = sorted(pictures.glob("print-*.png"))
    expect(len(sheets) == pages, f"print: {len(sheets)} sheets")
    for sheet in sheets:
        share, _ = ink(Image.open(sheet))
        expect(share > 0.01, f"{sheet.name} is blank")
    return " ".join(run("pdftotext", "-layout", str(pdf), "-").split())
