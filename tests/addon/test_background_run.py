"""Runs in a process of their own, as the window has them, and what becomes of their source meanwhile."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender import background_run, operators
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.blender.source_track import SourceTrack
from hybrid_quad.core.stage_names import WORDS, in_words
from hybrid_quad.worker import interpreter
from hybrid_quad.worker.death import WorkerDied
from scenes import add_cube, add_sphere

LONG_RUN_QUADS = 200_000


def _task(obj: bpy.types.Object):
    return prepare_task(obj, bpy.context.evaluated_depsgraph_get())


def _start(quads: int) -> background_run.BackgroundRun:
    obj = add_sphere(quads)
    return background_run.start(_task(obj), obj)


def _start_long() -> background_run.BackgroundRun:
    run = _start(LONG_RUN_QUADS)
    while run.fraction == 0 and not run.worker.poll():
        time.sleep(0.01)
    assert not run.is_finished
    return run


def test_gives_what_a_direct_run_gives():
    run = _start(400)
    expected = run.task.solve()
    assert np.array_equal(run.result().vertices, expected.vertices)
    assert np.array_equal(run.result().quads, expected.quads)
    assert run.is_finished and run.has_result and run.find_source() == bpy.context.object


def test_the_same_once_more_is_known():
    run = _start(400)
    obj = bpy.context.object
    assert not run.is_known
    result = run.result()

    def again():
        background_run.forget()
        return background_run.start(_task(obj), obj)

    obj.hybrid_quad.result_mode, obj.hybrid_quad.time_limit = "REPLACE", 50  # quads do not depend on these
    run = again()
    assert run.is_known and run.result() is result
    obj.hybrid_quad.adaptivity = 0.5
    assert not again().is_known
    obj.hybrid_quad.adaptivity = 0
    obj.data.vertices[3].co.x += 0.125
    assert not again().is_known


def test_a_python_program_does_it():
    command = interpreter.worker_command(host=bpy.app.binary_path)
    assert Path(command[0]).name.startswith("python") and Path(command[0]) != Path(bpy.app.binary_path or "/")


@pytest.mark.skipif(not bpy.app.binary_path, reason="bpy as a module has no program")
def test_where_there_is_no_python_program_blender_does_it(monkeypatch):
    monkeypatch.setattr(interpreter, "python_programs", lambda: [])
    assert interpreter.worker_command(host=bpy.app.binary_path)[0] == bpy.app.binary_path
    run = _start(400)
    expected = run.task.solve()
    assert np.array_equal(run.result().vertices, expected.vertices)


def test_disabling_the_add_on_ends_the_run():
    run = _start_long()
    assert not bpy.ops.object.hybrid_quad_remesh.poll()
    told = []
    run.on_forget = lambda: told.append(True)
    hybrid_quad.unregister()
    assert run.is_finished and background_run.current() is None and told
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()


def test_the_cancel_button_ends_the_run(scene_state):
    assert not bpy.ops.object.hybrid_quad_cancel.poll()
    with pytest.raises(RuntimeError, match="Nothing is being remeshed"):
        bpy.ops.object.hybrid_quad_cancel()
    run = _start_long()
    before = scene_state()
    assert bpy.ops.object.hybrid_quad_cancel() == {"FINISHED"}
    assert run.is_finished and not run.has_result and background_run.current() is None
    assert scene_state() == before


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_crash_is_told_with_its_stage(scene_state, capfd):
    run = _start_long()
    before = scene_state()
    os.kill(run.worker.process_id, signal.SIGSEGV)
    with pytest.raises(WorkerDied) as caught:
        run.result()
    message = operators.message_of(caught.value)
    assert (
        in_words(run.worker.stage) in message and "Nothing was changed" in message and "segmentation fault" in message
    )
    assert "Segmentation fault" in capfd.readouterr().err  # where the worker was, for who reports it
    assert scene_state() == before


def _assert_out_of_memory_is_told(run, scene_state, before) -> None:
    with pytest.raises((MemoryError, hybrid_quad.Cancelled, WorkerDied)) as caught:
        run.result()
    message = operators.message_of(caught.value)
    assert "Nothing was changed" in message and "memory" in message
    assert in_words(run.worker.stage) in message and "_" not in message.partition("(")[0]
    background_run.forget()
    assert scene_state() == before


@pytest.mark.skipif(sys.platform != "linux", reason="prlimit")
def test_a_worker_without_memory_is_told_with_its_stage(scene_state):
    import resource

    run = _start_long()
    before = scene_state()
    worker = run.worker.process_id
    used = int(Path(f"/proc/{worker}/statm").read_text().split()[0]) * resource.getpagesize()
    limit = used + 2**25  # the run takes far more; without any, not even the stack can grow
    resource.prlimit(worker, resource.RLIMIT_AS, (limit, limit))
    _assert_out_of_memory_is_told(run, scene_state, before)


def test_the_memory_limit_is_told_with_its_stage(scene_state):
    add_sphere(LONG_RUN_QUADS).hybrid_quad.memory_limit = 120
    before = scene_state()
    run = background_run.start(_task(bpy.context.object), bpy.context.object)
    _assert_out_of_memory_is_told(run, scene_state, before)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_worker_that_the_system_ends_for_its_memory_is_told(scene_state):
    run = _start_long()
    before = scene_state()
    os.kill(run.worker.process_id, signal.SIGKILL)  # as Linux does
    _assert_out_of_memory_is_told(run, scene_state, before)


def test_a_script_without_memory_reads_the_stage(monkeypatch, scene_state):
    from hybrid_quad.blender.remesh_task import RemeshTask

    def fail(_task, progress=None):
        progress("frame field", 0.3)
        raise MemoryError

    monkeypatch.setattr(RemeshTask, "solve", fail)
    add_sphere()
    before = scene_state()
    with pytest.raises(RuntimeError, match=f"memory ran out while {WORDS['frame field']}"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_of_a_worker_that_hangs_the_user_reads_how_long(monkeypatch):
    run = _start_long()
    os.kill(run.worker.process_id, signal.SIGSTOP)
    run.poll()
    assert run.silence == ""
    monkeypatch.setattr(background_run, "_SILENCE", 0.0)
    time.sleep(0.1)
    assert run.silence == "No news for 0 s" and run.status == in_words(run.worker.stage).capitalize()
    background_run.forget()
    assert run.silence == ""


def test_the_disabled_button_says_why():
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="Select a mesh object"):
        bpy.ops.object.hybrid_quad_remesh()
    _start_long()
    with pytest.raises(RuntimeError, match='"Sphere" is being remeshed'):
        bpy.ops.object.hybrid_quad_remesh()


def test_the_objects_limits_reach_the_run():
    obj = add_sphere()
    assert (_task(obj).options.time_limit, _task(obj).options.memory_limit) == (None, None)
    obj.hybrid_quad.time_limit, obj.hybrid_quad.memory_limit = 60, 2000
    assert (_task(obj).options.time_limit, _task(obj).options.memory_limit) == (60, 2000)
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get(), time_limit=5).options.time_limit == 5


def _move_a_vertex(obj: bpy.types.Object) -> None:
    obj.data.vertices[3].co.x += 0.125


def _mark_a_seam(obj: bpy.types.Object) -> None:
    obj.data.edges[5].use_seam = True


def _paint(obj: bpy.types.Object) -> None:
    obj.data.attributes.new("hybrid_quad_guide", "FLOAT_VECTOR", "POINT").data[0].vector = (1, 0, 0)


def _add_modifier(obj: bpy.types.Object) -> None:
    obj.modifiers.new("Subdivision", "SUBSURF")


def _change_modifier(obj: bpy.types.Object) -> None:
    obj.modifiers["Bevel"].width = 0.3


def _move_in_uv_space(obj: bpy.types.Object) -> None:
    obj.data.uv_layers[0].data[3].uv = (5, 5)


def _rename_a_group(obj: bpy.types.Object) -> None:
    obj.vertex_groups[0].name = "Other"


def _give_a_material(obj: bpy.types.Object) -> None:
    obj.material_slots[0].material = bpy.data.materials.new("Other")


def _move_in_a_shape(obj: bpy.types.Object) -> None:
    obj.data.shape_keys.key_blocks["Up"].data[2].co.z += 1


@pytest.mark.parametrize(
    "change",
    [
        _move_a_vertex,
        _mark_a_seam,
        _paint,
        _add_modifier,
        _change_modifier,
        _move_in_uv_space,
        _rename_a_group,
        _give_a_material,
        _move_in_a_shape,
    ],
)
def test_a_changed_source_is_noticed(change):
    obj = add_cube()
    obj.modifiers.new("Bevel", "BEVEL")
    obj.data.uv_layers.new(name="Map")
    obj.data.materials.append(bpy.data.materials.new("First"))
    obj.vertex_groups.new(name="Group")
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Up")
    track = SourceTrack(obj)
    assert not track.has_changed(track.find())
    change(obj)
    assert track.has_changed(track.find())


def test_what_changes_nothing_of_the_surface_is_no_change():
    obj = add_cube()
    track = SourceTrack(obj)
    obj.location.x = 3
    obj.hide_set(True)
    obj.data.vertices[2].select = not obj.data.vertices[2].select
    obj.hybrid_quad.quads = 7
    obj.data.name = "Other"
    bpy.context.view_layer.update()
    assert not track.has_changed(track.find())


@pytest.mark.parametrize("is_edited", [True, False])
def test_edited_weights_are_noticed(is_edited):
    """No digest has them; Blender tells that something was touched, and only then they are read again."""
    obj = add_sphere()
    obj.vertex_groups.new(name="Group").add([1, 2, 3], 0.5, "REPLACE")
    bpy.context.view_layer.update()
    run = background_run.start(None, obj)
    run.result()
    assert not run.has_changed_source(obj)
    for _ in range(1 if is_edited else 2):
        bpy.ops.object.vertex_group_invert()
    bpy.context.view_layer.update()
    assert run.source.was_touched and not run.source.has_changed(obj)
    assert run.has_changed_source(obj) == is_edited


def test_moved_and_scaled_a_source_is_the_same():
    obj = add_sphere()
    run = background_run.start(None, obj)
    run.result()
    obj.location.x, obj.scale.y = 3, 2
    obj.data.update_tag()
    bpy.context.view_layer.update()
    assert run.source.was_touched and not run.has_changed_source(obj)


def test_a_renamed_source_is_found_and_a_deleted_one_is_not():
    obj = add_cube()
    track = SourceTrack(obj)
    obj.name = "Renamed"
    add_cube().name = "Another"
    assert track.find() == obj
    bpy.ops.ed.undo_push(message="step")
    bpy.context.view_layer.objects.active = obj
    bpy.data.objects.remove(obj)
    assert track.find() is None


def test_a_deleted_source_is_told():
    run = _start(400)
    bpy.data.objects.remove(bpy.context.object)
    run.result()
    with pytest.raises(hybrid_quad.InputError, match='"Sphere" was deleted'):
        run.find_source()
