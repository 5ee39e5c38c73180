"""Export: byte for byte the command line's files; the report in a browser."""

import json
import os
import re
import stat
import subprocess
import webbrowser
from pathlib import Path

import bpy
import numpy as np
import scene

PROGRAM = os.environ["WOVENFIT_PROGRAM"]


def write_ply(path, positions, triangles):
    """A binary PLY file with exactly these 64-bit numbers."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(positions)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    faces = np.empty(len(triangles), np.dtype([("count", "u1"), ("corners", "<u4", 3)]))
    faces["count"] = 3
    faces["corners"] = triangles
    path.write_bytes(header.encode() + positions.astype("<f8").tobytes() + faces.tobytes())


def folder(name):
    """An empty folder of this run's own."""
    made = scene.SCRATCH / f"{name}-{bpy.app.version[0]}-{bpy.app.version[1]}"
    made.mkdir(parents=True, exist_ok=True)
    for one in made.iterdir():
        one.unlink()
    return made


def test_the_files_are_the_command_lines_byte_for_byte():
    limb = scene.pinned_arm()
    # Somewhere in the world, so that its matrix is at work.
    limb.location, limb.rotation_euler = (0.3, -0.2, 1.1), (0.4, 0.1, -0.7)
    bpy.context.view_layer.update()
    scene.flatten()
    ours, theirs = folder("ours"), folder("theirs")
    assert bpy.ops.wovenfit.export_all(directory=str(ours)) == {"FINISHED"}
    # The buffers, worked out here from what Blender has.
    triangles = np.array([list(face.vertices) for face in limb.data.polygons])
    places = scene.world(limb)
    write_ply(theirs / "limb.ply", places, triangles)
    rows = [
        {"at": places[one.mark.vertex].tolist(), "kpa": float(str(np.float32(one.kpa)))}
        for one in limb.wovenfit.pressures
    ]
    (theirs / "design.json").write_text(json.dumps({"units": "m", "pressures": rows}))
    subprocess.run(
        [
            *(PROGRAM, "flatten", theirs / "limb.ply", "--design", theirs / "design.json"),
            *("--out", theirs, "--quiet", "--format", ",".join(_formats())),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    names = {path.name for path in theirs.iterdir()} - {"limb.ply", "design.json"}
    assert len(names) >= 5 + len(_formats()) - 1
    assert {path.name for path in ours.iterdir()} == names
    # The last page of a PDF says the hash of the design's file, which there is none of in Blender.
    for name in sorted(name for name in names if not name.endswith(".pdf")):
        of_both = [_without_hash(path / name) for path in (ours, theirs)]
        assert of_both[0] == of_both[1], f"{name} differs"


def _formats():
    return [row.name for row in scene.addon("wovenfit").pattern_formats()]


def _without_hash(path):
    """A file's bytes; of the report without the row that says the design's hash."""
    if path.name != "report.html":
        return path.read_bytes()
    text = path.read_text(encoding="utf-8")
    bare, count = re.subn(r"SHA-256 of the design( file)?|\b[0-9a-f]{64}\b", "", text)
    assert count == 2, count
    return bare


def test_one_file_is_written_where_it_is_asked_for():
    scene.tube()
    pattern = scene.flatten().pattern
    into = folder("one")
    for name in scene.addon("wovenfit").FILES:
        path = into / f"my-{name}"
        done = bpy.ops.wovenfit.export_file(filepath=str(path), file=name)
        assert done == {"FINISHED"}
        assert path.read_bytes() == pattern.file(name)
    for row in scene.addon("wovenfit").pattern_formats():
        for unit in ("mm", "in"):
            path = into / f"{unit}-{row.file_name}"
            wish = {"filepath": str(path), "file": row.file_name, "unit": unit}
            assert bpy.ops.wovenfit.export_file(**wish) == {"FINISHED"}
            assert path.read_bytes() == pattern.export(row.name, unit)
    nowhere = into / "no such folder" / "pattern.svg"
    scene.refused(
        lambda: bpy.ops.wovenfit.export_file(filepath=str(nowhere), file="pattern.svg"),
        "cannot be written",
    )


def test_nothing_is_exported_before_there_is_a_pattern():
    scene.tube()
    assert not bpy.ops.wovenfit.export_all.poll()
    assert not bpy.ops.wovenfit.open_report.poll()


def test_the_report_opens_in_the_browser():
    scene.tube()
    pattern = scene.flatten().pattern
    into = folder("browser")
    browser, said = into / "browser.sh", into / "address"
    browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {said}\n')
    browser.chmod(browser.stat().st_mode | stat.S_IXUSR)
    former = webbrowser._tryorder
    webbrowser.register("test", None, webbrowser.GenericBrowser(str(browser)), preferred=True)
    try:
        assert bpy.ops.wovenfit.open_report() == {"FINISHED"}
    finally:
        webbrowser._tryorder = former
        webbrowser._browsers.pop("test")
    address = said.read_text()
    assert address.startswith("file:///"), address
    page = Path(address[len("file://") :])
    assert page.read_bytes() == pattern.file("report.html")
    page.unlink()
    page.parent.rmdir()
