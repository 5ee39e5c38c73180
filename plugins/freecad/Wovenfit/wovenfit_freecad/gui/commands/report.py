"""Report."""

from __future__ import annotations

from typing import Any

from ..panels.panel import show
from ..panels.report import ReportPanel
from .command import Command


class Report(Command):
    """Opens the panel with the results."""

    name = "Wovenfit_Report"
    picture = "Report"
    text = "Report"
    tip = "Wanted and computed pressures, warnings, and the full report"

    def run(self, brace: Any) -> None:
        show(ReportPanel(brace))
