"""Opens the page of the paper's examples in Debian's chromium and looks at what comes out.

Usage: paper_in_browser.py FOLDER, one that `wovenfit paper` wrote. See browser.py for what is looked
at on any page; here, that every figure and every finding is on the print.
"""

import json
import pathlib
import sys

from browser import end, expect, on_paper, on_screens

folder = pathlib.Path(sys.argv[1])
page = (folder / "paper.html").resolve()
paper = json.loads((folder / "paper.json").read_text())
pictures = folder / "browser"
pictures.mkdir(exist_ok=True)

on_screens(page, pictures)
said = on_paper(page, pictures, 8, 20)
squeezed = said.replace(" ", "")

for figure in [2, 7, 8, 9, 10, 11, 12, 13, 14]:
    expect(f"Fig. {figure}:" in said, f"print: Fig. {figure} is missing")
for claim in paper["claims"]:
    # Lines break anywhere.
    for words in [claim["paper"], claim["here"]]:
        start = "".join(words.split())[:40]
        expect(start in squeezed, f"print: `{start}\u2026` is missing")
for words in ["Colour scale cividis", "Warp strain in %", "E_SSD", "not a medical verification"]:
    expect(words in said, f"print: `{words}` is missing")

end()
