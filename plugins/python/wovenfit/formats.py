"""The formats of the pattern: what a workshop's machines read."""

from __future__ import annotations

from dataclasses import dataclass

from . import calls
from .abi import FormatText
from .library import library


@dataclass(frozen=True)
class Format:
    """A format of the pattern."""

    name: str
    """Short, for options: "pdf-a4"."""
    file_name: str
    """What its file is called: "pattern-a4.pdf"."""
    summary: str
    """What it is for, in one line."""


def pattern_formats() -> tuple[Format, ...]:
    """Every format of the pattern, in the order in which menus show them."""
    return tuple(_row(index) for index in range(library().wovenfit_format_count()))


def _row(index: int) -> Format:
    def text(what: FormatText) -> str:
        return calls.text("wovenfit_format_describe", index, what).decode()

    return Format(text(FormatText.NAME), text(FormatText.FILE_NAME), text(FormatText.SUMMARY))
