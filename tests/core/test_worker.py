"""A run in a process of its own: the same result, the same errors, and nothing that it does or suffers reaches outside."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

from hybrid_quad import Cancelled, InputError
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.options import RemeshOptions
from hybrid_quad.core.stage_names import in_words
from hybrid_quad.core.strokes import Stroke
from hybrid_quad.worker import process
from hybrid_quad.worker.death import WorkerDied
from hybrid_quad.worker.kinds import load_request
from hybrid_quad.worker.limit_request import LimitRequest
from hybrid_quad.worker.preview_request import PreviewRequest
from hybrid_quad.worker.process import WorkerRun, WorkerSeat
from hybrid_quad.worker.request import RemeshRequest

NO_EDGES = np.zeros((0, 2), np.int32)
PATIENCE = 60  # seconds until a test gives up waiting
needs_signals = pytest.mark.skipif(sys.platform == "win32", reason="signals")


def wave(cells: int = 20, **options) -> RemeshRequest:
    """A wavy square."""
    steps = np.linspace(-1, 1, cells + 1)
    points = np.array([(x, y, 0.2 * np.sin(3 * x)) for y in steps for x in steps])
    corner = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    faces = np.stack([corner, corner + 1, corner + cells + 2, corner + cells + 1], axis=1)
    return RemeshRequest(points, as_polygons(faces), RemeshOptions(**options), NO_EDGES)


@pytest.fixture
def start(tmp_path):
    """Starts runs in a folder that is empty again at the end, with no process left."""
    runs = []

    def begin(request: RemeshRequest, **more) -> WorkerRun:
        runs.append(WorkerRun(request, temporary_folder=str(tmp_path), **more))
        return runs[-1]

    yield begin
    for run in runs:
        run.cancel()
        wait_until(lambda ended=run.process_id: is_gone(ended))
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def long_run(start):
    """A run that is busy, and would be for minutes."""

    def begin(**options) -> WorkerRun:
        run = start(wave(quads=500_000, **options))
        wait_until(lambda: run.poll() or run.fraction > 0)
        assert not run.is_finished
        return run

    return begin


def wait_until(truth) -> None:
    deadline = time.monotonic() + PATIENCE
    while not truth():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def is_gone(process_id: int) -> bool:
    status = Path(f"/proc/{process_id}/stat")
    if sys.platform == "linux":  # where nobody asks for it, the entry of a dead process stays
        return not status.exists() or status.read_text().rpartition(")")[2].split()[0] == "Z"
    try:
        os.kill(process_id, 0)
    except OSError:
        return True
    return False


def test_the_result_is_that_of_a_run_in_this_process(start):
    request = wave(quads=300, sharp_angle=None)
    found, expected = start(request).result(), request.solve()
    for name in ("vertices", "quads", "feature_edges", "feature_curves", "vertex_kinds"):
        ours, theirs = getattr(found, name), getattr(expected, name)
        assert ours.dtype == theirs.dtype and ours.tobytes() == theirs.tobytes(), name
    assert {**found.report, "stages": 0} == {**expected.report, "stages": 0}


def test_a_preview_is_that_of_this_process(start):
    stroke = Stroke(np.array([(-0.5, 0, 0), (0.5, 0.2, 0)]), 1.0)
    run = dataclasses.replace(wave(quads=300, sharp_angle=None), strokes=(stroke,))
    found, expected = (each(PreviewRequest(run, with_quads=True)) for each in (lambda r: start(r).result(), solve))
    for name in ("crosses", "cross_sizes", "features", "quads", "guides", "singular_points", "singular_quarters"):
        assert np.array_equal(getattr(found, name), getattr(expected, name)), name
    assert len(found.crosses) == len(found.cross_sizes) > 300 and len(found.quads) > 300 and len(found.guides) > 1
    assert found.report["wanted_quads"] == pytest.approx(300)


def test_a_limit_surface_is_that_of_this_process(start):
    source, none = wave(), np.zeros(0)
    creases = np.array([(0, 1)], np.int32)
    request = LimitRequest(
        source.vertices,
        source.polygons,
        creases,
        np.ones(1),
        none.astype(np.int32),
        none,
        source.vertices,
        source.polygons,
    )
    found, expected = start(request).result(), request.solve()
    for name in ("vertices", "normals", "quads", "distances"):
        assert np.array_equal(getattr(found, name), getattr(expected, name)), name
    assert 0 < found.distances.max() < 0.1


def test_a_seat_waits_for_its_request_and_can_be_left(start, tmp_path):
    seat, unused = (WorkerSeat(temporary_folder=str(tmp_path)) for _ in range(2))
    time.sleep(0.5)
    assert seat.is_there() and unused.is_there()
    assert len(start(wave(quads=200), seat=seat).result().quads) > 100
    unused.leave()
    assert not unused.is_there() and is_gone(unused.process.pid)


def test_a_worker_that_stays_answers_one_request_after_the_other(start, tmp_path):
    seat = WorkerSeat(stays=True, temporary_folder=str(tmp_path))
    surface = wave(quads=300, sharp_angle=None)
    along = np.tile([1.0, 0.5, 0.0], (len(surface.vertices), 1))
    for run in (surface, dataclasses.replace(surface, guides=along), surface, wave(quads=200)):
        request = PreviewRequest(run, with_quads=True)
        found, expected = start(request, seat=seat).result(), request.solve()
        for name in ("crosses", "cross_sizes", "features", "quads", "guides", "singular_points"):
            assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name
        assert seat.is_there()
    assert seat.requests == 4 and not list(seat.folder.glob("*.npz"))
    seat.leave()


def test_what_is_abandoned_does_not_end_a_worker_that_stays(start, tmp_path):
    seat = WorkerSeat(stays=True, temporary_folder=str(tmp_path))
    long = start(wave(quads=500_000), seat=seat)
    wait_until(lambda: long.poll() or long.fraction > 0)
    long.abandon()
    with pytest.raises(Cancelled):
        long.result()
    unseen = start(wave(quads=200), seat=seat)
    time.sleep(1)
    unseen.abandon()  # which it has ended long ago
    run = start(wave(quads=300), seat=seat)
    assert len(run.result().quads) > 200 and run.process_id == long.process_id
    assert len(start(wave(quads=200), seat=seat).result().quads) < 300
    wait_until(lambda: not list(seat.folder.glob("*.npz")) and not list(seat.folder.glob("stop*")))
    seat.leave()


def test_a_refusal_ends_even_a_worker_that_stays(start, tmp_path):
    seat = WorkerSeat(stays=True, temporary_folder=str(tmp_path))
    broken = wave()
    broken.vertices[3] = np.nan
    with pytest.raises(InputError):
        start(broken, seat=seat).result()
    assert not seat.is_there()


def solve(request):
    return request.solve()


def test_a_request_is_read_as_it_was_written(tmp_path):
    random = np.random.default_rng(5)
    base = wave(cells=3)
    request = RemeshRequest(
        random.normal(size=(16, 3)) * 10.0 ** random.integers(-12, 12, (16, 1)),
        base.polygons,
        RemeshOptions(
            quads=int(np.int64(77)),
            sharp_angle=None,
            symmetry="xz",
            symmetry_center=(0.1, np.float64(0.2), 3),
            time_limit=1e9,
        ),
        np.array([(0, 1), (1, 2)], np.int32),
        curve_counts=[([0, 1, 2], 4)],
        guides=random.normal(size=(9, 3)),
        guides_of_faces=True,
        strokes=(Stroke(random.normal(size=(5, 3)), 0.3), Stroke(random.normal(size=(2, 3)), 1.0, "ring")),
        stroke_radius=0.1,
        density=random.uniform(size=16),
    )
    request.save(tmp_path / "request.npz")
    found = load_request(tmp_path / "request.npz")
    for name in ("vertices", "sharp_edges", "guides", "density"):
        assert getattr(found, name).tobytes() == getattr(request, name).tobytes(), name
    assert all(np.array_equal(a, b) for a, b in zip(found.polygons, request.polygons, strict=True))
    assert found.options == request.options
    assert found.curve_counts == request.curve_counts
    assert (found.guides_of_faces, found.stroke_radius) == (True, 0.1)
    assert [(s.points.tobytes(), s.strength, s.kind) for s in found.strokes] == [
        (s.points.tobytes(), s.strength, s.kind) for s in request.strokes
    ]


def test_progress_arrives_and_never_falls(start):
    run = start(wave(quads=3000))
    seen = []
    while not run.poll():
        seen.append((run.fraction, run.stage))
        time.sleep(0.005)
    assert run.has_result
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions) and run.fraction == 1
    assert len({stage for _, stage in seen}) > 2


def test_a_refusal_keeps_its_code_and_elements(start):
    request = wave()
    request.vertices[[3, 17]] = np.nan
    with pytest.raises(InputError) as here:
        request.solve()
    with pytest.raises(InputError) as there:
        start(request).result()
    assert str(there.value) == str(here.value)
    for name in ("code", "element_kind", "elements"):
        assert getattr(there.value, name) == getattr(here.value, name) != ()


def test_wrong_arguments_are_told(start):
    request = RemeshRequest(*wave().__dict__.values())
    object.__setattr__(request, "density", np.ones(3))
    with pytest.raises(ValueError, match="density must be of shape"):
        start(request).result()


@needs_signals
@pytest.mark.parametrize("number", [getattr(signal, name, None) for name in ("SIGKILL", "SIGSEGV", "SIGABRT")])
def test_a_worker_that_dies_is_an_error_that_names_stage_and_cause(long_run, number):
    run = long_run()
    os.kill(run.process_id, number)
    with pytest.raises(WorkerDied) as caught:
        run.result()
    assert caught.value.status == -number and caught.value.stage == run.stage
    assert in_words(run.stage) in str(caught.value) and number.name in str(caught.value)
    assert number == signal.SIGKILL or "Fatal Python error" in caught.value.log


def test_cancelling_kills_a_busy_worker(long_run):
    run = long_run()
    run.cancel()
    with pytest.raises(Cancelled, match="cancelled while") as caught:
        run.result()
    assert caught.value.code == "cancelled" and in_words(run.stage) in str(caught.value)
    wait_until(lambda: is_gone(run.process_id))


@needs_signals
def test_cancelling_kills_a_worker_that_hangs(long_run):
    run = long_run()
    os.kill(run.process_id, signal.SIGSTOP)
    run.cancel()
    with pytest.raises(Cancelled):
        run.result()
    wait_until(lambda: is_gone(run.process_id))


@pytest.mark.skipif(sys.platform != "linux", reason="knows a dead process that nobody asked for")
def test_a_worker_does_not_wait_for_who_asks(start):
    run = start(wave(quads=3000))
    wait_until(lambda: is_gone(run.process_id))  # it has said everything, and nobody has listened
    assert run.poll() and run.has_result and run.fraction == 1


def test_cancelling_what_is_finished_changes_nothing(start):
    run = start(wave(quads=100))
    quads = run.result().quads
    run.cancel()
    assert run.result().quads is quads


def test_the_time_limit_ends_a_run(start):
    with pytest.raises(Cancelled) as caught:
        start(wave(quads=500_000, time_limit=0.5)).result()
    assert caught.value.code == "time_limit"


@needs_signals
def test_the_time_limit_ends_a_worker_that_hangs(start, monkeypatch):
    monkeypatch.setattr(process, "_GRACE", 2.0 - 1000.0)
    run = start(wave(quads=500_000, time_limit=1000.0))
    os.kill(run.process_id, signal.SIGSTOP)
    with pytest.raises(Cancelled, match="did not answer") as caught:
        run.result()
    assert caught.value.code == "time_limit" and in_words(run.stage) in str(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="knows how much processors are used")
def test_a_worker_that_hangs_is_ended_with_an_error_that_names_the_stage(long_run, monkeypatch):
    monkeypatch.setattr(process, "_HANGS", 1.0)
    run = long_run()
    os.kill(run.process_id, signal.SIGSTOP)
    with pytest.raises(WorkerDied, match="it hung") as caught:
        run.result()
    assert in_words(run.stage) in str(caught.value)
    wait_until(lambda: is_gone(run.process_id))


@pytest.mark.skipif(sys.platform != "linux", reason="knows how much processors are used")
def test_a_worker_that_is_busy_does_not_hang(long_run, monkeypatch):
    monkeypatch.setattr(process, "_HANGS", 1.0)
    run = long_run()
    assert not run.wait(3.0)


def test_the_memory_limit_is_the_workers_own(start):
    run = start(wave(quads=500_000, memory_limit=150))
    with pytest.raises(Cancelled, match="memory limit") as caught:
        run.result()
    assert caught.value.code == "memory_limit" and in_words(run.stage) in str(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="prlimit")
def test_where_no_memory_is_left_the_run_says_so(long_run):
    import resource

    run = long_run()
    used = int(Path(f"/proc/{run.process_id}/statm").read_text().split()[0]) * resource.getpagesize()
    limit = used + 4 * 2**20  # for the stack, which ends a process without a word where it can't grow
    resource.prlimit(run.process_id, resource.RLIMIT_AS, (limit, limit))
    with pytest.raises((MemoryError, WorkerDied)) as caught:
        run.result()
    assert in_words(run.stage) in str(caught.value)
    assert isinstance(caught.value, MemoryError) or "memory ran out" in str(caught.value)


def test_a_program_that_is_no_worker_is_an_error(start):
    script = "import sys; print('hello'); print('{\"no\": 1}'); print('what went wrong', file=sys.stderr); sys.exit(3)"
    with pytest.raises(WorkerDied, match=r"while starting.*exit status 3") as caught:
        start(wave(), command=[sys.executable, "-c", script]).result()
    assert "what went wrong" in caught.value.log
    with pytest.raises(OSError):
        start(wave(), command=["/no/such/program"]).result()


def test_a_program_that_dies_for_want_of_memory_is_told_so(start):
    script = "import os, sys; print('terminate called: std::bad_alloc', file=sys.stderr, flush=True); os.abort()"
    with pytest.raises(WorkerDied, match="memory ran out"):
        start(wave(), command=[sys.executable, "-c", script]).result()


@needs_signals
def test_a_worker_ends_with_the_program_that_wants_its_result(tmp_path):
    script = tmp_path / "parent.py"
    script.write_text(
        textwrap.dedent(f"""
        import sys, time
        sys.path[:0] = {[str(Path(process.__file__).parents[2]), str(Path(__file__).parent)]}
        from test_worker import WorkerRun, wave
        run = WorkerRun(wave(quads=500_000), temporary_folder={str(tmp_path)!r})
        while run.fraction == 0 and not run.poll():
            time.sleep(0.01)
        print(run.process_id, flush=True)
        time.sleep({PATIENCE})
        """)
    )
    with subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True) as parent:
        worker = int(parent.stdout.readline())
        assert not is_gone(worker)
        parent.kill()
    wait_until(lambda: is_gone(worker))
    assert list(tmp_path.iterdir()) == [script]
