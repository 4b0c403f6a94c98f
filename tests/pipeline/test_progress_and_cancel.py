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
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.stage_names import StageWatch
from hybrid_quad.core.surface_points import fan_triangles
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


def silences(mesh, **options):
    """A run on one thread, and how long it did not ask whether to stop: seconds of its own, each with the stage told last.

    Processor time, so that a busy machine makes nothing longer; what comes before the first question and after the last
    counts too. A stage is told at most every 50 ms, so that short ones are only in the report.
    """
    watch = StageWatch()
    stages, times = [watch.stage], [time.process_time()]

    def cancel():
        stages.append(watch.stage)
        times.append(time.process_time())

    result = hybrid_quad.remesh(*mesh, threads=1, progress=watch, cancel=cancel, **options)
    return result, list(zip(np.diff([*times, time.process_time()]), stages, strict=True))


def answer(mesh, moment, **options):
    """Whether a run on one thread heeds a wish to stop that arises `moment` seconds of its own time after its begin, and
    how much later it ends, which is negative where it had ended before."""
    asked = time.process_time() + moment
    try:
        hybrid_quad.remesh(*mesh, threads=1, cancel=lambda: time.process_time() >= asked, **options)
    except hybrid_quad.Cancelled:
        return True, time.process_time() - asked
    return False, time.process_time() - asked


def triangles_of(path):
    vertices, polygons = read_mesh(path)
    return vertices, fan_triangles(polygons)


def roughened(vertices, faces, share):
    """With every vertex off its place by a share of the size, and with faces that are turned over or there twice."""
    random = np.random.default_rng(1)
    rough = vertices + share * np.ptp(vertices) * random.standard_normal(vertices.shape)
    dirty = np.concatenate([faces, faces[random.choice(len(faces), 20, replace=False)]])
    turned = random.choice(len(faces), 40, replace=False)
    dirty[turned] = dirty[turned, ::-1]
    return rough, dirty


@pytest.fixture
def cad_part(models):
    return triangles_of(models / "c3d_fandisk.obj")


@pytest.fixture
def dirty_model(models):
    return roughened(*triangles_of(models / "c3d_spot_triangulated.obj"), 0.003)


USUAL_STAGES = {
    *("mesh", "features and sizes", "working surface", "frame field", "sizing", "periodic field"),
    *("spanning parameterization", "regular quads", "singular patches", "assemble", "improve", "quality"),
}


def assert_never_silent(result, silent, stages):
    assert {stage["name"] for stage in result.report["stages"]} == stages
    seconds, stage = max(silent)
    assert seconds < 1.0, f"silent for {seconds:.2f} s of processor time in or after {stage!r}"


def test_no_stage_of_a_part_with_features_is_silent_for_a_second(cad_part):
    guide = hybrid_quad.Stroke(np.linspace((0.9, 14.9, 0.0), (2.1, 15.2, 0.0), 8), kind="loop")  # on its flat side
    result, silent = silences(cad_part, quads=8000, symmetry="auto", fit_limit_surface=True, strokes=[guide])
    assert_never_silent(result, silent, USUAL_STAGES | {"symmetry", "hard guides", "limit surface"})


def test_no_stage_of_a_dirty_model_that_is_mended_is_silent_for_a_second(dirty_model):
    result, silent = silences(dirty_model, quads=4000)
    assert {defect["code"] for defect in result.report["defects"]} == {"duplicate_face", "flipped_face"}
    assert result.report["repairs"]["mended_places"] > 0
    assert_never_silent(result, silent, USUAL_STAGES | {"count"})


def test_no_stage_of_many_triangles_is_silent_for_a_second():
    assert_never_silent(*silences(BIG, quads=20000), USUAL_STAGES | {"count"})


def test_twenty_requests_at_random_moments_are_answered_within_a_second(dirty_model):
    """Of the whole run. No two runs take quite the same time: where one ends before it is asked, another moment is drawn."""
    _, silent = silences(dirty_model, quads=3000)
    random, waits = np.random.default_rng(7), []
    while len(waits) < 20:
        is_heeded, wait = answer(dirty_model, random.uniform(0, sum(seconds for seconds, _ in silent)), quads=3000)
        assert is_heeded or wait < 0.25, "nobody was asked between the wish to stop and the end"
        waits += [wait] if is_heeded else []
    assert max(waits) < 1.0


def test_a_request_to_stop_while_lines_of_a_rough_part_give_way_is_answered_within_a_second(cad_part):
    is_heeded, wait = answer(roughened(*cad_part, 0.004), 0.3, quads=40000)
    assert is_heeded and wait < 1.0


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.7])
def test_a_request_to_stop_is_answered_by_several_threads(share):
    """Asks at a share of the progress. The wish may have arisen as soon as the question before was answered with no."""
    reached, asked = [0.0], [time.process_time()]

    def cancel():
        if reached[-1] >= share:
            return True
        asked.append(time.process_time())

    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(
            *BIG, quads=20000, threads=2, cancel=cancel, progress=lambda _, fraction: reached.append(fraction)
        )
    assert caught.value.code == "cancelled"
    assert time.process_time() - asked[-1] < 2.0  # a second of each


def test_the_memory_limit_holds():
    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(*BIG, quads=20000, memory_limit=1)
    assert caught.value.code == "memory_limit"
    assert len(hybrid_quad.remesh(*surfaces.torus(), quads=100, memory_limit=1e6).quads)


def test_the_time_limit_holds():
    begin = time.process_time()  # on one thread, no more than the clock shows, however busy the machine is
    with pytest.raises(hybrid_quad.Cancelled) as caught:
        hybrid_quad.remesh(*BIG, quads=100_000, threads=1, time_limit=0.2)
    assert caught.value.code == "time_limit"
    assert time.process_time() - begin < 1.2


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


@pytest.mark.parametrize("number", [1, 4, 8])
def test_a_part_is_given_up_before_the_stages_begin(number):
    """At the first, fourth, eighth question: what is done with its border asks too."""
    vertices, faces = surfaces.torus(60, 24)
    asked = []

    def cancel():
        asked.append(True)
        return len(asked) == number

    with pytest.raises(hybrid_quad.Cancelled, match="cancelled during part") as caught:
        hybrid_quad.remesh_part(vertices, faces, part=np.arange(200), odd_border="grow", cancel=cancel)
    assert caught.value.code == "cancelled"
    with pytest.raises(hybrid_quad.Cancelled, match=r"part \(the time limit passed\)") as caught:
        hybrid_quad.remesh_part(vertices, faces, part=np.arange(200), odd_border="grow", time_limit=1e-9)
    assert caught.value.code == "time_limit"


LARGER = surfaces.torus(700, 300)
CALLS = {
    "check": lambda: hybrid_quad.check(*LARGER),
    "repair": lambda: hybrid_quad.repair(*LARGER),
    "subdivide": lambda: hybrid_quad.subdivide(*BIG, levels=2),
    "surface_distances": lambda: hybrid_quad.surface_distances(np.tile(BIG[0] * 1.1, (4, 1)), *BIG, threads=1),
}


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_an_interruption_of_what_reports_no_progress_does_not_wait_for_its_end(call):
    begin = time.process_time()
    call()
    whole = time.process_time() - begin
    asked = []

    def interrupt():
        asked.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.15 * whole, interrupt)
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            call()
            timer.join()
        assert time.process_time() - asked[0] < 0.15 + 0.4 * whole
    finally:
        signal.signal(signal.SIGINT, before)


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
