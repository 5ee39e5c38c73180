"""Puts the shared library into the wheel, which is then for one platform and any Python 3.

Without WOVENFIT_LIBRARY the library is built by cargo from this checkout and carried without its
debugging symbols; with it, the file that it names is carried as it is.

There is no sdist: the library is made from the whole repository, of which this folder is a part.
"""

from __future__ import annotations

import json
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

# As in wovenfit/library.py, which cannot be imported here: it needs numpy.
FILE_NAME = {"win32": "wovenfit.dll", "darwin": "libwovenfit.dylib"}.get(
    sys.platform, "libwovenfit.so"
)

REPOSITORY = Path(__file__).resolve().parents[2]


class CustomMetadataHook(MetadataHookInterface):
    """The version is the workspace's: stated once, in Cargo.toml."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Sets the version."""
        manifest = REPOSITORY / "Cargo.toml"
        if not manifest.is_file():
            raise SystemExit(
                f"wovenfit is built from a checkout of its repository: {manifest} is missing"
            )
        package = manifest.read_text(encoding="utf-8").partition("[workspace.package]")[2]
        version = re.search(r'^version = "([^"]+)"$', package, re.MULTILINE)
        if version is None:
            raise SystemExit(f"{manifest} states no version under [workspace.package]")
        metadata["version"] = version[1]


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Carries the library."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Builds or takes the library, and tags the wheel."""
        if self.target_name != "wheel":
            raise SystemExit(
                "wovenfit has no sdist: its library is built from the whole repository. "
                "Install from a checkout: pip install ./plugins/python"
            )
        given = os.environ.get("WOVENFIT_LIBRARY")
        if version == "editable":
            # It loads the checkout's own build; what is given is found by its variable.
            if not given:
                built_library()
            return
        if given:
            library = Path(given).resolve()
            if not library.is_file():
                raise SystemExit(f"WOVENFIT_LIBRARY is {given}: there is no such file")
        else:
            self.folder = tempfile.mkdtemp(prefix="wovenfit-")
            library = stripped(built_library(), Path(self.folder))
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform_tag()}"
        build_data["force_include"][str(library)] = f"wovenfit/lib/{FILE_NAME}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Leaves no copy of the library behind."""
        del version, build_data, artifact_path
        folder = getattr(self, "folder", None)
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)


def built_library() -> Path:
    """The shared library as cargo builds it."""
    cargo = shutil.which("cargo") or shutil.which("cargo", path=str(Path.home() / ".cargo/bin"))
    if cargo is None:
        raise SystemExit(
            "the library has to be built, and there is no cargo: install Rust from "
            "https://rustup.rs, or name a built library in WOVENFIT_LIBRARY"
        )
    command = [cargo, "build", "--release", "--locked", "--package", "wovenfit-ffi"]
    command += ["--message-format", "json-render-diagnostics"]
    done = subprocess.run(command, cwd=REPOSITORY, stdout=subprocess.PIPE, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)} in {REPOSITORY} ended with {done.returncode}")
    for line in done.stdout.splitlines():
        said = json.loads(line)
        if said["reason"] == "compiler-artifact" and said["target"]["name"] == "wovenfit":
            for name in said["filenames"]:
                if Path(name).name == FILE_NAME:
                    return Path(name)
    raise SystemExit(f"cargo built no {FILE_NAME} in {REPOSITORY}")


def stripped(library: Path, folder: Path) -> Path:
    """A copy in `folder` without debugging symbols, a tenth of the size, if there is a `strip`."""
    copy = folder / library.name
    shutil.copyfile(library, copy)
    strip = shutil.which("strip")
    if strip is not None:
        subprocess.run([strip, "-S", str(copy)], check=True)
    return copy


def platform_tag() -> str:
    """The platform of what cargo builds here.

    On Linux no manylinux is claimed: the library needs a libc as new as this machine's. On macOS
    the interpreter may be for several processors, the library is for one; the versions are the
    oldest that rustc builds for.
    """
    if sys.platform == "darwin":
        return "macosx_11_0_arm64" if platform.machine() == "arm64" else "macosx_10_12_x86_64"
    return re.sub(r"[-.]", "_", sysconfig.get_platform())
