"""Pressures: a click on the limb adds one, the table changes and removes them."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ... import edits, places
from ...quantities import PRESSURE, number, quantity
from ..picking import Picker
from .panel import EditPanel

UNITS = {"mmHg": "Torr", "kPa": "kPa"}
"""What is shown, and FreeCAD's name of it."""

DEFAULT_MMHG = 15.0
"""Of the first pressure: below compression class I, to be typed over."""


class PressuresPanel(EditPanel):
    """The panel."""

    def __init__(self, brace: Any) -> None:
        super().__init__(brace, "Pressures", "AddPressure")
        self.tell("Click on the limb where the brace shall press, then type how much.")
        row = QtGui.QHBoxLayout()
        row.addWidget(QtGui.QLabel("In"))
        self.unit = QtGui.QComboBox()
        self.unit.addItems(list(UNITS))
        self.unit.currentIndexChanged.connect(lambda *_: self._fill())
        row.addWidget(self.unit)
        row.addStretch(1)
        self.column.addLayout(row)
        self.table = QtGui.QTableWidget(0, 4)
        self.table.setHorizontalHeaderLabels(["", "Wanted", "Computed", ""])
        self.table.verticalHeader().hide()
        self.table.setSelectionMode(QtGui.QAbstractItemView.NoSelection)
        self.table.horizontalHeader().setSectionResizeMode(QtGui.QHeaderView.Stretch)
        for column in (0, 3):
            self.table.horizontalHeader().setSectionResizeMode(
                column, QtGui.QHeaderView.ResizeToContents
            )
        self.column.addWidget(self.table)
        self._last = DEFAULT_MMHG * number("1 Torr", PRESSURE)
        self._fill()
        self._picker = Picker(brace, self.add)

    def add(self, place: Any) -> None:
        """Adds a pressure at a place, with the last value, which is then typed over."""
        edits.add_pressure(self.brace, place, quantity(self._last, PRESSURE))
        self._fill()
        box = self.box(self.table.rowCount() - 1)
        box.setFocus()
        box.selectAll()

    def box(self, row: int) -> Any:
        """The field of a row's wanted pressure."""
        return self.table.cellWidget(row, 1)

    def end(self) -> None:
        self._picker.end()

    def _fill(self) -> None:
        unit = UNITS[self.unit.currentText()]
        numbers = places.pressures(self.brace)
        self.table.setRowCount(len(numbers))
        for row, n in enumerate(numbers):
            driven = any(path == f"Pressure{n}" for path, _ in self.brace.ExpressionEngine)
            box = QtGui.QDoubleSpinBox()
            box.setDecimals(2 if unit == "kPa" else 1)
            box.setRange(0, 1000)
            box.setSuffix(f" {self.unit.currentText()}")
            box.setValue(number(getattr(self.brace, f"Pressure{n}"), unit))
            box.setKeyboardTracking(False)
            box.setEnabled(not driven)
            if driven:
                box.setToolTip("An expression drives it: change it in the property editor")
            box.valueChanged.connect(lambda value, n=n: self._wanted(n, value))
            remove = QtGui.QPushButton("Remove")
            remove.setAutoDefault(False)
            remove.clicked.connect(lambda *_, n=n: self._remove(n))
            self.table.setItem(row, 0, _plain(str(n)))
            self.table.setCellWidget(row, 1, box)
            self.table.setItem(row, 2, _plain(self._computed(n)))
            self.table.setCellWidget(row, 3, remove)

    def _computed(self, n: int) -> str:
        value = number(getattr(self.brace, f"PressureComputed{n}"), UNITS[self.unit.currentText()])
        return f"{value:.2f}" if value else "–"

    def _wanted(self, n: int, value: float) -> None:
        setattr(self.brace, f"Pressure{n}", quantity_in(value, UNITS[self.unit.currentText()]))
        setattr(self.brace, f"PressureComputed{n}", 0)
        self._last = number(getattr(self.brace, f"Pressure{n}"), PRESSURE)

    def _remove(self, n: int) -> None:
        edits.remove_pressure(self.brace, f"Pressure{n}")
        # The button that was pressed is in the table.
        QtCore.QTimer.singleShot(0, self._fill)


def quantity_in(value: float, unit: str) -> str:
    """A quantity as FreeCAD reads it."""
    return f"{value!r} {unit}"


def _plain(text: str) -> Any:
    item = QtGui.QTableWidgetItem(text)
    item.setFlags(QtCore.Qt.ItemIsEnabled)
    return item
