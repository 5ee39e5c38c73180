"""One call from arrays to a pattern, for scripts. Hosts with a window use `Job`."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

from .design import Design
from .job import Job, Progress
from .mesh import Mesh, Unit
from .parameters import Parameters, Value

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

    from .pattern import Pattern


def flatten(  # all but three have a default and a name
    positions: npt.ArrayLike,
    triangles: npt.ArrayLike,
    design: Union[Design, Mapping[str, Any], str],
    *,
    unit: Unit = "mm",
    parameters: Union[Parameters, Mapping[str, Value], None] = None,
    progress: Optional[Callable[[Progress], object]] = None,
    poll_seconds: float = 0.05,
) -> Pattern:
    """Flattens a scanned limb; returns when the pattern is there.

    Args:
        positions: (n, 3) numbers, the places of the vertices in `unit`.
        triangles: (m, 3) whole numbers, three vertices each, counted from 0, counter-clockwise seen
            from outside the limb.
        design: what is wanted: a `Design`, or the contents of a design file as a mapping or as
            JSON, whose coordinates are in `unit` unless it says its "units".
        unit: "mm", "cm", "m", "in", or millimetres.
        parameters: None for the defaults.
        progress: called about every `poll_seconds` from this thread with how far it is. What it
            raises cancels the job and is raised here, as Ctrl-C is.
        poll_seconds: between two calls of `progress`.

    Raises:
        WovenfitError: of the class for what is wrong.
    """
    with ExitStack() as held:
        mesh = held.enter_context(Mesh(positions, triangles, unit))
        if not isinstance(design, Design):
            design = held.enter_context(Design.from_json(design, unit))
        if parameters is not None and not isinstance(parameters, Parameters):
            parameters = held.enter_context(Parameters(**parameters))
        # Closing it cancels it if it still runs.
        job = held.enter_context(Job(mesh, design, parameters))
        while not job.wait(poll_seconds):
            if progress is not None:
                progress(job.progress())
        return job.result()
