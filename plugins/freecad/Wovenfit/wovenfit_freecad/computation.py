"""From a brace's properties to a pattern: what goes in, and results that are kept while they serve.

The same inputs give the same pattern, whatever was computed before: a document recomputed step by
step and one recomputed at once agree to the last digit.
"""

from __future__ import annotations

import hashlib
import json
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import wovenfit

from . import places, properties
from .quantities import LENGTH, number
from .source import Surface, surface_of


@dataclass(frozen=True)
class Inputs:
    """Everything that a pattern depends on."""

    surface: Surface
    design: dict[str, Any]
    """By the keys of a design file, in mm and kPa."""
    parameters: dict[str, Any]
    """By the names of the table."""
    limb_key: str
    """Stands for the surface."""
    key: str
    """Stands for all of it, and the library's version."""

    def start(self, limb: wovenfit.Prepared | None = None) -> wovenfit.Job:
        """Starts a job, on a prepared limb if there is one.

        Raises:
            wovenfit.WovenfitError: for what the library refuses at once.
        """
        with ExitStack() as held:
            design = held.enter_context(wovenfit.Design.from_json(self.design, "mm"))
            values = held.enter_context(wovenfit.Parameters(**self.parameters))
            if limb is not None:
                return limb.start(design, values)
            mesh = held.enter_context(wovenfit.Mesh(*self.surface, "mm"))
            return wovenfit.Job(mesh, design, values)


def inputs_of(brace: Any, changed: dict[str, Any] | None = None) -> Inputs:
    """What a brace's properties say.

    Args:
        brace: the object.
        changed: values of parameters, by their names, to take instead of the properties.

    Raises:
        ValueError: if a property cannot be; the text names it.
    """
    surface = surface_of(brace.Source, number(brace.EdgeLength, LENGTH))
    design = design_of(brace)
    values = {row.key: row.read(brace) for row in properties.parameters()}
    values.update(changed or {})
    limb = hashlib.sha256(surface.positions.tobytes())
    limb.update(surface.triangles.tobytes())
    limb_key = limb.hexdigest()
    said = json.dumps([wovenfit.version(), limb_key, design, values], sort_keys=True)
    return Inputs(surface, design, values, limb_key, hashlib.sha256(said.encode()).hexdigest())


def design_of(brace: Any) -> dict[str, Any]:
    """A brace's wishes by the keys of a design file, in mm and kPa."""
    design: dict[str, Any] = {"units": "mm", **places.read(brace)}
    for row in properties.wishes():
        value = row.read(brace)
        if value is not None:
            _put(design, row.key, value)
    if places.bony(brace):
        _put(design, "limits.bony", places.bony(brace))
    return design


def _put(design: dict[str, Any], key: str, value: Any) -> None:
    *path, last = key.split(".")
    for name in path:
        design = design.setdefault(name, {})
    design[last] = value


class Results:
    """The last pattern of a brace and the limb that was cut open for it. Never saved."""

    def __init__(self) -> None:
        self._key = ""
        self._pattern: wovenfit.Pattern | None = None
        self._limb_key = ""
        self._limb: wovenfit.Prepared | None = None

    def has(self, inputs: Inputs) -> bool:
        """Whether the pattern for these inputs is at hand."""
        return self.held(inputs.key) is not None

    def held(self, key: str) -> wovenfit.Pattern | None:
        """The pattern for the inputs of this key, if it is at hand."""
        return self._pattern if key and key == self._key else None

    def start(self, inputs: Inputs) -> wovenfit.Job:
        """Starts a job: on the limb that is cut open, if it is this one."""
        return inputs.start(self._limb if self._limb_key == inputs.limb_key else None)

    def keep(self, inputs: Inputs, job: wovenfit.Job) -> wovenfit.Pattern:
        """The job's pattern, kept.

        Raises:
            wovenfit.WovenfitError: if it has none. `PreparedForAnother` means that the job must be
                started again: the limb it started on is then forgotten.
        """
        try:
            pattern = job.result()
        except wovenfit.PreparedForAnother:
            self._limb, self._limb_key = None, ""
            raise
        self._key, self._pattern = inputs.key, pattern
        self._limb, self._limb_key = pattern.prepared(), inputs.limb_key
        return pattern

    def compute(self, inputs: Inputs) -> wovenfit.Pattern:
        """The pattern, at hand or computed now.

        Raises:
            wovenfit.WovenfitError: for what cannot be flattened.
        """
        held = self.held(inputs.key)
        if held is not None:
            return held
        for _ in range(2):
            with self.start(inputs) as job:
                try:
                    return self.keep(inputs, job)
                except wovenfit.PreparedForAnother:
                    continue
        raise AssertionError("a job on no prepared limb was refused for it")
