"""MeshLab 2020.09's window under a virtual display, worked by driver.cpp: the dialog, the result,
an error. The pictures stay in target/meshlab/pictures, to be looked at."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from limbs import REPOSITORY, sample, write_ply
from server import environment, tree

BUILD = Path(os.environ["WOVENFIT_MESHLAB_BUILD"])
PICTURES = REPOSITORY / "target/meshlab/pictures"


def test_dialog_result_and_error_in_the_window(tmp_path: Path) -> None:
    limb = sample(tmp_path, 40_000)
    ply = write_ply(tmp_path / "arm.ply", limb.points, limb.faces)
    plugins = [BUILD / "libfilter_wovenfit.so", BUILD / "libfilter_wovenfit_driver.so"]
    programs = tree(tmp_path / "meshlab", plugins)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for old in PICTURES.iterdir():
        old.unlink()
    command = [
        "xvfb-run",
        "-a",
        "-s",
        "-screen 0 1760x1000x24",
        str(programs / "meshlab"),
        str(ply),
    ]
    done = subprocess.run(
        command,
        env=environment(
            tmp_path / "home", WOVENFIT_WINDOW=str(PICTURES), WOVENFIT_DESIGN=str(limb.design_file)
        ),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    verdict = (PICTURES / "window.txt").read_text()
    assert done.returncode == 0, verdict + done.stdout + done.stderr
    assert verdict.count("ok: ") == 4, verdict
    assert "FAILED" not in verdict, verdict
    for name in ("dialog.png", "result.png", "error.png"):
        assert (PICTURES / name).stat().st_size > 20_000
