"""Where the icons are."""

from __future__ import annotations

from pathlib import Path

ICONS = Path(__file__).resolve().parents[2] / "Resources" / "icons"


def icon(name: str) -> str:
    """The file of an icon."""
    return str(ICONS / f"{name}.svg")
