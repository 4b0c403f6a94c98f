"""What moves a mesh moves its result alike: bones, shape keys, lattices; and nothing of it acts twice."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils.bvhtree import BVHTree

from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.blender.result_mesh import read_report
from scenes import activate, add_cube, add_object, assert_sound, faces_of, points_of, remesh
from transfer_scene import add_everything, read

LENGTH = 6.0


def add_limb(around=24, along=48) -> bpy.types.Object:
    """A closed tube along z with a thin end."""
    angle = 2 * np.pi * np.arange(around) / around
    rings = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(around, z)], axis=1)
        for z, r in zip(np.linspace(0, LENGTH, along + 1), np.linspace(1.0, 0.5, along + 1), strict=True)
    ]
    points = np.concatenate([*rings, [(0, 0, -0.3), (0, 0, LENGTH + 0.3)]])
    faces = [
        (i * around + j, i * around + (j + 1) % around, (i + 1) * around + (j + 1) % around, (i + 1) * around + j)
        for i in range(along)
        for j in range(around)
    ]
    low, high, last = len(points) - 2, len(points) - 1, along * around
    faces += [(low, (j + 1) % around, j) for j in range(around)]
    faces += [(high, last + j, last + (j + 1) % around) for j in range(around)]
    obj = add_object("Limb", points, faces)
    obj.hybrid_quad.quads = 900
    obj.hybrid_quad.use_sharp_angle = False
    return obj


def add_rig(obj, bones=3) -> bpy.types.Object:
    """Bones along z, with smooth weights that are 1 in sum."""
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    activate(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    for index in range(bones):
        bone = rig.data.edit_bones.new(f"Bone {index}")
        bone.head, bone.tail = (0, 0, index * LENGTH / bones), (0, 0, (index + 1) * LENGTH / bones)
        if index:
            bone.parent = rig.data.edit_bones[index - 1]
    bpy.ops.object.mode_set(mode="OBJECT")
    weights = weights_at(points_of(obj), bones)
    for index in range(bones):
        group = obj.vertex_groups.new(name=f"Bone {index}")
        for vertex in np.flatnonzero(weights[:, index]):
            group.add([int(vertex)], weights[vertex, index], "REPLACE")
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    modifier.object = rig
    activate(obj)
    return rig


def weights_at(points, bones=3) -> np.ndarray:
    middles = (np.arange(bones) + 0.5) * LENGTH / bones
    near = np.maximum(0, 1.2 - np.abs(points[:, 2:3] - middles) / (LENGTH / bones)) ** 2
    return near / near.sum(axis=1, keepdims=True)


def pose(rig) -> None:
    for index, bone in enumerate(rig.pose.bones):
        bone.rotation_mode = "XYZ"
        bone.rotation_euler = (0.5 * index, 0.0, 0.2)
    bpy.context.view_layer.update()


def deformed(obj) -> np.ndarray:
    """Vertices as they are seen, in the world."""
    obj.hide_set(False)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    points = read(evaluated.to_mesh().vertices, "co", np.float32, 3).astype(float)
    evaluated.to_mesh_clear()
    matrix = np.array(obj.matrix_world)
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def weights_of(obj) -> np.ndarray:
    weights = np.zeros((len(obj.data.vertices), len(obj.vertex_groups)))
    for vertex in obj.data.vertices:
        for item in vertex.groups:
            weights[vertex.index, item.group] = item.weight
    return weights


def distances(points, obj, others) -> np.ndarray:
    tree = BVHTree.FromPolygons(others.tolist(), faces_of(obj))
    return np.array([tree.find_nearest(point)[3] for point in points.tolist()])


@pytest.mark.parametrize("is_posed_before", [False, True])
def test_a_rigged_character_still_deforms(is_posed_before):
    source = add_limb()
    rig = add_rig(source)
    if is_posed_before:
        pose(rig)
    result = remesh()
    assert_sound(result)
    # Remeshed at rest, whatever the pose.
    assert distances(points_of(result), source, points_of(source)).max() < 0.01 * LENGTH
    weights = weights_of(result)
    assert np.abs(weights - weights_at(points_of(result))).mean() < 0.02
    assert np.abs(weights.sum(axis=1) - 1).max() < 1e-5
    assert max(len(vertex.groups) for vertex in result.data.vertices) <= max(
        len(vertex.groups) for vertex in source.data.vertices
    )
    pose(rig)
    bent = deformed(source)
    assert np.abs(bent - points_of(source)).max() > 1
    gap = distances(deformed(result), source, bent)
    assert gap.mean() < 0.005 * LENGTH and gap.max() < 0.02 * LENGTH


def test_a_rig_by_parent_stays():
    source = add_limb()
    rig = add_rig(source)
    source.modifiers.clear()
    source.parent, source.parent_type = rig, "ARMATURE"
    pose(rig)
    result = remesh()
    assert distances(points_of(result), source, points_of(source)).max() < 0.01 * LENGTH
    gap = distances(deformed(result), source, deformed(source))
    assert gap.max() < 0.02 * LENGTH


def test_without_the_switches_the_pose_is_remeshed():
    source = add_limb()
    pose(add_rig(source))
    bent = deformed(source)
    source.hybrid_quad.transfer.use_modifiers = False
    result = remesh()
    assert len(result.modifiers) == 0 and len(result.vertex_groups) == 3
    assert distances(deformed(result), source, bent).max() < 0.05


def test_modifiers_that_are_applied_do_not_act_again():
    source = add_cube(segments=2, quads=600)
    mirror, smooth = source.modifiers.new("Mirror", "MIRROR"), source.modifiers.new("Smooth", "SUBSURF")
    mirror.use_axis, mirror.use_bisect_axis = (True, False, False), (True, False, False)
    smooth.levels = 2
    lattice = bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice"))
    bpy.context.scene.collection.objects.link(lattice)
    lattice.scale = (3, 3, 3)
    lattice.data.points_u = 2
    for point in lattice.data.points:
        point.co_deform.z += 0.5
    deform = source.modifiers.new("Lattice", "LATTICE")
    deform.object = lattice
    source.hybrid_quad.use_sharp_angle = False
    source.driver_add('modifiers["Smooth"].levels').driver.expression = "2"
    bpy.context.view_layer.update()
    seen = deformed(source)
    result = remesh()
    assert [modifier.name for modifier in result.modifiers] == ["Lattice"]
    assert len(result.animation_data.drivers) == 0
    assert np.abs(points_of(result)[:, 2]).max() < 1  # the lattice raises it by more than that
    again = deformed(result)
    assert np.allclose(again.min(axis=0), seen.min(axis=0), atol=0.05)
    assert np.allclose(again.max(axis=0), seen.max(axis=0), atol=0.05)


def add_keys(obj) -> None:
    obj.shape_key_add(name="Basis")
    for name, axis in (("Wide", 0), ("Deep", 1)):
        key = obj.shape_key_add(name=name)
        for point in key.data:
            point.co[axis] *= 1.5
        key.value = 0.5


def test_shape_keys_move_the_result_as_they_move_the_source():
    source = add_limb()
    add_keys(source)
    result = remesh()
    for values in ((0.5, 0.5), (1, 0), (0, 1)):
        for obj in (source, result):
            for name, value in zip(("Wide", "Deep"), values, strict=True):
                obj.data.shape_keys.key_blocks[name].value = value
        gap = distances(deformed(result), source, deformed(source))
        assert gap.max() < 0.01 * LENGTH


def test_shape_keys_go_through_modifiers():
    source = add_limb(around=12, along=12)
    add_keys(source)
    source.modifiers.new("Smooth", "SUBSURF").levels = 2
    seen = deformed(source)
    result = remesh()
    assert [key.name for key in result.data.shape_keys.key_blocks] == ["Basis", "Wide", "Deep"]
    again = deformed(result)
    assert np.allclose(again.max(axis=0), seen.max(axis=0), atol=0.03)
    assert points_of(result)[:, 0].max() < 0.85 * seen[:, 0].max()  # which has half of the key


def test_a_key_under_which_modifiers_make_other_vertices_is_reported():
    source = add_cube(segments=4, quads=300)
    add_keys(source)
    weld = source.modifiers.new("Mirror", "MIRROR")
    weld.use_bisect_axis = (True, False, False)  # which cuts through other edges once the key has moved them
    for point in source.data.shape_keys.key_blocks["Wide"].data:
        point.co.x += 0.7
    result = remesh()
    assert any("Wide" in warning for warning in read_report(result)["warnings"])
    assert not any("Deep" in warning for warning in read_report(result)["warnings"])


def test_absolute_keys_stay_absolute():
    source = add_limb()
    add_keys(source)
    keys = source.data.shape_keys
    keys.use_relative, keys.eval_time = False, 15.0
    result = remesh()
    own = result.data.shape_keys
    assert not own.use_relative and own.eval_time == 15.0
    assert [key.frame for key in own.key_blocks] == [key.frame for key in keys.key_blocks]
    assert distances(deformed(result), source, deformed(source)).max() < 0.01 * LENGTH


def test_the_source_is_left_as_it_was(scene_state):
    source = add_everything()
    before = (
        scene_state(),
        [(key.name, key.value, key.mute, key.vertex_group) for key in source.data.shape_keys.key_blocks],
    )
    source.hybrid_quad.quads = 150
    prepare_task(source, bpy.context.evaluated_depsgraph_get())
    assert (
        scene_state(),
        [(key.name, key.value, key.mute, key.vertex_group) for key in source.data.shape_keys.key_blocks],
    ) == before
    assert len(bpy.data.shape_keys) == 1 and not source.show_only_shape_key


def test_guides_drawn_on_the_pose_guide_the_rest():
    source = add_limb()
    source.location = (1, 2, 3)
    source.shape_key_add(name="Basis")
    key = source.shape_key_add(name="Aside")
    for point in key.data:
        point.co.x += point.co.z  # sheared: the end moves by its height
    key.value = 1.0
    line = points_of(source)[24:1024:24] + np.array((0.05, 0, 0))  # along the side, a little off it
    curve = bpy.data.curves.new("Guide", "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(len(line) - 1)
    seen = line + np.outer(line[:, 2], (1, 0, 0)) + (1, 2, 3)
    spline.points.foreach_set("co", np.column_stack([seen, np.ones(len(line))]).ravel())
    guide = bpy.data.objects.new("Guide", curve)
    bpy.context.scene.collection.objects.link(guide)
    source.hybrid_quad.guide_object = guide
    bpy.context.view_layer.update()
    task = prepare_task(source, bpy.context.evaluated_depsgraph_get())
    points = np.concatenate([stroke.points for stroke in task.strokes])
    assert len(points) == len(line)
    assert np.abs(points - line).max() < 0.05
