"""Flatten: every parameter of the library's table, a job with progress, and cancel."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import wovenfit
from PySide import QtCore, QtGui
from wovenfit import ParameterKind

from ... import computation, edits, places, properties
from ...words import in_words_of_the_host
from ..resources import icon
from .panel import only_close

STAGES = {
    "waiting": "Waiting",
    "surface": "Checking the surface",
    "region": "Keeping the region",
    "cut": "Cutting the limb open",
    "parameterization": "Laying it flat for a start",
    "curvature": "Reading curvature",
    "fit": "Fitting the fabric",
    "mapping": "Mapping",
    "report": "Judging the result",
}
"""The library's stages, for people; one that is not here is shown by its name."""

POLL_MS = 50


class FlattenPanel:
    """The panel. Parameters and result become one step of undo, and nothing before."""

    def __init__(self, brace: Any) -> None:
        self.brace = brace
        self._document = brace.Document.Name
        self._job: wovenfit.Job | None = None
        self._inputs: computation.Inputs | None = None
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(f"Flatten: {brace.Label}")
        self.form.setWindowIcon(QtGui.QIcon(icon("Flatten")))
        column = QtGui.QVBoxLayout(self.form)
        self.fields = {row.name: _Field(row) for row in wovenfit.parameter_table()}
        self.defaults = QtGui.QPushButton("Defaults")
        self.defaults.clicked.connect(lambda *_: self._set_defaults())
        self.stage = QtGui.QLabel("Ready.")
        self.stage.setWordWrap(True)
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        self.start_button = QtGui.QPushButton("Flatten")
        self.start_button.setDefault(True)
        self.start_button.clicked.connect(lambda *_: self.start())
        self.cancel_button = QtGui.QPushButton("Cancel")
        self.cancel_button.setEnabled(False)
        self.cancel_button.clicked.connect(lambda *_: self.cancel())
        buttons = QtGui.QHBoxLayout()
        for button in (self.defaults, self.start_button, self.cancel_button):
            button.setAutoDefault(button is self.start_button)
            buttons.addWidget(button)
        # Above the parameters, of which there are many: always in sight.
        column.addLayout(buttons)
        for widget in (self.bar, self.stage):
            column.addWidget(widget)
        column.addWidget(self._parameters(), 1)
        for row in properties.parameters():
            self.fields[row.key].set(row.read(brace))
        self._timer = QtCore.QTimer(self.form)
        self._timer.timeout.connect(self._poll)

    def _parameters(self) -> Any:
        inside = QtGui.QWidget()
        form = QtGui.QFormLayout(inside)
        form.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        for name, field in self.fields.items():
            words = QtGui.QLabel(name.replace("_", " ").capitalize())
            words.setToolTip(field.tip)
            form.addRow(words, field.widget)
        area = QtGui.QScrollArea()
        area.setWidgetResizable(True)
        area.setMinimumHeight(320)
        area.setWidget(inside)
        return area

    def getStandardButtons(self) -> int:
        return only_close()

    def start(self) -> None:
        """Starts a job on what the brace wants and the panel says."""
        values = {name: field.get() for name, field in self.fields.items()}
        try:
            self._inputs = computation.inputs_of(self.brace, values)
            self._job = self.brace.Proxy.results.start(self._inputs)
        except Exception as error:  # the reason is for the designer
            self._say_failure(error)
            return
        self._running(True)
        self.stage.setStyleSheet("")
        self._timer.start(POLL_MS)

    def cancel(self) -> None:
        """Asks the job to stop."""
        if self._job is not None:
            self._job.cancel()
            self.stage.setText("Stopping …")

    def reject(self) -> bool:
        """Close, Esc: stops what runs."""
        self._timer.stop()
        if self._job is not None:
            self._job.close()
            self._job = None
        FreeCADGui.Control.closeDialog()
        return True

    def _running(self, runs: bool) -> None:
        self.start_button.setEnabled(not runs)
        self.defaults.setEnabled(not runs)
        self.cancel_button.setEnabled(runs)
        for field in self.fields.values():
            field.widget.setEnabled(not runs)
        if not runs:
            self._timer.stop()
            self.bar.setValue(0)

    def _poll(self) -> None:
        if self._job is None:
            return
        if FreeCAD.listDocuments().get(self._document) is None:
            # Closed meanwhile.
            self._timer.stop()
            self._job.close()
            self._job = None
            return
        now = self._job.progress()
        if now.state == wovenfit.JobState.RUNNING:
            words = STAGES.get(now.stage_name, now.stage_name)
            energy = "" if now.energy is None else f", energy {now.energy:.1f} N mm"
            self.stage.setText(f"{words}: {100 * now.fraction:.0f} %{energy}")
            stages = list(wovenfit.JobStage)
            at = stages.index(now.stage) + now.fraction
            self.bar.setValue(int(1000 * at / len(stages)))
            return
        job, self._job = self._job, None
        self._running(False)
        with job:
            self._ended(job)

    def _ended(self, job: wovenfit.Job) -> None:
        assert self._inputs is not None
        try:
            self.brace.Proxy.results.keep(self._inputs, job)
        except wovenfit.PreparedForAnother:
            # The limb was cut for other parameters: once more, from the start.
            self.start()
            return
        except wovenfit.Cancelled:
            self.stage.setText("Cancelled: nothing has changed.")
            return
        except Exception as error:  # the reason is for the designer
            self._say_failure(error)
            return
        self._publish()

    def _publish(self) -> None:
        document = self.brace.Document
        document.openTransaction("Flatten")
        for row in properties.parameters():
            value = self.fields[row.key].get()
            if row.read(self.brace) != value:
                row.write(self.brace, value)
        edits.add_shown(self.brace)
        self.brace.touch()
        document.recompute()
        document.commitTransaction()
        if not self.brace.isValid():
            self._say_failure(RuntimeError(self.brace.getStatusString()))
            return
        self.bar.setValue(1000)
        wanted = bool(places.pressures(self.brace))
        met = "all pressures are met" if self.brace.AllPressuresMet else "NOT all pressures are met"
        met = met if wanted else "no pressures are wanted"
        count = len(self.brace.Warnings)
        self.stage.setText(
            f"Done: {self.brace.Width.UserString} by {self.brace.Height.UserString}, {met}, "
            f"{count} warning{'' if count == 1 else 's'}: see Report."
        )

    def _say_failure(self, error: Exception) -> None:
        self.stage.setText(in_words_of_the_host(self.brace, str(error)))
        self.stage.setStyleSheet("color: #b00000")

    def _set_defaults(self) -> None:
        for field in self.fields.values():
            field.set(field.row.default)


