"""Report: the table of pressures and the warnings, and the way to the full page."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import FreeCADGui
from PySide import QtCore, QtGui

from ... import files, places
from ..resources import icon
from ..view_brace import mmhg
from .panel import only_close


class ReportPanel:
    """The panel.

    Raises:
        RuntimeError: if the brace is invalid or out of date, with its reason.
    """

    def __init__(self, brace: Any) -> None:
        self.brace = brace
        pattern = brace.Proxy.pattern(brace)
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(f"Report: {brace.Label}")
        self.form.setWindowIcon(QtGui.QIcon(icon("Report")))
        column = QtGui.QVBoxLayout(self.form)
        figures = pattern.figures
        converged = "converged" if figures.converged else "NOT converged"
        head = QtGui.QLabel(
            f"{figures.width_mm:.1f} mm by {figures.height_mm:.1f} mm, fit {converged}. "
            f"Pressures are computed by a model at a scale of {figures.curvature_radius_mm:g} mm, "
            "not measured."
        )
        head.setWordWrap(True)
        column.addWidget(head)
        self.table = QtGui.QTableWidget(len(pattern.pressures), 4)
        self.table.setHorizontalHeaderLabels(["", "Wanted\nmmHg", "Computed\nmmHg", "Warp\nstrain"])
        self.table.verticalHeader().hide()
        self.table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.table.horizontalHeader().setSectionResizeMode(QtGui.QHeaderView.Stretch)
        self.table.setMinimumHeight(140)
        for row, (n, said) in enumerate(zip(places.pressures(brace), pattern.pressures)):
            texts = (
                f"{n}",
                f"{mmhg(said.asked_kpa):.1f}",
                f"{mmhg(said.got_kpa):.1f}",
                f"{said.warp_strain:.3f}",
            )
            for at, text in enumerate(texts):
                item = QtGui.QTableWidgetItem(text)
                if not said.met:
                    item.setBackground(QtGui.QColor(255, 190, 180))
                    item.setToolTip(said.reason.message if said.reason else "")
                self.table.setItem(row, at, item)
        column.addWidget(self.table)
        self.warnings = QtGui.QPlainTextEdit("\n\n".join(brace.Warnings) or "No warnings.")
        self.warnings.setReadOnly(True)
        column.addWidget(self.warnings, 1)
        self.full = QtGui.QPushButton("Open the full report in the browser")
        self.full.clicked.connect(lambda *_: self.open_page())
        column.addWidget(self.full)

    def getStandardButtons(self) -> int:
        return only_close()

    def reject(self) -> bool:
        """Close, Esc."""
        FreeCADGui.Control.closeDialog()
        return True

    def write_page(self) -> Path:
        """Writes the page into a folder of its own; it stays for the browser."""
        folder = Path(tempfile.mkdtemp(prefix="wovenfit-report-"))
        return files.write_report(self.brace, folder / "report.html")

    def open_page(self) -> None:
        """Opens the page."""
        QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(self.write_page())))
