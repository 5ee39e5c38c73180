"""The files of a brace, as the library writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import wovenfit


def file_names() -> tuple[str, ...]:
    """The files that the library makes of a pattern."""
    return tuple(wovenfit.FILES)


def export(brace: Any, folder: str | Path) -> tuple[Path, ...]:
    """Writes all files of the library into a folder, which is made if there is none.

    Raises:
        RuntimeError: if the brace is invalid or out of date, with its reason; nothing is written.
        OSError: if they cannot be written; what was there before stays.
    """
    return brace.Proxy.pattern(brace).write(folder)


def write_report(brace: Any, file: str | Path) -> Path:
    """Writes the page of the report.

    Raises:
        RuntimeError: as `export`.
    """
    path = Path(file)
    path.write_text(brace.Proxy.pattern(brace).html, encoding="utf-8")
    return path