class _Number(QtGui.QDoubleSpinBox):
    """Shows a number without the zeros that its many decimals would bring."""

    def textFromValue(self, value: float) -> str:
        return f"{value:g}"


class _Field:
    """What a parameter is changed with."""

    def __init__(self, row: wovenfit.Parameter) -> None:
        self.row = row
        self.tip = f"{row.summary}\n\n{row.paragraph}"
        if row.kind is ParameterKind.NUMBER:
            widget = _Number()
            widget.setDecimals(9)
            widget.setRange(row.least, row.most)
            widget.setSingleStep((row.most - row.least) / 100)
            widget.setSuffix(f" {row.unit}" if row.unit else "")
        elif row.kind is ParameterKind.INTEGER:
            widget = QtGui.QSpinBox()
            widget.setRange(row.least, row.most)
        elif row.kind is ParameterKind.SWITCH:
            widget = QtGui.QCheckBox()
        else:
            widget = QtGui.QComboBox()
            widget.addItems(list(row.choices))
        widget.setToolTip(self.tip)
        self.widget = widget

    def get(self) -> Any:
        """The value."""
        if self.row.kind is ParameterKind.SWITCH:
            return self.widget.isChecked()
        if self.row.kind is ParameterKind.CHOICE:
            return self.widget.currentText()
        return self.widget.value()

    def set(self, value: Any) -> None:
        """Shows a value."""
        if self.row.kind is ParameterKind.SWITCH:
            self.widget.setChecked(value)
        elif self.row.kind is ParameterKind.CHOICE:
            self.widget.setCurrentText(value)
        else:
            self.widget.setValue(value)
