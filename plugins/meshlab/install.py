"""Builds the WovenFit filter for a MeshLab and installs it.

    python3 plugins/meshlab/install.py                      for this machine's MeshLab
    python3 plugins/meshlab/install.py --pymeshlab PYTHON   for the pymeshlab of a Python

The plugin is built for exactly that MeshLab: its version and the precision of its coordinates. It
goes to MeshLab's own plugins (which mostly needs root); how to load pymeshlab's is said. It needs
cargo, cmake, ninja, g++, Qt 5, GLEW and Eigen; on Debian:

    apt install cmake ninja-build g++ qtbase5-dev libqt5opengl5-dev libglew-dev libeigen3-dev
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import headers

HERE = Path(__file__).resolve().parent
NAME = "libfilter_wovenfit.so"
# What a caller can tell from other failures: MeshLab's headers cannot be had.
NO_HEADERS = 3


@dataclass(frozen=True)
class Host:
    """A MeshLab."""

    common: Path
    """Its library libmeshlab-common."""
    plugins: Path | None
    """Where it looks for plugins; ``None`` where a script loads them."""

    @property
    def scalar(self) -> str:
        """The type of its coordinates, as the names of its functions have it."""
        names = self.common.read_bytes()
        found = re.search(rb"setMeshTransformationMatrixEiRKN3vcg8Matrix44I([fd])E", names)
        if found is None:
            raise SystemExit(f"{self.common} is no library of a MeshLab that is known here")
        return {b"f": "float", b"d": "double"}[found.group(1)]

    @property
    def version(self) -> str:
        """Its version without the letter that stands for doubles, such as ``2020.09``."""
        found = re.search(rb"20[12]\d\.[01]\d(?=d?[^\d.])", self.common.read_bytes())
        if found is None:
            raise SystemExit(f"{self.common} does not say its version")
        return found.group().decode()


def installed() -> Host:
    """This machine's MeshLab."""
    for folder in sorted(Path("/usr").glob("lib*/**/meshlab")):
        common = folder / "libmeshlab-common.so"
        if common.is_file():
            return Host(common, folder / "plugins")
    raise SystemExit("there is no MeshLab in /usr: install it (apt install meshlab), or see --help")


def of_python(python: str) -> Host:
    """The MeshLab inside a Python's pymeshlab."""
    asked = (
        "import importlib.util as u; print(u.find_spec('pymeshlab').submodule_search_locations[0])"
    )
    said = subprocess.run([python, "-c", asked], capture_output=True, text=True, check=False)
    if said.returncode != 0:
        raise SystemExit(f"{python} has no pymeshlab: install it (pip install pymeshlab)")
    return Host(Path(said.stdout.strip()) / "lib" / "libmeshlab-common.so", None)


def build(host: Host, sources: Path, *, tests: bool) -> Path:
    """Builds the plugin; where it is."""
    cargo = shutil.which("cargo") or shutil.which("cargo", path=str(Path.home() / ".cargo/bin"))
    missing = [tool for tool in ("cmake", "ninja", "c++") if shutil.which(tool) is None]
    if cargo is None or missing:
        what = ", ".join([*(["cargo (see https://rustup.rs)"] if cargo is None else []), *missing])
        raise SystemExit(f"not found: {what}. {(__doc__ or '').split('It')[-1]}")
    doubles = host.scalar == "double"
    # From 2021.05 on MeshLab's version says its precision.
    version = host.version + ("d" if doubles and host.version > "2020.12" else "")
    folder = headers.FOLDER / f"build-{version}-{host.scalar}"
    folder.mkdir(parents=True, exist_ok=True)
    environment = dict(os.environ)
    environment.pop("RUSTFLAGS", None)
    configure = [
        *("cmake", "-G", "Ninja", "-S", str(HERE), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release"),
        *(f"-DMESHLAB_SOURCE={sources}", f"-DMESHLAB_COMMON={host.common}"),
        *(f"-DMESHLAB_VERSION={version}", f"-DMESHLAB_SCALAR={host.scalar}", f"-DCARGO={cargo}"),
        f"-DWOVENFIT_TESTS={'ON' if tests else 'OFF'}",
    ]
    for command in (configure, ["cmake", "--build", str(folder)]):
        done = subprocess.run(
            command, env=environment, stdout=subprocess.PIPE, text=True, check=False
        )
        if done.returncode != 0:
            sys.stderr.write(done.stdout)
            raise SystemExit(
                f"{command[0]} ended with {done.returncode}. {(__doc__ or '').split('It')[-1]}"
            )
    return folder / NAME


def install(plugin: Path, folder: Path) -> Path:
    """Puts the plugin among MeshLab's own."""
    target = folder / NAME
    fresh = folder / f".{NAME}.new"
    try:
        shutil.copyfile(plugin, fresh)
        fresh.replace(target)
    except PermissionError:
        raise SystemExit(
            f"{folder} is not yours to write: run this as root, or copy it there yourself:\n"
            f"  sudo cp {plugin} {folder}/"
        ) from None
    return target


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--pymeshlab", metavar="PYTHON", help="build for the pymeshlab of this Python"
    )
    parser.add_argument(
        "--sources", metavar="DIR", type=Path, help="MeshLab's unpacked sources, if you have them"
    )
    parser.add_argument(
        "--plugins", metavar="DIR", type=Path, help="another folder to install into"
    )
    parser.add_argument("--build-only", action="store_true", help="install nothing")
    parser.add_argument("--tests", action="store_true", help="also build what only the tests load")
    wanted = parser.parse_args()
    host = of_python(wanted.pymeshlab) if wanted.pymeshlab else installed()
    try:
        sources = wanted.sources or headers.sources(host.version)
    except headers.NoHeadersError as error:
        print(f"{error}", file=sys.stderr)
        raise SystemExit(NO_HEADERS) from None
    plugin = build(host, sources.resolve(), tests=wanted.tests)
    folder = wanted.plugins or host.plugins
    if wanted.build_only:
        print(plugin)
    elif folder is None:
        print(f"Built. In your script:\n  pymeshlab.load_plugin({str(plugin)!r})")
    else:
        print(
            f"Installed: {install(plugin, folder)}. Start MeshLab; the filters are in "
            "Filters > Texture and Filters > Selection."
        )


if __name__ == "__main__":
    main()
