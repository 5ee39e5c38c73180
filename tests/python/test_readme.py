"""The README's example, as it stands there."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest


def test_the_readmes_example_runs(repository: Path, tmp_path: Path) -> None:
    readme = (repository / "README.md").read_text(encoding="utf-8")
    section = readme.partition("## From Python")[2].partition("\n## ")[0]
    (example,) = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    assert len(example.splitlines()) <= 22
    assert "trimesh" in example
    (tmp_path / "example.py").write_text(example, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "example.py"],
        cwd=tmp_path,
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    width = float(re.search(r"([\d.]+) mm wide", done.stdout)[1])
    # A tube of 40 mm radius in 64 sides, 2 kPa in 0.5 N/mm: a strain of 0.16.
    assert width == pytest.approx(251.23 / 1.16, rel=0.01)
    assert sorted(path.name for path in (tmp_path / "brace").iterdir()) == sorted(
        ["report.html", "report.json", "pattern.svg", "worn.obj", "flat.obj"]
    )
