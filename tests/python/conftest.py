"""What the tests share. The package is the installed one, never the checkout's folder."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
import wovenfit
from limbs import Tube, tube

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def repository() -> Path:
    return REPOSITORY


@pytest.fixture(scope="session")
def program() -> Path:
    """The command line."""
    command = ["cargo", "build", "--release", "--locked", "--quiet", "--package", "wovenfit"]
    subprocess.run(command, cwd=REPOSITORY, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    return target / "release" / f"wovenfit{'.exe' if os.name == 'nt' else ''}"


@pytest.fixture(scope="session")
def limb() -> Tube:
    return tube()


@pytest.fixture
def mesh(limb: Tube) -> wovenfit.Mesh:
    return wovenfit.Mesh(limb.positions, limb.triangles)


@pytest.fixture
def design(limb: Tube) -> wovenfit.Design:
    """2 kPa half way along: by Laplace's law a strain of 2e-3 N/mm2 * 45 mm / 0.5 N/mm = 0.18."""
    wanted = wovenfit.Design()
    wanted.set_fabric(warp=0.5, weft=0.5, diagonal=0.05)
    wanted.add_pressures([limb.at(2.0, 45.0)], 2.0)
    return wanted
