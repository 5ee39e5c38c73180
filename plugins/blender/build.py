"""Builds the add-on's two packages, each with the shared library inside.

    python3 plugins/blender/build.py [--out FOLDER] [--tool BLENDER_EXT.PY]

- `wovenfit_blender-VERSION-PLATFORM.zip`, an extension for Blender 4.2 and later;
- `wovenfit_blender-VERSION-PLATFORM-legacy.zip`, an add-on for Blender 3.4 to 4.1.

The Python package and the library are put in from this checkout; the version is the workspace's.
The extension is validated by Blender's own tool: the one that `--tool` names (each Blender from 4.2
on carries `blender_ext.py`), else the Blender that is on the path; without either it says so. The
same checkout and library give the same bytes.

It needs what plugins/portable.py needs.
"""

from __future__ import annotations

import argparse
import platform
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))

from portable import portable_library  # noqa: E402  beside this folder

NAME = "wovenfit_blender"
LICENCES = ("LICENSE-MIT", "LICENSE-APACHE")


def platform_name() -> str:
    """This machine, as Blender's manifests call it."""
    system = {"linux": "linux", "darwin": "macos", "win32": "windows"}[sys.platform]
    machine = platform.machine().lower()
    return f"{system}-{'arm64' if machine in ('arm64', 'aarch64') else 'x64'}"


def workspace_version() -> str:
    """The version, which stands in Cargo.toml alone."""
    manifest = (REPOSITORY / "Cargo.toml").read_text(encoding="utf-8")
    found = re.search(r'^version = "(\d+\.\d+\.\d+)"$', manifest, re.MULTILINE)
    if found is None:
        raise SystemExit("Cargo.toml states no version of three numbers")
    return found[1]


def contents(version: str) -> dict[str, bytes]:
    """The files of the add-on by their paths in it."""
    files: dict[str, bytes] = {}
    for source, into in ((HERE / NAME, ""), (REPOSITORY / "plugins/python/wovenfit", "wovenfit/")):
        for path in sorted(source.rglob("*.py")):
            files[into + path.relative_to(source).as_posix()] = path.read_bytes()
    placeholder = b'"version": (0, 0, 0)'
    if files["__init__.py"].count(placeholder) != 1:
        raise SystemExit(f"{NAME}/__init__.py has no place for the version in bl_info")
    numbers = ", ".join(version.split(".")).encode()
    files["__init__.py"] = files["__init__.py"].replace(placeholder, b'"version": (%s)' % numbers)
    for name in LICENCES:
        files[name] = (REPOSITORY / name).read_bytes()
    library = portable_library()
    files[f"wovenfit/lib/{library.name}"] = library.read_bytes()
    return files


def write(path: Path, files: dict[str, bytes]) -> None:
    """A zip file of them, the same bytes for the same contents."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as package:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            package.writestr(entry, data)


def validate(extension: Path, tool: Path | None) -> None:
    """Has Blender look at the extension."""
    if tool is not None:
        command = [sys.executable, str(tool), "validate", str(extension)]
    else:
        blender = shutil.which("blender")
        if blender is None or not _has_extensions(blender):
            print("not validated: there is no Blender 4.2 or later; name its tool with --tool")
            return
        command = [blender, "--command", "extension", "validate", str(extension)]
    done = subprocess.run(command, check=False)
    if done.returncode != 0:
        raise SystemExit(f"Blender refuses {extension}: {' '.join(command)}")


def _has_extensions(blender: str) -> bool:
    said = subprocess.run(
        [blender, "--version"], capture_output=True, text=True, check=False
    ).stdout
    found = re.search(r"Blender (\d+)\.(\d+)", said)
    return found is not None and (int(found[1]), int(found[2])) >= (4, 2)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="Builds the packages of the Blender add-on.")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "target/blender")
    parser.add_argument("--tool", type=Path, help="blender_ext.py of a Blender 4.2 or later")
    given = parser.parse_args()
    version, machine = workspace_version(), platform_name()
    files = contents(version)
    given.out.mkdir(parents=True, exist_ok=True)
    base = f"{NAME}-{version}-{machine}"

    manifest = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    manifest = manifest.replace("@VERSION@", version).replace("@PLATFORM@", machine)
    extension = given.out / f"{base}.zip"
    write(extension, {**files, "blender_manifest.toml": manifest.encode()})
    validate(extension, given.tool)
    # An add-on of before lies in a folder of its own name.
    legacy = given.out / f"{base}-legacy.zip"
    write(legacy, {f"{NAME}/{name}": data for name, data in files.items()})
    for package in (extension, legacy):
        print(f"{package}  {package.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
