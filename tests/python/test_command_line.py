"""The package's files are the command line's, byte for byte, and are written as it writes them."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import wovenfit
from limbs import arm, tube, write_ply
from wovenfit import files

DESIGNS = {
    "tube": {
        "units": "mm",
        "fabric": {"name": "weave", "warp": 0.5, "weft": 0.4, "diagonal": 0.05},
        "pressures": [{"at": [0.0, 45.0, 45.0], "kpa": 2.0}],
        "piece": {"name": "sleeve – Ärmel", "reference": "17"},
    },
    "arm": {
        "units": "mm",
        "pressures": [
            {"at": [255 + 42.0, 0.0, -30.0], "mmhg": 15},
            {"at": [170.0, 0.0, -120.0], "kpa": 1.5},
        ],
    },
}


@pytest.mark.parametrize("name", DESIGNS)
def test_every_file_is_the_command_lines(name: str, program: Path, tmp_path: Path) -> None:
    if name == "tube":
        limb = tube()
        # No round numbers: all 64 bits count.
        positions, triangles = limb.positions + np.pi * 1e-3, limb.triangles
        wishes = DESIGNS[name]
    else:
        positions, triangles = arm(4_000)
        # On vertices, so that every place is on the limb.
        wishes = {
            **DESIGNS[name],
            "pressures": [
                {**wanted, "at": positions[index].tolist()}
                for wanted, index in zip(DESIGNS[name]["pressures"], (700, 1300))
            ],
        }
    write_ply(tmp_path / "limb.ply", positions, triangles)
    text = json.dumps(wishes, ensure_ascii=False)
    (tmp_path / "design.json").write_text(text, encoding="utf-8")
    command = [program, "flatten", tmp_path / "limb.ply", "--design", tmp_path / "design.json"]
    command += ["--out", tmp_path / "theirs", "--quiet", "--spacing", "6"]
    subprocess.run(command, check=True)

    design = wovenfit.Design.from_json(text)
    pattern = wovenfit.flatten(positions, triangles, design, parameters={"spacing": 6.0})
    written = pattern.write(tmp_path / "ours")
    names = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    assert sorted(wovenfit.FILES) == names
    assert sorted(path.name for path in (tmp_path / "ours").iterdir()) == names
    assert sorted(written) == [tmp_path / "ours" / name for name in names]
    for name in names:
        theirs = (tmp_path / "theirs" / name).read_bytes()
        assert (tmp_path / "ours" / name).read_bytes() == theirs, name
        assert len(theirs) > 1000


def test_the_formats_of_the_pattern_are_the_command_lines(program: Path, tmp_path: Path) -> None:
    limb = tube()
    write_ply(tmp_path / "limb.ply", limb.positions, limb.triangles)
    # A Greek letter is in no format's alphabet but SVG's and DXF's.
    piece = {"name": "sleeve β", "quantity": 2, "seam_allowance_mm": 8, "top_allowance_mm": 15}
    text = json.dumps({**DESIGNS["tube"], "piece": piece}, ensure_ascii=False)
    (tmp_path / "design.json").write_text(text, encoding="utf-8")
    formats = wovenfit.pattern_formats()
    command = [program, "flatten", tmp_path / "limb.ply", "--design", tmp_path / "design.json"]
    command += ["--out", tmp_path / "theirs", "--quiet", "--spacing", "6", "--pattern-units", "in"]
    command += ["--format", ",".join(row.name for row in formats)]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)

    design = wovenfit.Design.from_json(text)
    pattern = wovenfit.flatten(limb.positions, limb.triangles, design, parameters={"spacing": 6.0})
    pattern.write(tmp_path / "ours", formats=[row.name for row in formats], unit="in")
    theirs = contents(tmp_path / "theirs")
    assert contents(tmp_path / "ours") == theirs
    for row in formats:
        assert pattern.export(row.name, "in") == theirs[row.file_name]
        for note in pattern.export_notes(row.name, "in"):
            assert f"note: {note}\n" in ran.stderr
    assert [row.name for row in formats if pattern.export_notes(row.name)] == [
        "pdf",
        "pdf-a4",
        "pdf-letter",
        "dxf-astm",
        "dxf-gerber",
    ]
    assert "sleeve ?" in pattern.export_notes("dxf-astm")[0]
    for wrong in ({"format": "docx"}, {"format": "dxf", "unit": "cm"}):
        with pytest.raises(wovenfit.InvalidArgument, match="give"):
            pattern.export(**wrong)
    with pytest.raises(wovenfit.InvalidArgument, match="give one of"):
        pattern.write(tmp_path / "none", formats=["docx"])
    assert not (tmp_path / "none").exists()


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_files_are_replaced_and_others_stay(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "other").write_bytes(b"other")
    files.write_together(tmp_path, {"a": b"new", "b": b"new"})
    assert contents(tmp_path) == {"a": b"new", "b": b"new", "other": b"other"}


@pytest.mark.parametrize("failing", [0, 1, 2, 3, 4, 5])
def test_if_a_rename_fails_all_is_as_before(
    failing: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = {"a": b"old a", "b": b"old b", "other": b"other"}
    for name, old in before.items():
        (tmp_path / name).write_bytes(old)
    rename, calls = Path.rename, []

    def fails(self: Path, target: Path) -> Path:
        calls.append(target)
        if len(calls) == failing + 1:
            raise OSError("the disk is full")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", fails)
    new = {"a": b"new", "b": b"new", "c": b"new"}
    if failing < 5:
        with pytest.raises(OSError, match="full"):
            files.write_together(tmp_path, new)
        assert contents(tmp_path) == before
    else:
        # Two renames for each that was there, one for the new: the sixth is never made.
        files.write_together(tmp_path, new)
        assert contents(tmp_path) == {**before, **new}
    assert sorted(os.listdir(tmp_path)) == sorted(contents(tmp_path))


def test_folders_are_made_and_taken_away_if_nothing_came_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    deep = tmp_path / "x" / "y"

    def full(descriptor: int) -> None:
        raise OSError("the disk is full")

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", full)
        with pytest.raises(OSError, match="full"):
            files.write_together(deep, {"a": b"1"})
    assert list(tmp_path.iterdir()) == []
    assert files.write_together(str(deep), {"a": b"1"}) == (deep / "a",)
    assert contents(tmp_path) == {str(Path("x/y/a")): b"1"}


def test_a_folder_of_a_files_name_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    with pytest.raises(IsADirectoryError, match="move it away"):
        files.write_together(tmp_path, {"a": b"1", "b": b"2"})
    assert [path.name for path in tmp_path.iterdir()] == ["b"]
