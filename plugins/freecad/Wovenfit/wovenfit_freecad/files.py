"""The files of a brace, as the library writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import wovenfit

_INCHES = frozenset((2, 3, 5, 7))
"""FreeCAD's unit systems, by number, that measure in inches and feet."""


def formats() -> tuple[str, ...]:
    """The formats of the pattern, all that the library has."""
    return tuple(row.name for row in wovenfit.pattern_formats())


def file_names() -> tuple[str, ...]:
    """The files that the library makes of a pattern."""
    patterns = [row.file_name for row in wovenfit.pattern_formats()]
    return (*(name for name in wovenfit.FILES if name not in patterns), *patterns)


def unit() -> str:
    """The unit of the pattern's files by the unit system that is set in FreeCAD: "mm" or "in"."""
    group = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units")
    return "in" if group.GetInt("UserSchema", 0) in _INCHES else "mm"


def export(brace: Any, folder: str | Path) -> tuple[Path, ...]:
    """Writes all files of the library into a folder, which is made if there is none.

    The pattern is written in every format, in the unit of FreeCAD's unit system.

    Raises:
        RuntimeError: if the brace is invalid or out of date, with its reason; nothing is written.
        OSError: if they cannot be written; what was there before stays.
    """
    return brace.Proxy.pattern(brace).write(folder, formats=formats(), unit=unit())


def write_report(brace: Any, file: str | Path) -> Path:
    """Writes the page of the report.

    Raises:
        RuntimeError: as `export`.
    """
    path = Path(file)
    path.write_text(brace.Proxy.pattern(brace).html, encoding="utf-8")
    return path
