"""A pattern on its way: a job that is polled, and the limb that it leaves for the next one.

The library has threads of its own. There is none of Python's: objects of Blender that Python lets
go on another thread than Blender's are not safe.

A warm start goes on from an earlier pattern on the same surface. Where the wishes need another
preparation (seams, region, a setting of the stages before the fit) it starts anew by itself.
"""

from __future__ import annotations

import hashlib
import uuid
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..wovenfit import Job, JobStage, Mesh, PreparedForAnother, WovenfitError
from .wording import STAGES

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ..wovenfit import Design, Parameters, Pattern, Prepared

KEPT = 3
"""Solved limbs that are kept for Update and Export. One of 250,000 triangles takes 0.25 GB."""


def fingerprint(
    positions: npt.NDArray[np.float64], triangles: npt.NDArray[np.uint32], unit: float
) -> str:
    """What tells whether two surfaces are the same to the last bit."""
    found = hashlib.sha256(repr((unit, positions.shape, triangles.shape)).encode())
    found.update(positions.tobytes())
    found.update(triangles.tobytes())
    return found.hexdigest()


@dataclass(frozen=True)
class Solved:
    """A pattern, the limb that it was solved on, and of which surface."""

    pattern: Pattern
    prepared: Prepared
    surface: str
    warm: bool
    """Whether it went on from an earlier pattern."""
    name: str = field(default_factory=lambda: uuid.uuid4().hex)
    """By which the limb in the file refers to it."""


class Memory:
    """The last few solved limbs, by their names: files hold results, not these."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, Solved] = OrderedDict()

    def keep(self, solved: Solved) -> None:
        """Adds one, and lets the oldest go."""
        self._kept[solved.name] = solved
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)

    def find(self, name: str) -> Solved | None:
        """One by its name, if it is still there."""
        return self._kept.get(name)

    def on(self, surface: str) -> Solved | None:
        """The latest on this surface."""
        return next((one for one in reversed(self._kept.values()) if one.surface == surface), None)

    def clear(self) -> None:
        """Lets all go."""
        self._kept.clear()


class Solving:
    """A job on its way to a `Solved`.

    Args:
        mesh: of the surface.
        surface: its fingerprint.
        design: what is wanted.
        parameters: the settings.
        earlier: to go on from; None to begin anew.
    """

    def __init__(
        self,
        mesh: Mesh,
        surface: str,
        design: Design,
        parameters: Parameters,
        earlier: Solved | None,
    ) -> None:
        self._given = mesh, design, parameters
        self._surface = surface
        self.cancelled = False
        self._warm = earlier is not None
        if earlier is None:
            self._job = Job(mesh, design, parameters)
        else:
            self._job = earlier.prepared.start(design, parameters, earlier.pattern)

    def wait(self, seconds: float) -> bool:
        """Waits at most so long; whether it has ended. What it ended with `outcome` says."""
        if not self._job.wait(seconds):
            return False
        if self._warm and not self.cancelled:
            try:
                self._job.result().close()
            except PreparedForAnother:
                self._warm = False
                self._job = Job(*self._given)
                return False
            except WovenfitError:
                return True
        return True

    def progress(self) -> tuple[float, str]:
        """How much is done, from 0 to 1, and what is being done."""
        now = self._job.progress()
        return (now.stage + now.fraction) / (JobStage.REPORT + 1), STAGES[now.stage]

    def cancel(self) -> None:
        """Asks it to stop."""
        self.cancelled = True
        self._job.cancel()

    def outcome(self) -> Solved:
        """What it found, once it has ended.

        Raises:
            WovenfitError: why it found nothing; `Cancelled` if it was asked to stop.
        """
        pattern = self._job.result()
        return Solved(pattern, pattern.prepared(), self._surface, self._warm)

    def close(self) -> None:
        """Stops it if it still runs, and waits for that."""
        self.cancel()
        self._job.close()
