"""Runs in the background in a real window, and what a person, or the system, does meanwhile.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -P run_worker_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import PATIENCE, expect, in_view, main, press, show_sidebar_tab, take_picture, until_finished, view

import hybrid_quad
from hybrid_quad.blender import background_run, operators, task_solving
from hybrid_quad.core.stage_names import in_words
from hybrid_quad.worker import process
from scenes import activate, add_cube, add_sphere

LONG_RUN_QUADS = 150_000
MEDIUM_RUN_QUADS = 15_000  # all stages can be waited for
CANCEL_BUTTON = 119  # pixels from the top of the sidebar down to its middle


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    hybrid_quad.register()
    yield from new_scene()
    yield from show_sidebar_tab()
    yield from working_meanwhile()
    for test in (
        ended_by_escape,
        ended_in_every_stage,
        ended_at_random_moments,
        ended_by_the_button,
        killed,
        out_of_memory,
        memory_limit_reached,
        hanging,
        hanging_past_its_time_limit,
        hanging_for_good,
        source_deleted,
        source_edited,
        source_renamed,
        other_object_active,
        finished_in_another_mode,
        undone_meanwhile,
        read_in_steps,
        undone_while_read,
        another_file_loaded,
    ):
        print(f"-- {test.__name__.replace('_', ' ')}", flush=True)
        yield from new_scene()
        yield from test()
        expect(background_run.current() is None, "no run is left")
    hybrid_quad.unregister()
    yield 0.3


def working_meanwhile() -> Iterator[float]:
    """Objects can be moved, modes entered, operators and text fields left by Esc, and the run goes on."""
    print(f"pauses of the window without a run: {(yield from pauses())}", flush=True)
    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    cube = bpy.data.objects["Cube"]
    print(f"and with one: {(yield from pauses())}", flush=True)
    activate(cube)
    yield 0.3
    yield from take_picture("4_working_meanwhile.png")
    with in_view():
        bpy.ops.transform.translate("INVOKE_DEFAULT")
    yield 0.5
    press("ESC")
    yield 0.5
    expect(background_run.current() is run, "Esc in another operator is that operator's")
    with in_view():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
    expect(len(cube.data.polygons) > 1000, "another object can be edited")
    window, _ = view()
    other = next(area for area in window.screen.areas if area.type == "PROPERTIES")
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="ESC", value=value, x=other.x + other.width // 2, y=other.y + other.height // 2)
    yield 0.5
    expect(background_run.current() is run and not run.is_finished, "so is Esc in another editor")
    background_run.forget()
    yield 0.5


def ended_by_escape() -> Iterator[float]:
    yield from start(LONG_RUN_QUADS)
    yield from expect_unchanged_after(lambda: press("ESC"))
    expect_said("was cancelled")


def ended_in_every_stage() -> Iterator[float]:
    stages = []
    for share in (0.04, 0.3, 0.75):
        yield from start(MEDIUM_RUN_QUADS)
        run = background_run.current()
        while run.fraction < share and not run.is_finished:
            yield 0.02
        stages.append(run.worker.stage)
        yield from expect_unchanged_after(lambda: press("ESC"))
        expect_said("was cancelled")
    expect(len(set(stages)) == 3, f"Esc came in several stages: {', '.join(stages)}")


def ended_at_random_moments() -> Iterator[float]:
    """From the key to the end of the worker's process; from reading the mesh to making the result's.

    Blender tells of a key when it has drawn what there is to draw: half a second without a graphics card, more where other
    work goes on. So the second is counted from there on, and the whole wait is printed.
    """
    began = time.monotonic()
    yield from start(MEDIUM_RUN_QUADS)
    while background_run.current() is not None:
        yield 0.01
    whole = time.monotonic() - began
    told: list[float] = []
    is_escape = operators.is_escape
    operators.is_escape = lambda context, event: is_escape(context, event) and not told.append(time.monotonic())
    answers, waits, stages = [], [], set()
    for moment in random.Random(8).choices(range(100), k=20):
        yield from new_scene()
        yield from start(MEDIUM_RUN_QUADS)
        run, before = background_run.current(), scene()
        yield moment / 100 * whole
        if background_run.current() is None:
            continue
        stage = run.status
        told.clear()
        asked = time.monotonic()
        press("ESC")
        while background_run.current() is not None:
            yield 0.01
        if "Sphere Quads" in bpy.data.objects:
            continue  # the run was faster than the key
        ended = time.monotonic()
        answers.append(ended - told[0])
        waits.append(ended - asked)
        stages.add(stage)
        expect(run.worker is None or run.worker.wait(0), "the process is gone")
        yield 0.1
        expect(scene() == before, "nothing has changed")
    operators.is_escape = is_escape
    print(f"{len(waits)} of 20 while {', '.join(sorted(stages))}", flush=True)
    for what, seconds in (("answers", answers), ("waits", waits)):
        print(f"{what}: {' '.join(f'{second:.2f}' for second in sorted(seconds))} s", flush=True)
    expect(len(stages) >= 3 and max(answers) < 1, "Esc is answered within a second")


def ended_by_the_button() -> Iterator[float]:
    yield from start(LONG_RUN_QUADS)
    yield 1.0  # until it is drawn
    window, area = view()
    region = next(region for region in area.regions if region.type == "UI")
    x, y = region.x + region.width // 2, region.y + region.height - CANCEL_BUTTON
    before = scene()
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        window.event_simulate(type=kind, value=value, x=x, y=y)
        yield 0.4
    yield from until_finished()
    expect(scene() == before, "nothing has changed")
    expect_said("was cancelled")


def killed() -> Iterator[float]:
    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    yield from expect_unchanged_after(lambda: os.kill(run.worker.process_id, signal.SIGKILL))
    expect_said(in_words(run.worker.stage), "SIGKILL", "memory")
    yield from take_picture("5_killed.png")
    press("ESC")  # the message
    yield 0.3


def hanging() -> Iterator[float]:
    yield from start(LONG_RUN_QUADS)
    os.kill(background_run.current().worker.process_id, signal.SIGSTOP)
    yield from expect_unchanged_after(lambda: press("ESC"))


def hanging_past_its_time_limit() -> Iterator[float]:
    """Nobody presses anything."""
    bpy.data.objects["Sphere"].hybrid_quad.time_limit = 4
    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    yield from expect_unchanged_after(lambda: os.kill(run.worker.process_id, signal.SIGSTOP))
    expect_said("did not answer", in_words(run.worker.stage))
    press("ESC")  # the message
    yield 0.3


def hanging_for_good() -> Iterator[float]:
    """Nobody presses anything, and there is no limit."""
    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    hangs, process._HANGS = process._HANGS, 3.0
    yield from expect_unchanged_after(lambda: os.kill(run.worker.process_id, signal.SIGSTOP))
    process._HANGS = hangs
    expect_said("it hung", in_words(run.worker.stage))
    press("ESC")  # the message
    yield 0.3


def out_of_memory() -> Iterator[float]:
    """The system gives the worker no more."""
    import resource

    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    used = int(Path(f"/proc/{run.worker.process_id}/statm").read_text().split()[0]) * resource.getpagesize()
    limit = used + 2**25

    def take_memory_away() -> None:
        resource.prlimit(run.worker.process_id, resource.RLIMIT_AS, (limit, limit))

    yield from expect_unchanged_after(take_memory_away)
    expect_said("memory ran out", in_words(run.worker.stage))
    press("ESC")
    yield 0.3


def memory_limit_reached() -> Iterator[float]:
    """The one of the settings."""
    bpy.data.objects["Sphere"].hybrid_quad.memory_limit = 120
    run = begin(LONG_RUN_QUADS)  # may be there before it tells how far it is
    yield from expect_unchanged_after(lambda: None)
    expect_said("memory limit", in_words(run.worker.stage))
    press("ESC")
    yield 0.3


def source_deleted() -> Iterator[float]:
    yield from start(300)
    with in_view():
        bpy.ops.object.delete()
    yield from until_finished()
    expect("Sphere Quads" not in bpy.data.objects, "nothing comes of a deleted object")
    expect_said('"Sphere" was deleted')
    press("ESC")
    yield 0.3


def source_edited() -> Iterator[float]:
    yield from start(300, mode="REPLACE")
    sphere = bpy.data.objects["Sphere"]
    sphere.data.vertices[0].co.z += 5
    yield from until_finished()
    expect(bpy.data.objects["Sphere"].data.vertices[0].co.z > 5, "the edited mesh is not replaced")
    expect(not bpy.data.objects["Sphere"].hide_get(), "nor hidden")
    expect("Sphere Quads" in bpy.data.objects, "the result is beside it")
    expect_said('"Sphere" was changed')


def source_renamed() -> Iterator[float]:
    yield from start(300)
    bpy.data.objects["Sphere"].name = "Ball"
    yield from until_finished()
    expect(bpy.context.view_layer.objects.active.name == "Ball Quads", "a new name is followed")


def other_object_active() -> Iterator[float]:
    yield from start(300)
    activate(bpy.data.objects["Cube"])
    yield from until_finished()
    expect("Sphere Quads" in bpy.data.objects, "the result comes")
    expect([obj.name for obj in bpy.context.selected_objects] == ["Cube"], "and leaves the selection")
    expect(bpy.context.view_layer.objects.active.name == "Cube", "and the active object")


def finished_in_another_mode() -> Iterator[float]:
    yield from start(300)
    activate(bpy.data.objects["Cube"])
    with in_view():
        bpy.ops.object.mode_set(mode="SCULPT")
    run = background_run.current()
    while not run.is_finished:
        yield 0.1
    yield 1.0
    expect("Sphere Quads" not in bpy.data.objects, "in Sculpt Mode nothing is put into the scene")
    yield from take_picture("6_waiting.png")
    with in_view():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from until_finished()
    expect("Sphere Quads" in bpy.data.objects, "in Object Mode it is")


def undone_meanwhile() -> Iterator[float]:
    with in_view():
        bpy.ops.ed.undo_push(message="before")
        bpy.data.objects["Cube"].location.x = 3
        bpy.ops.ed.undo_push(message="moved")
    yield from start(300)
    with in_view():
        bpy.ops.ed.undo()
    yield from until_finished()
    expect(bpy.data.objects["Cube"].location.x == 0, "the other object's move is undone")
    expect(bpy.context.view_layer.objects.active.name == "Sphere Quads", "the result comes")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.3
    expect("Sphere Quads" not in bpy.data.objects, "one undo takes it away")
    expect(not bpy.data.objects["Sphere"].hide_get() and "Cube" in bpy.data.objects, "and nothing else")


def read_in_steps() -> Iterator[float]:
    """A large mesh can be edited and left while it is read."""
    yield from start_with_large_mesh()
    sphere = bpy.data.objects["Sphere"]
    with in_view():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.translate(value=(0, 0, 5))
        bpy.ops.object.mode_set(mode="OBJECT")
    expect(background_run.current().is_reading, "it was still being read")
    yield from until_finished()
    result = bpy.data.objects["Sphere Quads"]
    expect(result.data.vertices[0].co.z < 2 < sphere.data.vertices[0].co.z, "the result shows what was there")
    expect(min(len(vertex.groups) for vertex in result.data.vertices) == 1, "all weights came along")
    expect_said('"Sphere" was changed')
    expect(not own_meshes(), "no mesh of ours is left")


def undone_while_read() -> Iterator[float]:
    yield from start_with_large_mesh()
    with in_view():
        bpy.ops.ed.undo()
    yield from until_finished()
    expect("Sphere Quads" not in bpy.data.objects, "nothing comes of what was undone while it was read")
    expect_said("undone")
    expect(not own_meshes(), "no mesh of ours is left")
    press("ESC")
    yield 0.3


def start_with_large_mesh() -> Iterator[float]:
    """Begins to read a sphere with weights that takes its time."""
    sphere = bpy.data.objects["Sphere"]
    modifier = sphere.modifiers.new("Fine", "SUBSURF")
    modifier.levels = 4
    with in_view():
        activate(sphere)
        bpy.ops.object.modifier_apply(modifier="Fine")
    sphere.vertex_groups.new(name="All").add(list(range(len(sphere.data.vertices))), 0.5, "REPLACE")
    print(f"{len(sphere.data.polygons)} faces", flush=True)
    with in_view():
        bpy.ops.ed.undo_push(message="large")
        sphere.location.x = 1
        bpy.ops.ed.undo_push(message="moved")
    yield from start(300)
    run = background_run.current()
    while run.is_reading and not own_meshes():
        yield 0.0
    expect(run.is_reading, "it is being read")


def own_meshes() -> list[str]:
    return [mesh.name for mesh in bpy.data.meshes if mesh.name.startswith(".hybrid_quad")]


def another_file_loaded() -> Iterator[float]:
    yield from start(LONG_RUN_QUADS)
    run = background_run.current()
    with in_view():
        bpy.ops.wm.read_homefile()
    yield 1.0
    expect(run.worker.wait(5) and not run.has_result, "loading a file ends the run")
    expect(sorted(bpy.data.objects.keys()) == ["Camera", "Cube", "Light"], "and the file is as it was saved")


def new_scene() -> Iterator[float]:
    """A cube, and a sphere that is active."""
    task_solving.forget_results()
    with in_view():
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
        for mesh in list(bpy.data.meshes):
            bpy.data.meshes.remove(mesh)
        add_cube(segments=12).location.x = 0
        add_sphere().location.y = 4
        bpy.ops.ed.undo_push(message="scene")
    said()
    yield 0.3


def start(quads: int, mode: str = "NEW") -> Iterator[float]:
    """Remeshes the sphere; a long run is waited for until it tells how far it is."""
    run = begin(quads, mode)
    began = time.monotonic()
    while quads == LONG_RUN_QUADS and run.fraction == 0 and time.monotonic() - began < PATIENCE:
        yield 0.05
    expect(not run.is_finished, "and goes on")


def begin(quads: int, mode: str = "NEW") -> background_run.BackgroundRun:
    sphere = bpy.data.objects["Sphere"]
    sphere.hybrid_quad.quads, sphere.hybrid_quad.result_mode = quads, mode
    with in_view():
        activate(sphere)
        expect(bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "a run begins")
    return background_run.current()


def pauses() -> Iterator[float]:
    """Seconds between events, sorted; the last of them is what a person would feel."""
    yield 0.5
    found = []
    for _ in range(40):
        before = time.monotonic()
        yield 0.02
        found.append(time.monotonic() - before)
    return " ".join(f"{pause:.3f}" for pause in sorted(found)[::-13])


def expect_unchanged_after(end) -> Iterator[float]:
    """Ends the run in some way; the scene stays as it is."""
    before, run = scene(), background_run.current()
    began = time.monotonic()
    end()
    while background_run.current() is not None and time.monotonic() - began < PATIENCE / 2:
        yield 0.02
    print(f"ended in {time.monotonic() - began:.2f} s", flush=True)
    expect(background_run.current() is None and run.worker.wait(5), "the run is over")
    yield 0.3
    expect(scene() == before, "nothing has changed")


def scene() -> list[tuple[object, ...]]:
    return sorted(
        (obj.name, obj.data.name, len(obj.data.vertices), obj.hide_get(), obj.select_get()) for obj in bpy.data.objects
    )


def expect_said(*words: str) -> None:
    lines = said()
    found = [line for line in lines if all(word in line for word in words)]
    expect(bool(found), f"the user reads: {found or lines}")


def said() -> list[str]:
    """What Blender's Info editor lists since the last call, for example ``"Error: ..."``."""
    window, _ = view()
    area = next(area for area in window.screen.areas if area.type == "DOPESHEET_EDITOR")
    area.type = "INFO"
    try:
        region = next(region for region in area.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=area, region=region):
            area.spaces[0].show_report_info = area.spaces[0].show_report_warning = area.spaces[0].show_report_error = (
                True
            )
            bpy.ops.info.select_all(action="SELECT")
            bpy.ops.info.report_copy()
            lines = bpy.context.window_manager.clipboard.splitlines()
            bpy.ops.info.select_all(action="SELECT")
            bpy.ops.info.report_delete()
    finally:
        area.type = "DOPESHEET_EDITOR"
    return lines


if __name__ == "__main__":
    main(steps())
