"""What the window reads and makes step by step is what a script does at once, whatever the user does between the steps."""

from __future__ import annotations

import dataclasses

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender import background_run
from hybrid_quad.blender.remesh_task import prepare_in_steps, prepare_task
from hybrid_quad.blender.result_mesh import place_result
from hybrid_quad.blender.steps import finish
from hybrid_quad.blender.transfer import vertex_groups
from hybrid_quad.worker.bundle import pack
from transfer_scene import add_everything, corners_of, read, uv_of


@pytest.fixture(autouse=True)
def small_steps(monkeypatch):
    monkeypatch.setattr(vertex_groups, "_VERTICES", 50)
    monkeypatch.setattr(vertex_groups, "_WEIGHTS", 40)
    monkeypatch.setattr(background_run, "_STEPS", 0.0)


def _add_plain():
    return add_everything()


def _add_modified():
    """Everything, of which a modifier makes more."""
    obj = add_everything()
    obj.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.3
    return obj


def _add_rigged():
    """Everything, moved by an armature that stays alive."""
    obj = add_everything()
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Up")
    bone.tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["Up"].location = (0, 0.7, 0)
    bpy.context.view_layer.objects.active = obj
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    return obj


def _depsgraph():
    return bpy.context.evaluated_depsgraph_get()


def _bits(record):
    arrays, values = pack({field.name: getattr(record, field.name) for field in dataclasses.fields(record)})
    return {name: (array.dtype, array.shape, array.tobytes()) for name, array in arrays.items()}, repr(values)


def _texts(task):
    return {
        each.name: each.values.tolist() for each in task.source.layers.attributes.each if each.values.dtype == object
    }


def assert_same(one, other, result) -> None:
    """Two tasks ask for the same, and hand the same on."""
    for first, second in (
        (one.request(), other.request()),
        (one.transfer_request(result), other.transfer_request(result)),
    ):
        assert _bits(first) == _bits(second)
    layers = [task.source.layers for task in (one, other)]
    for name in ("kinds", "applied", "materials"):
        assert getattr(layers[0], name) == getattr(layers[1], name)
    assert layers[0].groups.names == layers[1].groups.names and layers[0].groups.active == layers[1].groups.active
    assert [name for name in layers[0].keys.offsets] == [name for name in layers[1].keys.offsets]
    assert _texts(one) == _texts(other)
    seen = [task.source.seen for task in (one, other)]
    assert (seen[0] is None) == (seen[1] is None) and (seen[0] is None or np.array_equal(*seen))


@pytest.mark.parametrize("add", [_add_plain, _add_modified, _add_rigged])
def test_the_same_is_read(add):
    obj = add()
    meshes = sorted(bpy.data.meshes.keys())
    at_once = prepare_task(obj, _depsgraph())
    steps = prepare_in_steps(obj, _depsgraph())
    count = 0
    task = None
    while task is None:
        try:
            next(steps)
            count += 1
            bpy.context.view_layer.update()
        except StopIteration as end:
            task = end.value
    assert count > 8  # one for each stage, and some for the groups
    assert_same(task, at_once, at_once.solve())
    assert sorted(bpy.data.meshes.keys()) == meshes


def _edit(obj):
    obj.data.vertices[3].co.z += 1
    obj.data.uv_layers[0].data[0].uv = (7, 7)
    obj.vertex_groups["Up"].add(list(range(40)), 0.0, "REPLACE")
    obj.vertex_groups.remove(obj.vertex_groups["Down"])
    obj.hybrid_quad.quads = 9


def _enter_edit_mode(_obj):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()


def _delete(obj):
    bpy.data.objects.remove(obj)


@pytest.mark.parametrize("change", [_edit, _enter_edit_mode, _delete])
@pytest.mark.parametrize("after", [1, 5])
def test_what_changes_between_steps_is_not_read(change, after):
    obj = add_everything()
    at_once = prepare_task(obj, _depsgraph())
    steps = prepare_in_steps(obj, _depsgraph())
    for _ in range(after):
        next(steps)
    change(obj)
    bpy.context.view_layer.update()
    assert_same(finish(steps), at_once, at_once.solve())


def _run_in_steps(obj) -> background_run.BackgroundRun:
    run = background_run.start(None, obj)
    assert not run.poll()
    assert run.is_reading and run.fraction == 0 and run.status == "Reading the mesh"
    return run


def test_a_change_while_reading_is_told():
    obj = add_everything()
    run = _run_in_steps(obj)
    assert not run.source.has_changed(obj)
    obj.data.vertices[3].co.z += 1
    run.result()
    assert run.source.has_changed(run.find_source())


def test_the_window_gets_what_a_script_gets():
    obj = add_everything()
    obj.hybrid_quad.result_mode = "NEW"
    run = _run_in_steps(obj)
    result, carried = run.result(), run.carried()
    assert _build(run, obj) > 8
    built = run.take_built()
    background_run.forget()
    by_window = place_result(bpy.context, obj, run.task, result, carried=carried, built=built)
    bpy.context.view_layer.objects.active = obj
    obj.hide_set(False)
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    by_script = bpy.context.object
    assert by_script not in (obj, by_window)
    _assert_same_data(by_window, by_script)


