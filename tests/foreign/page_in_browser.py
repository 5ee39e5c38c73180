"""Opens a report page in Debian's chromium and looks at what comes out.

Usage: page_in_browser.py FOLDER, one that `wovenfit flatten` wrote. See browser.py for what is looked
at on any page; here, that the print says what the report says.
"""

import json
import pathlib
import re
import sys

from browser import end, expect, on_paper, on_screens

folder = pathlib.Path(sys.argv[1])
page = (folder / "report.html").resolve()
report = json.loads((folder / "report.json").read_text())
pictures = folder / "browser"
pictures.mkdir(exist_ok=True)

on_screens(page, pictures)
said = on_paper(page, pictures, 2, 6)
wanted = [
    "wanted",
    "computed (not measured)",
    "mmHg",
    "kPa",
    "From the front",
    "From the right",
    "From the back",
    "From the left",
    "Colour scale cividis",
    "near the body",
    "E_SSD",
    "reduction",
    report["fabric"]["name"],
    "not a medical verification",
    *(f"{p['asked_mmhg']:.1f}" for p in report["pressures"]),
    *(f"{p['got_kpa']:.2f}" for p in report["pressures"]),
]
for words in wanted:
    expect(words in said, f"print: `{words}` is missing")
numbers = [float(word) for word in said.split() if re.fullmatch(r"\d+\.\d", word)]
for girth in (entry["girth_mm"] for entry in report["surface"]["girths"]):
    expect(any(abs(n - girth) < 0.1 for n in numbers), f"print: the girth {girth} is missing")
squeezed = said.replace(" ", "")
for warning in report["warnings"]:
    # Lines break anywhere.
    start = "".join(warning["message"].split())[:40]
    expect(start in squeezed, f"print: the warning `{start}…` is missing")

end()
