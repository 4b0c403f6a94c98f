"""What comes along is computed in a worker process: the same to the last bit as here, and no work of Blender's own thread."""

from __future__ import annotations

import dataclasses
import os
import signal
import sys

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender import background_run, operators, task_solving
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.blender.result_mesh import place_result
from hybrid_quad.worker.bundle import pack
from hybrid_quad.worker.death import WorkerDied
from hybrid_quad.worker.transfer_request import TransferRequest
from transfer_scene import add_everything


@pytest.fixture
def task():
    return prepare_task(add_everything(), bpy.context.evaluated_depsgraph_get())


def _bits(record):
    arrays, values = pack({field.name: getattr(record, field.name) for field in dataclasses.fields(record)})
    return {name: (array.dtype, array.shape, array.tobytes()) for name, array in arrays.items()}, repr(values)


def _start_transfer(task):
    background_run.start(task, bpy.context.object).result()
    background_run.forget()
    task_solving._known_data.clear()
    run = background_run.start(task, bpy.context.object)
    assert run.is_known
    assert run.worker.stage == "data_transfer" and "Transferring data" in run.status and 0 < run.fraction < 1
    return run


def test_the_worker_gives_the_same_bits(task):
    run = background_run.start(task, bpy.context.object)
    expected = task.transfer_request(task.solve()).solve()
    assert _bits(run.carried()) == _bits(expected)
    assert expected.groups and expected.seams is not None and expected.edges is not None


def test_requests_keep_their_bits_on_the_way(task, tmp_path):
    from hybrid_quad.worker.kinds import load_request

    request = task.transfer_request(task.solve())
    request.save(tmp_path / "request.npz")
    found = load_request(tmp_path / "request.npz")
    assert isinstance(found, TransferRequest)
    assert _bits(found)[0] == _bits(request)[0]


def test_placing_computes_nothing_that_the_worker_has(task, monkeypatch):
    result = task.solve()
    carried = task.transfer_request(result).solve()
    from hybrid_quad.core.transfer.correspondence import Correspondence

    def refuse(*_arguments, **_named):
        raise AssertionError("on Blender's own thread")

    monkeypatch.setattr(TransferRequest, "solve", refuse)
    monkeypatch.setattr(Correspondence, "__init__", refuse)
    target = place_result(bpy.context, bpy.context.object, task, result, carried=carried)
    assert len(target.data.polygons) == len(result.quads)
    with pytest.raises(AssertionError):
        place_result(bpy.context, bpy.context.object, task, result)


def test_it_can_be_cancelled(task, scene_state):
    before = scene_state()
    run = _start_transfer(task)
    assert bpy.ops.object.hybrid_quad_cancel() == {"FINISHED"}
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()
    assert run.is_finished and not run.has_result and scene_state() == before


def test_cancelled_between_the_halves_nothing_begins(task):
    run = background_run.start(task, bpy.context.object)
    run.worker.wait()
    background_run.forget()
    assert run.poll() and not run.has_result
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()


def test_the_same_once_more_needs_no_worker(task, scene_state):
    obj = bpy.context.object
    run = background_run.start(task, obj)
    expected, bits = run.result(), _bits(run.carried())
    background_run.forget()
    again = background_run.start(task, obj)
    assert again.worker is None and again.is_finished and again.has_result and again.fraction == 1
    assert again.result() is expected and _bits(again.carried()) == bits
    place_result(bpy.context, obj, again.task, again.result(), carried=again.carried())
    assert _bits(again.carried()) == bits  # placing changes nothing of what is shared
    background_run.forget()
    obj.data.uv_layers[0].data[0].uv = (7, 7)
    other = background_run.start(prepare_task(obj, bpy.context.evaluated_depsgraph_get()), obj)
    assert other.is_known and other.worker.stage == "data_transfer"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_crash_is_told_with_its_stage(task, scene_state, capfd):
    before = scene_state()
    run = _start_transfer(task)
    os.kill(run.worker.process_id, signal.SIGKILL)
    with pytest.raises(WorkerDied) as caught:
        run.result()
    message = operators.message_of(caught.value)
    assert "while transferring data" in message and "memory" in message and "Nothing was changed" in message
    assert scene_state() == before


def test_a_bug_is_told_with_its_stage(task):
    request = task.transfer_request(task.solve())
    broken = dataclasses.replace(request, points=np.zeros((1, 3)))
    with pytest.raises(hybrid_quad.InternalError) as caught:
        broken.solve()
    assert caught.value.stage == "data_transfer"
