"""What a caller sees of a run, and how it ends one."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import hybrid_quad
from support import surfaces
from support.children import heed_interrupts

BIG = surfaces.torus(400, 160)  # 128,000 triangles: some seconds of work


def test_progress_rises_to_the_end():
    seen = []
    result = hybrid_quad.remesh(*surfaces.torus(150, 60), quads=2000, progress=lambda *step: seen.append(step))
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] == 1
    assert all(isinstance(stage, str) and stage for stage, _ in seen)
    assert len(result.quads)


def test_progress_does_not_flood_the_caller():
    times = []
    hybrid_quad.remesh(*surfaces.torus(150, 60), quads=2000, progress=lambda *_: times.append(time.monotonic()))
    assert len(times) <= 20 * (times[-1] - times[0]) + 3


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.7])
def test_a_request_to_stop_is_answered_within_a_second(share):
    """Asks at a share of the progress: no moment on a clock lies within the run on every machine."""
    reached = [0.0]
    asked = []

    def cancel():
        if reached[-1] < share:
            return False
        asked.append(time.monotonic())
        return True

    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(*BIG, quads=20000, cancel=cancel, progress=lambda _, fraction: reached.append(fraction))
    assert caught.value.code == "cancelled"
    assert time.monotonic() - asked[0] < 1.0


def test_a_request_to_stop_at_any_poll_is_answered_at_once():
    """Stops at twenty random polls of a run; the seconds between two polls are how long an answer may take."""
    mesh = surfaces.together(surfaces.torus(60, 30), surfaces.box(10), surfaces.wavy_grid(20))
    polls = []
    hybrid_quad.remesh(*mesh, quads=1500, cancel=lambda: polls.append(time.monotonic()))
    assert np.diff(polls).max() < 1.0
    for stop in np.random.default_rng(3).integers(0, len(polls) // 2, 20):
        count = iter(range(10**6))
        with pytest.raises(hybrid_quad.Cancelled):
            hybrid_quad.remesh(*mesh, quads=1500, cancel=lambda count=count, stop=stop: next(count) >= stop)


@pytest.mark.slow
def test_twenty_requests_at_random_moments_of_a_long_run_are_answered_within_a_second():
    mesh = surfaces.torus(270, 130)  # 70,200 triangles
    begin = time.monotonic()
    hybrid_quad.remesh(*mesh, quads=8000)
    whole = time.monotonic() - begin
    waits = []
    for moment in np.random.default_rng(7).uniform(0, 0.95 * whole, 20):
        begin = time.monotonic()
        try:
            hybrid_quad.remesh(*mesh, quads=8000, cancel=lambda end=begin + moment: time.monotonic() > end)
        except hybrid_quad.Cancelled:
            waits.append(time.monotonic() - begin - moment)  # from the moment that the wish to stop arose
    assert len(waits) >= 15  # the others ended before
    assert max(waits) < 1.0


def test_the_memory_limit_holds():
    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(*BIG, quads=20000, memory_limit=1)
    assert caught.value.code == "memory_limit"
    assert len(hybrid_quad.remesh(*surfaces.torus(), quads=100, memory_limit=1e6).quads)


def test_the_time_limit_holds():
    begin = time.monotonic()
    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(*BIG, quads=20000, time_limit=0.2)
    assert caught.value.code == "time_limit"
    assert time.monotonic() - begin < 1.2


class Surprise(Exception):
    pass


@pytest.mark.parametrize("callback", ["progress", "cancel", "on_snapshot"])
def test_an_error_in_a_callback_comes_back_unchanged(callback):
    def fail(*_):
        raise Surprise("mine")

    with pytest.raises(Surprise, match="mine"):
        hybrid_quad.remesh(*surfaces.torus(), quads=300, **{callback: fail})


def test_other_threads_run_meanwhile():
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.wait(0.01):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    hybrid_quad.remesh(*surfaces.torus(150, 60), quads=2000)
    seconds = time.monotonic() - begin
    stop.set()
    thread.join()
    assert len(ticks) > 10 * seconds


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupt_ends_the_run():
    code = (
        f"import sys; sys.path.insert(0, {str(surfaces.__file__).rsplit('/support/', 1)[0]!r})\n"
        "from support import surfaces\n"
        "import hybrid_quad\n"
        "mesh = surfaces.torus(400, 160)\n"
        "print('ready', flush=True)\n"
        "try: hybrid_quad.remesh(*mesh, quads=20000)\n"
        "except KeyboardInterrupt: print('interrupted')\n"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, preexec_fn=heed_interrupts
    )
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.4)
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    output, _ = child.communicate(timeout=20)
    assert output == "interrupted\n"
    assert time.monotonic() - begin < 1.5


def test_snapshots_of_every_stage(tmp_path):
    seen = []
    vertices, faces = surfaces.box(8)
    hybrid_quad.remesh(vertices, faces, quads=200, on_snapshot=seen.append, dump_stages=tmp_path / "stages")
    assert len(seen) >= 3
    assert len(list((tmp_path / "stages").glob("*.vtu"))) == len(seen)
    for snapshot in seen:
        assert snapshot.stage
        assert len(snapshot.face_vertices) == snapshot.face_sizes.sum()
        assert snapshot.face_vertices.max() < len(snapshot.points)
        assert np.isfinite(snapshot.points).all()
        assert all(len(values) == len(snapshot.points) for values in snapshot.vertex_values.values())
        assert all(len(values) == len(snapshot.face_sizes) for values in snapshot.face_values.values())
        assert all(values.shape == (len(snapshot.face_sizes), 3) for values in snapshot.face_vectors.values())