def _build(run, obj) -> int:
    """Makes the mesh; in how many steps."""
    steps = 1
    while not run.build(obj):
        steps += 1
    return steps


def _orphans_go() -> None:
    """What an undo does to what came since."""
    for mesh in [mesh for mesh in bpy.data.meshes if mesh.users == 0]:
        bpy.data.meshes.remove(mesh)


@pytest.mark.parametrize("before", [1, 4, None])
def test_after_an_undo_the_mesh_is_made_once_more(before):
    obj = add_everything()
    obj.hybrid_quad.result_mode = "NEW"
    run = _run_in_steps(obj)
    result = run.result()
    for _ in range(before or _build(run, obj)):
        run.build(obj)
    _orphans_go()
    if before:
        _build(run, obj)
    built = run.take_built()
    assert (built is None) == (before is None)
    background_run.forget()
    target = place_result(bpy.context, obj, run.task, result, carried=run.carried(), built=built)
    assert len(target.data.polygons) == len(result.quads)
    assert sorted(mesh.name for mesh in bpy.data.meshes) == sorted([obj.data.name, target.data.name])


def test_forgotten_while_the_mesh_is_made_nothing_is_left(scene_state):
    obj = add_everything()
    run = _run_in_steps(obj)
    run.result()
    before = scene_state()
    for steps in (3, None):
        for _ in range(steps or _build(run, obj)):
            run.build(obj)
        assert scene_state() != before  # the half-made mesh
        run.cancel()
        assert scene_state() == before
        run = background_run.BackgroundRun(run.task, obj, "OBJECT")
        run.result()


def _assert_same_data(one, other) -> None:
    for name, dtype, width in (("co", np.float32, 3),):
        assert np.array_equal(*(read(obj.data.vertices, name, dtype, width) for obj in (one, other)))
    assert np.array_equal(corners_of(one.data), corners_of(other.data))
    assert np.array_equal(*(read(obj.data.polygons, "material_index", np.int32) for obj in (one, other)))
    for name in [layer.name for layer in one.data.uv_layers]:
        assert np.array_equal(*(uv_of(obj.data.uv_layers[name]) for obj in (one, other)))
    assert one.data.attributes.keys() == other.data.attributes.keys()
    kinds = {"FLOAT": ("value", 1), "INT": ("value", 1), "FLOAT_COLOR": ("color", 4), "FLOAT_VECTOR": ("vector", 3)}
    kinds["BYTE_COLOR"] = kinds["FLOAT_COLOR"]
    for attribute in one.data.attributes:
        if attribute.data_type in kinds:
            name, width = kinds[attribute.data_type]
            found = [read(obj.data.attributes[attribute.name].data, name, np.float32, width) for obj in (one, other)]
            assert np.array_equal(*found), attribute.name
    assert one.vertex_groups.keys() == other.vertex_groups.keys() != []
    weights = [
        [[(item.group, item.weight) for item in vertex.groups] for vertex in obj.data.vertices] for obj in (one, other)
    ]
    assert weights[0] == weights[1] and any(weights[0])
    for key in one.data.shape_keys.key_blocks:
        other_key = other.data.shape_keys.key_blocks[key.name]
        assert np.array_equal(*(read(each.data, "co", np.float32, 3) for each in (key, other_key)))


def test_in_another_mode_reading_waits():
    obj = add_everything()
    run = background_run.start(None, obj)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not run.poll() and run.is_reading and "Object Mode" in run.status
    bpy.ops.object.mode_set(mode="OBJECT")
    assert run.result().quads.size


def test_a_source_deleted_before_it_is_read_is_told():
    run = background_run.start(None, add_everything())
    bpy.data.objects.remove(bpy.context.object)
    with pytest.raises(hybrid_quad.InputError, match="was deleted"):
        run.result()


def test_an_undo_while_reading_is_told(scene_state):
    obj = add_everything()
    run = _run_in_steps(obj)
    _orphans_go()
    before = scene_state()
    with pytest.raises(hybrid_quad.InputError, match="undone") as caught:
        run.result()
    assert caught.value.code == "mesh_gone"
    background_run.forget()
    assert scene_state() == before


def test_cancelled_while_reading_nothing_is_left(scene_state):
    obj = add_everything()
    before = scene_state()
    run = _run_in_steps(obj)
    assert bpy.ops.object.hybrid_quad_cancel() == {"FINISHED"}
    assert run.is_finished and not run.has_result and scene_state() == before
    with pytest.raises(hybrid_quad.Cancelled):
        run.result()


def test_another_file_while_reading():
    run = _run_in_steps(add_everything())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    background_run.forget()
    assert run.is_finished and not bpy.data.meshes
