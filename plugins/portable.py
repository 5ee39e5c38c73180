"""Builds the shared library so that it loads on older Linux systems than this one.

A library linked here needs this machine's glibc or a newer one. What a plugin's package carries
is linked against glibc 2.17 of 2012 (CentOS 7, Debian 8 and all that came later), with zig as the
linker (cargo-zigbuild; both come from PyPI into the folder ``target/portable``). On other systems
it is cargo's ordinary build.

    python3 plugins/portable.py          builds it and prints where it is

It needs cargo and, on Linux, a Python with venv and pip; nothing else.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

GLIBC = "2.17"
REPOSITORY = Path(__file__).resolve().parents[1]
TARGET = REPOSITORY / "target"
TOOLS = TARGET / "portable"
REQUIREMENTS = ("cargo-zigbuild==0.24.1", "ziglang==0.15.2")
FILE_NAME = {"win32": "wovenfit.dll", "darwin": "libwovenfit.dylib"}.get(
    sys.platform, "libwovenfit.so"
)


def portable_library() -> Path:
    """Builds the library, without its debugging symbols, and says where it is.

    Raises:
        SystemExit: with the reason, if it cannot be built.
    """
    cargo = shutil.which("cargo") or shutil.which("cargo", path=str(Path.home() / ".cargo/bin"))
    if cargo is None:
        raise SystemExit(
            "the library has to be built, and there is no cargo: install Rust from "
            "https://rustup.rs"
        )
    environment = dict(os.environ)
    environment["PATH"] = os.pathsep.join([str(Path(cargo).parent), environment.get("PATH", "")])
    # No debugging symbols in what is carried away; a wish of the caller for flags would change it.
    environment["CARGO_PROFILE_RELEASE_DEBUG"] = "false"
    environment["CARGO_PROFILE_RELEASE_STRIP"] = "symbols"
    environment.pop("RUSTFLAGS", None)
    release = ["--release", "--locked", "--package", "wovenfit-ffi"]
    if not sys.platform.startswith("linux"):
        _run([cargo, "build", *release], environment)
        return _existing(TARGET / "release" / FILE_NAME)
    scripts = _tools()
    environment["PATH"] = os.pathsep.join([str(scripts), environment["PATH"]])
    triple = _host(cargo)
    release += ["--quiet", "--target-dir", str(TARGET), "--target", f"{triple}.{GLIBC}"]
    _run([cargo, "zigbuild", *release], environment)
    return _existing(TARGET / triple / "release" / FILE_NAME)


def _tools() -> Path:
    """The folder with cargo-zigbuild's and zig's programs, installed if they are not there."""
    scripts = TOOLS / "bin"
    stamp = TOOLS / "installed"
    wanted = "\n".join(REQUIREMENTS)
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != wanted:
        venv.create(TOOLS, clear=True, with_pip=True)
        pip = [str(scripts / "python"), "-m", "pip", "install", "--quiet", *REQUIREMENTS]
        _run(pip, dict(os.environ))
        stamp.write_text(wanted, encoding="utf-8")
    return scripts


def _host(cargo: str) -> str:
    """The triple of this machine."""
    rustc = shutil.which("rustc") or str(Path(cargo).parent / "rustc")
    said = subprocess.run([rustc, "-vV"], stdout=subprocess.PIPE, text=True, check=True).stdout
    return next(line[6:] for line in said.splitlines() if line.startswith("host: "))


def _run(command: list[str], environment: dict[str, str]) -> None:
    """Runs a command in the repository; what it says goes to our standard error."""
    done = subprocess.run(command, cwd=REPOSITORY, env=environment, stdout=sys.stderr, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)} ended with {done.returncode}")


def _existing(library: Path) -> Path:
    if not library.is_file():
        raise SystemExit(f"cargo ended well but {library} is not there")
    return library


if __name__ == "__main__":
    print(portable_library())
