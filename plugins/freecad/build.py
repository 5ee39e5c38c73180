"""Builds the folder that is dropped into FreeCAD's Mod: the workbench, the Python package
``wovenfit`` and the shared library.

    python3 plugins/freecad/build.py [--out FOLDER]

The folder ``Wovenfit`` is made in FOLDER (``target/freecad``), and beside it a zip file of it. What
was in it before goes. It needs what ``plugins/portable.py`` needs, which builds the library.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import shutil
import sys
import zipfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "plugins"))

from portable import FILE_NAME, portable_library  # noqa: E402

NAME = "Wovenfit"
SOURCE = Path(__file__).resolve().parent / NAME
PACKAGE = REPOSITORY / "plugins" / "python" / "wovenfit"
LICENCES = ("LICENSE-MIT", "LICENSE-APACHE")
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.pyc", "lib")


def version() -> str:
    """The workspace's version: stated once, in Cargo.toml."""
    manifest = (REPOSITORY / "Cargo.toml").read_text(encoding="utf-8")
    package = manifest.partition("[workspace.package]")[2]
    found = re.search(r'^version = "([^"]+)"$', package, re.MULTILINE)
    if found is None:
        raise SystemExit("Cargo.toml states no version under [workspace.package]")
    return found[1]


def build(out: Path) -> Path:
    """Builds the folder in `out` and says where it is."""
    library = portable_library()
    folder = out / NAME
    if folder.exists():
        shutil.rmtree(folder)
    out.mkdir(parents=True, exist_ok=True)
    shutil.copytree(SOURCE, folder, ignore=LEFT_OUT)
    shutil.copytree(PACKAGE, folder / PACKAGE.name, ignore=LEFT_OUT)
    carried = folder / PACKAGE.name / "lib"
    carried.mkdir()
    shutil.copyfile(library, carried / FILE_NAME)
    for name in LICENCES:
        shutil.copyfile(REPOSITORY / name, folder / name)
    described = folder / "package.xml"
    text = described.read_text(encoding="utf-8")
    if "@VERSION@" not in text:
        raise SystemExit(f"{SOURCE / 'package.xml'} has no @VERSION@ to replace")
    described.write_text(text.replace("@VERSION@", version()), encoding="utf-8")
    return folder


def pack(folder: Path) -> Path:
    """A zip file of the folder, to be unpacked in Mod."""
    system = f"{platform.system()}-{platform.machine()}".lower()
    packed = folder.parent / f"{NAME}-{version()}-{system}.zip"
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(folder.parent))
    return packed


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=REPOSITORY / "target" / "freecad")
    folder = build(parser.parse_args().out.resolve())
    print(folder)
    print(pack(folder))


if __name__ == "__main__":
    os.umask(0o022)
    main()
