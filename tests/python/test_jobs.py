"""Jobs: progress, cancel, two at once, the free interpreter, solving again."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import wovenfit
from limbs import Tube, arm
from wovenfit import JobStage, JobState, calls


@pytest.fixture(scope="module")
def long_work() -> tuple[wovenfit.Mesh, wovenfit.Design]:
    """100,000 triangles: seconds of work."""
    positions, triangles = arm(100_000)
    mesh = wovenfit.Mesh(positions, triangles)
    assert 95_000 < mesh.triangle_count < 105_000
    design = wovenfit.Design()
    design.add_pressures_at_vertices(mesh, [20_000, 30_000], [2.0, 1.5])
    return mesh, design


def test_a_job_goes_from_waiting_to_done(mesh: wovenfit.Mesh, design: wovenfit.Design) -> None:
    with wovenfit.Job(mesh, design) as job:
        seen = []
        while not job.done:
            seen.append(job.progress())
        assert job.wait()
        last = job.progress()
        assert last.state is JobState.DONE
        assert last.stage is JobStage.REPORT
        assert last.stage_name == "report"
        assert last.energy is not None
        assert [now.stage for now in seen] == sorted(now.stage for now in seen)
        assert all(0.0 <= now.fraction <= 1.0 for now in seen)
        assert all(now.energy is None for now in seen if now.stage < JobStage.FIT)
        assert "done" in repr(job)
        assert job.result().file("worn.obj") == job.result().file("worn.obj")
    assert job.closed
    assert "closed" in repr(job)
    with pytest.raises(ValueError, match="this Job is closed"):
        job.progress()


def test_stage_names_are_the_librarys() -> None:
    lib = wovenfit.library.library()
    for stage in JobStage:
        now = wovenfit.Progress(JobState.RUNNING, stage, 0.0, None)
        assert lib.wovenfit_stage_name(stage).decode() == now.stage_name


def test_status_names_are_the_librarys() -> None:
    lib = wovenfit.library.library()
    for status in wovenfit.Status:
        assert lib.wovenfit_status_name(status).decode() == status.name.lower()


def test_what_was_given_may_be_closed_at_once(limb: Tube, design: wovenfit.Design) -> None:
    with wovenfit.Mesh(limb.positions, limb.triangles) as mesh, design.copy() as wishes:
        job = wovenfit.Job(mesh, wishes)
    expected = wovenfit.flatten(limb.positions, limb.triangles, design)
    assert job.result().file("worn.obj") == expected.file("worn.obj")


def test_what_is_changed_later_does_not_reach_a_job(
    mesh: wovenfit.Mesh, design: wovenfit.Design
) -> None:
    job = wovenfit.Job(mesh, design)
    design.clear("pressures")
    assert len(job.result().pressures) == 1


def test_a_long_job_is_cancelled_and_says_so(
    long_work: tuple[wovenfit.Mesh, wovenfit.Design],
) -> None:
    job = wovenfit.Job(*long_work)
    assert not job.wait(0)
    assert not job.done
    with pytest.raises(wovenfit.TimedOut, match="still runs"):
        job.result(timeout=0)
    job.cancel()
    assert job.wait()
    assert job.progress().state is JobState.CANCELLED
    for _ in range(2):
        with pytest.raises(wovenfit.Cancelled):
            job.result()
    # Once it has ended there is nothing to stop.
    job.cancel()


def test_a_long_wait_leaves_the_interpreter_free(
    long_work: tuple[wovenfit.Mesh, wovenfit.Design],
) -> None:
    job = wovenfit.Job(*long_work)
    counted = 0

    def count_and_cancel() -> None:
        nonlocal counted
        while counted < 10_000 and not job.done:
            counted += 1
        job.cancel()

    thread = threading.Thread(target=count_and_cancel)
    thread.start()
    # One call into the library that ends with the job. Were the interpreter held by it, the thread
    # could not count, nor cancel, and the job would end with a pattern.
    with job._lent() as address:
        calls.call("wovenfit_job_wait", address, -1.0)
    thread.join()
    assert counted == 10_000
    with pytest.raises(wovenfit.Cancelled):
        job.result()


def test_a_job_that_is_forgotten_ends(long_work: tuple[wovenfit.Mesh, wovenfit.Design]) -> None:
    job = wovenfit.Job(*long_work)
    finalizer = job._owned.finalizer
    assert finalizer.alive
    del job
    gc.collect()
    # Freed, for which it was cancelled and waited for.
    assert not finalizer.alive


def test_closing_a_job_while_others_wait_for_it(
    long_work: tuple[wovenfit.Mesh, wovenfit.Design],
) -> None:
    job = wovenfit.Job(*long_work)
    with ThreadPoolExecutor(3) as pool:
        waiting = [pool.submit(job.result) for _ in range(3)]
        assert not any(one.done() for one in waiting)
        job.close()
        for one in waiting:
            with pytest.raises(ValueError, match="this Job is closed"):
                one.result()


def test_an_object_stays_for_the_calls_that_are_under_way(mesh: wovenfit.Mesh) -> None:
    finalizer = mesh._owned.finalizer
    with mesh._lent():
        mesh.close()
        assert finalizer.alive
    assert not finalizer.alive
    with pytest.raises(ValueError, match="this Mesh is closed"), mesh._lent():
        pass


def test_an_exception_that_is_kept_keeps_no_object() -> None:
    design = wovenfit.Design()
    finalizer = design._owned.finalizer
    with pytest.raises(wovenfit.DesignError) as kept:
        design.set("fabric.wrap", 1.0)
    design.close()
    assert not finalizer.alive
    assert "wrap" in str(kept.value)


def test_the_interpreter_ends_while_a_job_runs() -> None:
    script = (
        "import wovenfit; from limbs import arm; mesh = wovenfit.Mesh(*arm(100_000)); "
        "job = wovenfit.Job(mesh, wovenfit.Design()); assert not job.done"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=Path(__file__).parent,
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert (done.returncode, done.stdout) == (0, b"")


def test_two_jobs_at_once_give_the_bytes_of_one_after_the_other(limb: Tube) -> None:
    def files(kpa: float) -> dict[str, bytes]:
        design = wovenfit.Design()
        design.add_pressures([limb.at(2.0, 30.0), limb.at(4.0, 60.0)], [kpa, 2.0])
        pattern = wovenfit.flatten(limb.positions, limb.triangles, design)
        return {name: pattern.file(name) for name in wovenfit.FILES}

    wanted = [1.5, 1.9]
    one_by_one = [files(kpa) for kpa in wanted]
    together = threading.Barrier(2)

    def at_once(kpa: float) -> dict[str, bytes]:
        together.wait()
        return files(kpa)

    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(at_once, wanted)) == one_by_one
    assert one_by_one[0]["worn.obj"] != one_by_one[1]["worn.obj"]


def test_one_pattern_is_read_by_many_threads(mesh: wovenfit.Mesh, design: wovenfit.Design) -> None:
    pattern = wovenfit.Job(mesh, design).result()

    def read(_: int) -> tuple[bytes, bytes, bytes]:
        return (
            pattern.file("report.html"),
            pattern.given_pressure_kpa.tobytes(),
            pattern.coordinates.tobytes(),
        )

    with ThreadPoolExecutor(4) as pool:
        assert len(set(pool.map(read, range(8)))) == 1


def test_solving_again_gives_the_changed_pressures_pattern(
    mesh: wovenfit.Mesh, limb: Tube, design: wovenfit.Design
) -> None:
    job = wovenfit.Job(mesh, design)
    first = job.result()
    assert first.figures.width_mm == pytest.approx(limb.girth / 1.18, rel=0.01)
    again = wovenfit.Design()
    again.set_fabric(warp=0.5, weft=0.5, diagonal=0.05)
    again.add_pressures([limb.at(2.0, 45.0)], 3.0)
    for prepared in (job.prepared(), first.prepared()):
        for earlier in (None, first):
            second = prepared.start(again, earlier=earlier).result()
            assert second.figures.width_mm == pytest.approx(limb.girth / 1.27, rel=0.01)
            assert second.pressures[0].got_kpa == pytest.approx(3.0, rel=0.01)
            assert second.figures.converged
    # Objects stand alone.
    kept = second.prepared()
    second.close()
    job.close()
    assert kept.start(design).result().file("worn.obj") == first.file("worn.obj")


def test_a_prepared_limb_refuses_another_region_and_other_parameters(
    mesh: wovenfit.Mesh, design: wovenfit.Design
) -> None:
    prepared = wovenfit.Job(mesh, design).result().prepared()
    with pytest.raises(wovenfit.PreparedForAnother, match="girth-step"):
        prepared.start(design, wovenfit.Parameters(girth_step=5.0)).result()
    bounded = design.copy()
    bounded.add_region_plane([0, 0, 70], [0, 0, -1])
    with pytest.raises(wovenfit.PreparedForAnother, match="region"):
        prepared.start(bounded).result()


def test_an_earlier_pattern_of_another_limb_is_refused(
    mesh: wovenfit.Mesh, design: wovenfit.Design
) -> None:
    prepared = wovenfit.Job(mesh, design).result().prepared()
    other = wovenfit.Job(mesh, design).result()
    with pytest.raises(wovenfit.InvalidArgument, match="another prepared limb"):
        prepared.start(design, earlier=other)


def test_a_job_that_failed_before_has_no_prepared_limb(limb: Tube) -> None:
    mesh = wovenfit.Mesh(limb.positions[:, :], limb.triangles[:0])
    job = wovenfit.Job(mesh, wovenfit.Design())
    job.wait()
    assert job.progress().state is JobState.FAILED
    with pytest.raises(wovenfit.NotReady):
        job.prepared()


def test_flatten_reports_progress_in_the_callers_thread(limb: Tube) -> None:
    positions, triangles = arm(20_000)
    wishes = {"pressures": [{"at": positions[5_000].tolist(), "kpa": 1.5}]}
    threads, stages = set(), []

    def show(now: wovenfit.Progress) -> None:
        threads.add(threading.get_ident())
        stages.append(now.stage)

    pattern = wovenfit.flatten(positions, triangles, wishes, progress=show, poll_seconds=0.001)
    assert threads == {threading.get_ident()}
    assert stages == sorted(stages)
    assert len(set(stages)) > 1
    silent = wovenfit.flatten(positions, triangles, wishes, parameters={"spacing": 5.0})
    assert silent.file("worn.obj") == pattern.file("worn.obj")


@pytest.mark.parametrize("kind", [RuntimeError, KeyboardInterrupt])
def test_what_the_progress_callback_raises_cancels(kind: type[BaseException]) -> None:
    positions, triangles = arm(100_000)

    def stop(now: wovenfit.Progress) -> None:
        raise kind("enough")

    with pytest.raises(kind, match="enough"):
        wovenfit.flatten(positions, triangles, wovenfit.Design(), progress=stop, poll_seconds=0.001)
