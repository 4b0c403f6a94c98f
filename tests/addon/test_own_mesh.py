"""Meshes of our own while a run reads and makes: no file ever has them, and whatever ends the run, none is left."""

from __future__ import annotations

import bpy
import pytest

import hybrid_quad
from hybrid_quad.blender import background_run
from hybrid_quad.blender.result_mesh import place_result
from hybrid_quad.blender.transfer import vertex_groups
from transfer_scene import add_everything

READING, MAKING, MADE = "reading", "making", "made"
during = pytest.mark.parametrize("when", [READING, MAKING, MADE])


@pytest.fixture(autouse=True)
def small_steps(monkeypatch):
    monkeypatch.setattr(vertex_groups, "_VERTICES", 50)
    monkeypatch.setattr(vertex_groups, "_WEIGHTS", 40)
    monkeypatch.setattr(background_run, "_STEPS", 0.0)


def own_meshes() -> list[str]:
    return [mesh.name for mesh in bpy.data.meshes if mesh.name.startswith(".hybrid_quad")]


def _brought_to(when: str) -> background_run.BackgroundRun:
    """A run that reads, makes or has made its mesh; the scene is an undo step, and so is what is there now."""
    obj = add_everything()
    bpy.ops.ed.undo_push(message="before")
    run = background_run.start(None, obj)
    run.poll()
    if when == READING:
        assert run.is_reading
    else:
        run.wait()
        steps = 1
        while not run.build(obj) and (when == MADE or steps < 4):
            steps += 1
    assert len(own_meshes()) == 1
    obj.location.x = 3
    bpy.ops.ed.undo_push(message="moved meanwhile")
    return run


def _source() -> bpy.types.Object:
    return bpy.data.objects["Grid"]


def _end(run, how: str) -> None:
    if how == "finish":
        run.wait()
        while not run.build(_source()):
            pass
        result, carried, built = run.result(), run.carried(), run.take_built()
        background_run.forget()
        place_result(bpy.context, _source(), run.task, result, carried=carried, built=built)
        bpy.ops.ed.undo_push(message="result")
    elif how == "cancel":
        assert bpy.ops.object.hybrid_quad_cancel() == {"FINISHED"}
    elif how == "error":
        run.worker and run.worker.cancel()
        with pytest.raises((hybrid_quad.Cancelled, hybrid_quad.InputError)):
            _lose_the_mesh_while_reading(run)
        background_run.forget()
    elif how == "disable":
        hybrid_quad.unregister()


def _lose_the_mesh_while_reading(run) -> None:
    if run.is_reading:
        bpy.data.meshes.remove(bpy.data.meshes[own_meshes()[0]])
        run.wait()
    else:
        run.cancel()
        raise hybrid_quad.Cancelled


@during
@pytest.mark.parametrize("how", ["finish", "cancel", "error", "disable"])
def test_whatever_ends_a_run_none_is_left(when, how):
    _end(_brought_to(when), how)
    assert own_meshes() == []


@during
def test_no_file_has_one(when, tmp_path):
    run = _brought_to(when)
    path = str(tmp_path / "meanwhile.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    assert len(own_meshes()) == 1
    with bpy.data.libraries.load(path) as (there, _):
        assert list(there.meshes) == [_source().data.name]
    _end(run, "cancel")


@during
@pytest.mark.parametrize("how", ["finish", "cancel"])
def test_no_undo_brings_one_back(when, how):
    """Though the step that was pushed meanwhile has it."""
    _end(_brought_to(when), how)
    steps = ["undo"] * (2 if how == "finish" else 1) + ["redo"]
    for step in steps:
        assert getattr(bpy.ops.ed, step)() == {"FINISHED"}
        assert own_meshes() == [], step


@during
def test_undone_meanwhile_none_is_left(when):
    run = _brought_to(when)
    bpy.ops.ed.undo()
    _end(run, "cancel")
    assert own_meshes() == []
    bpy.ops.ed.redo()
    assert own_meshes() == []


@during
def test_another_file_has_none(when, tmp_path):
    run = _brought_to(when)
    path = str(tmp_path / "other.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    background_run.forget()
    assert run.is_finished and own_meshes() == []


def test_the_meshes_of_a_run_that_goes_on_stay():
    from hybrid_quad.blender.own_mesh import remove_strays

    run = _brought_to(READING)
    remove_strays()
    assert len(own_meshes()) == 1
    run.wait()
    assert run.has_result
