"""Finds and loads the shared library, and refuses one of another ABI.

Looked for, in this order:

1. the file that the environment variable WOVENFIT_LIBRARY names; if it is set, nothing else counts;
2. ``lib/`` beside this file, where an installed package has it;
3. the repository's ``target/release``, if this file lies in a checkout.
"""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from pathlib import Path
from typing import Optional

from .abi import ABI_VERSION
from .errors import LibraryError
from .signatures import declare

VARIABLE = "WOVENFIT_LIBRARY"

FILE_NAME = {"win32": "wovenfit.dll", "darwin": "libwovenfit.dylib"}.get(
    sys.platform, "libwovenfit.so"
)


def candidates() -> list[Path]:
    """The files that are looked for, the first that exists wins."""
    named = os.environ.get(VARIABLE)
    if named:
        return [Path(named).absolute()]
    here = Path(__file__).resolve().parent
    files = [here / "lib" / FILE_NAME]
    # plugins/python/wovenfit
    checkout = here.parent.parent.parent
    if (checkout / "ffi" / "Cargo.toml").is_file():
        files.append(checkout / "target" / "release" / FILE_NAME)
    return files


def open_library(path: Path) -> ctypes.CDLL:
    """Loads one file.

    Raises:
        LibraryError: if it cannot be loaded, lacks a function, or has another ABI number.
    """
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise LibraryError(f"{path} cannot be loaded as a shared library: {error}") from error
    try:
        library.wovenfit_abi_version.restype = ctypes.c_uint32
        library.wovenfit_abi_version.argtypes = ()
        number = library.wovenfit_abi_version()
    except AttributeError as error:
        raise LibraryError(f"{path} is not a library of wovenfit: {error}") from error
    # Before other functions are looked up: of another ABI they may be missing, or mean others.
    if number != ABI_VERSION:
        raise LibraryError(
            f"{path} has ABI {number}, and this package was made for ABI {ABI_VERSION}: install "
            "those that belong together"
        )
    try:
        declare(library)
    except AttributeError as error:
        raise LibraryError(f"{path} lacks a function that ABI {number} has: {error}") from error
    return library


def find_library() -> ctypes.CDLL:
    """Finds and loads the library.

    Raises:
        LibraryError: if there is none, naming every file that was tried, or it cannot be used.
    """
    files = candidates()
    for path in files:
        if path.is_file():
            return open_library(path)
    tried = "".join(f"\n  {path}" for path in files)
    remedy = (
        f"{VARIABLE} names a file that does not exist"
        if os.environ.get(VARIABLE)
        else f"install the package with `pip install ./plugins/python` from a checkout, build the "
        f"library with `cargo build --release --package wovenfit-ffi`, or name it in {VARIABLE}"
    )
    raise LibraryError(f"wovenfit's shared library was not found: {remedy}. Tried:{tried}")


_lock = threading.Lock()
_loaded: Optional[ctypes.CDLL] = None


def library() -> ctypes.CDLL:
    """The library, loaded at the first call; it stays loaded.

    Raises:
        LibraryError: as `find_library`; the next call tries again.
    """
    global _loaded  # a library is loaded once for a process
    with _lock:
        if _loaded is None:
            _loaded = find_library()
        return _loaded


def version() -> str:
    """The library's version, such as "0.1.0". Patterns of different versions may differ."""
    text: bytes = library().wovenfit_version()
    return text.decode()
