"""A computation that runs while the caller does something else, and the limb that it prepares."""

from __future__ import annotations

import ctypes
import math
import time
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

from . import calls
from .abi import JobStage, JobState
from .check import Check
from .errors import SurfaceError, TimedOut
from .handle import Handle, lent
from .pattern import Pattern
from .signatures import JobProgress

if TYPE_CHECKING:
    from .design import Design
    from .mesh import Mesh
    from .notes import Defect
    from .parameters import Parameters


@dataclass(frozen=True)
class Progress:
    """How far a job is."""

    state: JobState
    stage: JobStage
    fraction: float
    """How much of the stage is done, from 0 to 1."""
    energy: Optional[float]
    """The fit's energy in N mm; None before the fit."""

    @property
    def stage_name(self) -> str:
        """The stage's short name, such as "surface"."""
        return self.stage.name.lower()


class Job(Handle):
    """The way from a mesh and a design to a pattern, on a thread of its own that starts at once.

    A host's thread polls `progress` from its timer and calls `result` when `done`; nothing is
    called back from other threads. Any thread may use a job. What is given may be changed and
    closed while it runs. A job that is closed, or that nothing refers to any more, is cancelled,
    and waited for.

    Args:
        mesh: the scanned limb.
        design: what is wanted.
        parameters: None for the defaults.

    Raises:
        InvalidArgument: if the parameter `units` or the region's triangles are for another mesh.
    """

    _free = "wovenfit_job_free"

    def __init__(self, mesh: Mesh, design: Design, parameters: Optional[Parameters] = None) -> None:
        with ExitStack() as held:
            given = held.enter_context(lent(mesh))
            wishes = held.enter_context(lent(design))
            values = held.enter_context(lent(parameters))
            super().__init__(calls.new("wovenfit_job_start", given, wishes, values))
            # For the defects, if there are any; the caller may change and close his.
            then = design.copy(), None if parameters is None else parameters.copy()
        self._checked = (mesh._again(), *then)

    @classmethod
    def _on(
        cls,
        prepared: Prepared,
        earlier: Optional[Pattern],
        design: Design,
        parameters: Optional[Parameters],
    ) -> Job:
        job = cls.__new__(cls)
        with ExitStack() as held:
            given = [held.enter_context(lent(h)) for h in (prepared, earlier, design, parameters)]
            Handle.__init__(job, calls.new("wovenfit_job_start_prepared", *given))
        return job

    def progress(self) -> Progress:
        """How far it is, at this moment. Never waits."""
        now = JobProgress()
        with self._lent() as address:
            calls.call("wovenfit_job_poll", address, ctypes.byref(now))
        energy = None if math.isnan(now.energy) else now.energy
        return Progress(JobState(now.state), JobStage(now.stage), now.fraction, energy)

    @property
    def done(self) -> bool:
        """Whether it has ended, however it did."""
        return self.progress().state != JobState.RUNNING

    def cancel(self) -> None:
        """Asks it to stop, and does not wait. It ends soon after, with `Cancelled`."""
        with self._lent() as address:
            calls.call("wovenfit_job_cancel", address)

    def wait(self, timeout: Optional[float] = None) -> bool:
        """Waits until it has ended, however it did, or for `timeout` seconds; whether it has ended.

        Other threads run meanwhile, and Ctrl-C is heard.
        """
        # Signals are heard between calls only.
        slice_seconds = 0.1
        end = math.inf if timeout is None else time.monotonic() + timeout
        while True:
            left = max(0.0, min(slice_seconds, end - time.monotonic()))
            try:
                with self._lent() as address:
                    calls.call("wovenfit_job_wait", address, left)
            except TimedOut:
                if time.monotonic() >= end:
                    return False
            else:
                return True

    def result(self, timeout: Optional[float] = None) -> Pattern:
        """Waits for the pattern. May be asked again, from any thread.

        Raises:
            TimedOut: if it still runs after `timeout` seconds.
            Cancelled: if it was cancelled.
            SurfaceError: if the mesh is broken; its `defects` say where.
            WovenfitError: of another class, if the mesh, the design or both cannot be flattened.
        """
        if not self.wait(timeout):
            raise TimedOut(f"the job still runs after {timeout} s")
        try:
            with self._lent() as address:
                return Pattern(calls.new("wovenfit_job_result", address))
        except SurfaceError as error:
            error._find_defects = self._defects
            raise

    def prepared(self) -> Prepared:
        """The limb that it cut open, to solve again on; there even where the fit failed.

        Raises:
            NotReady: before it is there, also if the job ended before.
        """
        with self._lent() as address:
            return Prepared(calls.new("wovenfit_job_prepared", address))

    def _defects(self) -> tuple[Defect, ...]:
        with Check(*self._checked) as check:
            return check.defects

    def __repr__(self) -> str:
        if self.closed:
            return "<Job, closed>"
        now = self.progress()
        return f"<Job {now.state.name.lower()}, {now.stage_name} {100 * now.fraction:.0f} %>"


class Prepared(Handle):
    """A limb that is cut open: what does not change with pressures, fabric and orientation.

    A job or a pattern gives it. It never changes: any thread may use it.
    """

    _free = "wovenfit_prepared_free"

    def start(
        self,
        design: Design,
        parameters: Optional[Parameters] = None,
        earlier: Optional[Pattern] = None,
    ) -> Job:
        """Starts a job after a changed pressure, fabric or orientation: a part of the time.

        Args:
            design: what is wanted now. One that needs another preparation (region, seams, facing,
                unit) ends the job with `PreparedForAnother`, as parameters of the stages before the
                fit do.
            parameters: None for the defaults.
            earlier: a pattern on this limb; the fit then starts from it.
        """
        return Job._on(self, earlier, design, parameters)
