"""Runs on a thread of their own, as the window has them."""

from __future__ import annotations

import time

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender import background_run, operators, remesh_task
from hybrid_quad.blender.remesh_task import prepare_task
from scenes import add_sphere


def _task(quads: int = 400):
    return prepare_task(add_sphere(quads), bpy.context.evaluated_depsgraph_get())


def test_gives_what_a_direct_run_gives():
    task = _task()
    run = background_run.BackgroundRun(task)
    expected = task.solve()
    assert np.array_equal(run.result().vertices, expected.vertices)
    assert np.array_equal(run.result().quads, expected.quads)
    assert run.is_finished


def test_a_stopped_run_ends_within_a_second(monkeypatch):
    def endless(*_args, progress, cancel, **_kwargs):
        for step in range(10_000):
            progress("periodic_field", min(1.0, step / 100))
            if cancel():
                raise hybrid_quad.Cancelled("cancelled during periodic_field")
            time.sleep(0.01)

    task = _task()
    monkeypatch.setattr(remesh_task, "remesh_with_options", endless)
    run = background_run.BackgroundRun(task)
    time.sleep(0.2)
    assert not run.is_finished and 0 < run.fraction < 1 and run.status.startswith("periodic field, ")
    run.stop()
    started = time.monotonic()
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()
    assert time.monotonic() - started < 1


def test_the_method_itself_answers_a_stop():
    task = _task(quads=200_000)
    run = background_run.BackgroundRun(task)
    while run.fraction == 0 and not run.is_finished:
        time.sleep(0.01)
    run.stop()
    started = time.monotonic()
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()
    assert time.monotonic() - started < 1


def test_disabling_the_add_on_ends_the_run():
    operator = operators.OBJECT_OT_hybrid_quad_remesh
    run = operator.current_run = background_run.BackgroundRun(_task(quads=200_000))
    assert not bpy.ops.object.hybrid_quad_remesh.poll()
    hybrid_quad.unregister()
    assert run.is_finished and operator.current_run is None


def test_errors_come_back_from_the_thread(monkeypatch):
    def broken(*_args, **_kwargs):
        raise hybrid_quad.InternalError("made for this test", "nowhere")

    task = _task()
    monkeypatch.setattr(remesh_task, "remesh_with_options", broken)
    with pytest.raises(hybrid_quad.InternalError, match="made for this test"):
        background_run.BackgroundRun(task).result()
