"""`pip install ./plugins/python`: the wheel, and the package in an environment of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest
import wovenfit

CHECK = """
import sys
import wovenfit
from pathlib import Path
here = Path(wovenfit.__file__).resolve().parent
assert Path(sys.prefix).resolve() in here.parents, here
assert wovenfit.library.find_library()._name == str(here / "lib" / wovenfit.library.FILE_NAME)
positions = [[x * r, y * r, z] for z in (60, 40, 20, 0) for r in (40,)
             for x, y in ((1, 0), (.5, .866), (-.5, .866), (-1, 0), (-.5, -.866), (.5, -.866))]
triangles = [t for k in (0, 6, 12) for i in range(6) for j in [(i + 1) % 6]
             for t in ([k + i, k + 6 + i, k + 6 + j], [k + i, k + 6 + j, k + j])]
pattern = wovenfit.flatten(positions, triangles, {"pressures": []})
print(wovenfit.version(), round(pattern.figures.height_mm))
"""


def without(*names: str) -> dict[str, str]:
    """The environment without these variables, and without what points to this one's Python."""
    hidden = {*names, "PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"}
    return {name: value for name, value in os.environ.items() if name not in hidden}


def pip(python: str | Path, *arguments: str | Path, **environment: str) -> str:
    command = [python, "-m", "pip", "--disable-pip-version-check", *arguments]
    there = {**without("WOVENFIT_LIBRARY"), **environment}
    done = subprocess.run(
        command, env=there, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode != 0:
        raise RuntimeError(done.stdout)
    return done.stdout


@pytest.fixture(scope="module")
def wheel(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    pip(
        sys.executable, "wheel", "--quiet", "--no-deps", "-w", folder, repository / "plugins/python"
    )
    (made,) = folder.iterdir()
    return made


def test_the_wheel_is_for_one_platform_and_any_python_3(wheel: Path) -> None:
    name, version, python, abi, platform = wheel.stem.split("-")
    assert (name, version, python, abi) == ("wovenfit", wovenfit.version(), "py3", "none")
    assert platform != "any"
    assert platform.startswith(("linux_", "macosx_", "win"))


def test_the_wheel_carries_the_library_and_the_package_alone(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        metadata = next(name for name in names if name.endswith("/METADATA"))
        stated = archive.read(metadata).decode()
        tag = archive.read(metadata.replace("METADATA", "WHEEL")).decode()
    assert f"wovenfit/lib/{wovenfit.library.FILE_NAME}" in names
    assert {"wovenfit/py.typed", "wovenfit/signatures.py", "wovenfit/__init__.py"} <= names
    folders = {name.split("/")[0] for name in names}
    assert folders == {"wovenfit", metadata.split("/")[0]}
    assert not [name for name in names if "test" in name or "hatch_build" in name]
    assert "Requires-Dist: numpy" in stated
    assert stated.count("Requires-Dist") == 1
    assert "Root-Is-Purelib: false" in tag


def test_installed_elsewhere_it_works(wheel: Path, tmp_path: Path) -> None:
    assert not any((parent / "Cargo.toml").exists() for parent in tmp_path.parents)
    venv.create(tmp_path / "venv", with_pip=True)
    python = tmp_path / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    pip(python, "install", "--quiet", wheel)
    done = subprocess.run(
        [python, "-c", CHECK],
        cwd=tmp_path,
        env=without("WOVENFIT_LIBRARY"),
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert done.stdout.split() == [wovenfit.version(), "60"]


def test_a_library_that_is_given_is_the_one_that_is_carried(
    repository: Path, tmp_path: Path
) -> None:
    given = tmp_path / "anything.so"
    given.write_bytes(b"what was given")
    pip(
        sys.executable,
        *("wheel", "--quiet", "--no-deps", "-w", tmp_path, repository / "plugins" / "python"),
        WOVENFIT_LIBRARY=str(given),
    )
    (made,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(made) as archive:
        carried = archive.read(f"wovenfit/lib/{wovenfit.library.FILE_NAME}")
    assert carried == b"what was given"


def test_a_given_library_that_is_not_there_stops_the_build(
    repository: Path, tmp_path: Path
) -> None:
    with pytest.raises(RuntimeError, match="there is no such file"):
        pip(
            sys.executable,
            *("wheel", "--no-deps", "-w", tmp_path, repository / "plugins" / "python"),
            WOVENFIT_LIBRARY=str(tmp_path / "nowhere.so"),
        )
    assert list(tmp_path.glob("*.whl")) == []
