"""Patterns for many scans without a window.

    SCANS="left.ply right.stl" DESIGN=brace.json OUT=patterns freecadcmd batch.py

Each scan is flattened with the same design file. For each a folder in OUT has the files of the
library and the FreeCAD document, to be opened and changed in the window. Coordinates are in mm.
`freecadcmd` would open words after the script as documents, so that they are given as variables.
The last line says how many failed; the exit code is 1 if any did.
"""

import os
import sys
import traceback
from pathlib import Path

import FreeCAD
import Mesh
import wovenfit_freecad as tools


def flatten(scan: Path, design: str, out: Path) -> None:
    """One scan; raises what is wrong."""
    document = FreeCAD.newDocument(scan.stem)
    try:
        limb = document.addObject("Mesh::Feature", "Scan")
        limb.Mesh = Mesh.Mesh(str(scan))
        brace = tools.new_brace(document, limb, label=scan.stem)
        tools.apply_design(brace, design)
        document.recompute()
        if not brace.isValid():
            raise ValueError(brace.getStatusString())
        tools.export(brace, out)
        document.saveAs(str(out / f"{scan.stem}.FCStd"))
        met = "all pressures met" if brace.AllPressuresMet else "NOT all pressures met"
        print(f"{scan.name}: {brace.Width.Value:.1f} mm by {brace.Height.Value:.1f} mm, {met}")
        for said in brace.Warnings:
            print(f"  {said}")
    finally:
        FreeCAD.closeDocument(document.Name)


def main() -> int:
    """All scans; how many failed."""
    scans = [Path(name).resolve() for name in os.environ["SCANS"].split()]
    design = Path(os.environ["DESIGN"]).read_text(encoding="utf-8")
    out = Path(os.environ["OUT"]).resolve()
    failed = 0
    for scan in scans:
        try:
            flatten(scan, design, out / scan.stem)
        except Exception as error:
            failed += 1
            print(f"{scan.name}: FAILED: {error}")
    print(f"{len(scans) - failed} flattened, {failed} failed")
    return failed


# FreeCAD ends well whatever a script raises.
try:
    code = 1 if main() else 0
except BaseException:
    traceback.print_exc()
    code = 1
sys.stdout.flush()
os._exit(code)
