"""Measures how soon a job ends after cancel(), at many moments of the run: not a test.

    python tests/python/cancel_latency.py [--triangles 100000] [--cancels 40] [--method newton]

Runs a bent limb with six pressures once to its end, and notes when each stage begins. Then starts
it again and again and cancels it at moments spread evenly over the run, and besides just after the
beginning of every stage. Prints how long each took to end, and the worst of each stage.
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np
import wovenfit
from limbs import arm

TARGET_SECONDS = 0.2


def design(positions: np.ndarray, mesh: wovenfit.Mesh) -> wovenfit.Design:
    """Six pressures along and round the limb."""
    wanted = wovenfit.Design()
    share = np.array([0.2, 0.3, 0.45, 0.55, 0.7, 0.8])
    vertices = (share * len(positions)).astype(np.uint32)
    wanted.add_pressures_at_vertices(mesh, vertices, [1.5, 2.0, 1.8, 2.2, 2.0, 1.6])
    return wanted


def run_to_the_end(job: wovenfit.Job) -> list[tuple[str, float]]:
    """The stages with the moments at which they were seen to begin, and the end."""
    start, stages = time.perf_counter(), []
    while not job.wait(0.001):
        name = job.progress().stage_name
        if not stages or stages[-1][0] != name:
            stages.append((name, time.perf_counter() - start))
    return [*stages, ("end", time.perf_counter() - start)]


def cancel_at(job: wovenfit.Job, moment: float) -> tuple[str, float, bool]:
    """The stage in which it was cancelled, the seconds until it ended, and whether it heard."""
    if job.wait(moment):
        return "end", 0.0, False
    stage = job.progress().stage_name
    start = time.perf_counter()
    job.cancel()
    job.wait()
    return stage, time.perf_counter() - start, job.progress().state.name == "CANCELLED"


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--triangles", type=int, default=100_000)
    parser.add_argument("--cancels", type=int, default=40)
    parser.add_argument("--method", default="newton")
    options = parser.parse_args()

    positions, triangles = arm(options.triangles)
    mesh = wovenfit.Mesh(positions, triangles)
    wanted = design(positions, mesh)
    parameters = wovenfit.Parameters(method=options.method)

    def start() -> wovenfit.Job:
        return wovenfit.Job(mesh, wanted, parameters)

    stages = run_to_the_end(start())
    total = stages[-1][1]
    print(f"{mesh}, {options.method}: {total:.2f} s in all")
    for (name, begins), (_, ends) in zip(stages, stages[1:]):
        print(f"  {name:16} {ends - begins:6.3f} s")

    moments = [total * (i + 0.5) / options.cancels for i in range(options.cancels)]
    moments += [begins + 0.003 for _, begins in stages[:-1]]
    latencies: dict[str, list[float]] = {}
    for moment in sorted(moments):
        stage, seconds, heard = cancel_at(start(), moment)
        print(
            f"  cancelled at {moment:6.3f} s in {stage:16} ended after {seconds:.3f} s"
            f"{'' if heard else ', with a result'}"
        )
        latencies.setdefault(stage, []).append(seconds)

    print(f"{'stage':16} {'cancels':>7} {'median':>8} {'worst':>8}")
    for stage, seconds in latencies.items():
        print(
            f"{stage:16} {len(seconds):7} {statistics.median(seconds):7.3f}s {max(seconds):7.3f}s"
        )
    worst, stage = max((max(seconds), stage) for stage, seconds in latencies.items())
    kept = "kept" if worst <= TARGET_SECONDS else "missed"
    print(f"worst: {worst:.3f} s in {stage}; the aim of {TARGET_SECONDS} s is {kept}")


if __name__ == "__main__":
    main()
