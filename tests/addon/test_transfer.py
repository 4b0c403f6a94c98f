"""Nothing is lost: every kind of data comes along exactly, and stays behind where its switch is off."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.blender.result_mesh import place_result
from hybrid_quad.blender.transfer.kinds import NAMES
from scenes import add_grid, assert_sound, points_of, remesh
from transfer_scene import add_everything, corners_of, linear, middle_line_of, middles_of, read, uv_of

ROUNDING = 2e-6  # of single precision, for values about 1


def attribute_of(obj, name, value="value", dtype=np.float32, width=1):
    return read(obj.data.attributes[name].data, value, dtype, width)


def right_of(obj):
    return middles_of(obj)[:, 0] > 0


def has_materials(_source, result):
    assert [material and material.name for material in result.data.materials] == ["Left", "Right"]
    assert np.array_equal(read(result.data.polygons, "material_index", np.int32) == 1, right_of(result))


def has_uv_maps(_source, result):
    assert [layer.name for layer in result.data.uv_layers] == ["Whole", "Cut"]
    assert result.data.uv_layers.active.name == "Cut" and result.data.uv_layers["Whole"].active_render
    at_corners = points_of(result)[corners_of(result.data)][:, :2]
    assert np.abs(uv_of(result.data.uv_layers["Whole"]) - at_corners).max() < ROUNDING
    expected = at_corners + 10.0 * np.repeat(right_of(result), 4)[:, None]
    assert np.abs(uv_of(result.data.uv_layers["Cut"]) - expected).max() < 10 * ROUNDING


def has_color_attributes(_source, result):
    assert (
        np.abs(attribute_of(result, "Point Color", "color", width=4)[:, 1] - linear(points_of(result))).max() < ROUNDING
    )
    expected = np.repeat(right_of(result), 4)
    assert np.array_equal(attribute_of(result, "Corner Color", "color", width=4)[:, 0], expected)
    layers = result.data.color_attributes
    assert layers.active_color.name == "Corner Color" and layers[layers.render_color_index].name == "Point Color"


def has_attributes(_source, result):
    points, right = points_of(result), right_of(result)
    corners = corners_of(result.data)
    assert np.abs(attribute_of(result, "Point Float") - linear(points)).max() < ROUNDING
    assert np.abs(attribute_of(result, "Point Vector", "vector", width=3) - points)[:, :2].max() < ROUNDING
    assert np.abs(attribute_of(result, "Corner Float") - linear(points[corners])).max() < ROUNDING
    whole = attribute_of(result, "Point Int", dtype=np.int32)
    clear = np.abs(points[:, 0] - 0.25) > 0.1
    assert set(whole) == {5, 7} and np.array_equal(whole[clear] == 7, points[clear, 0] > 0.3)
    assert np.array_equal(attribute_of(result, "Corner Int", dtype=np.int32), np.where(np.repeat(right, 4), 4, 2))
    assert np.array_equal(attribute_of(result, "Face Bool", dtype=np.bool_), right)
    assert np.array_equal(attribute_of(result, "Face Float"), np.where(right, 1.5, -1.5))
    texts = [item.value for item in result.data.attributes["Face Text"].data]
    assert [text if isinstance(text, str) else text.decode() for text in texts] == np.where(
        right, "right", "left"
    ).tolist()
    on_line, of_edge = middle_line_of(result.data), attribute_of(result, "Edge Int", dtype=np.int32)
    assert (of_edge[on_line] == 9).all() and not (of_edge[~on_line] == 9).any() and (of_edge == 1).any()


def has_face_sets(_source, result):
    if bpy.app.version < (3, 6):
        pytest.skip("Python cannot see face sets before Blender 3.5")
    sets = attribute_of(result, ".sculpt_face_set", dtype=np.int32)
    assert np.array_equal(sets == 4, right_of(result)) and set(sets) == {3, 4}


def has_mask(_source, result):
    from hybrid_quad.blender.transfer import mask

    assert np.abs(mask.read(result.data) - linear(points_of(result))).max() < ROUNDING


def marks_of(obj):
    from hybrid_quad.blender import edge_marks

    return {store.mark: edge_marks._read_store(obj.data, store) for store in edge_marks._STORES}


def has_mark(mark, weight):
    def check(_source, result):
        line = middle_line_of(result.data)
        assert line.any()
        assert np.allclose(marks_of(result)[mark], np.where(line, weight, 0))

    return check


def has_vertex_mark(store_name, weight):
    def check(_source, result):
        from hybrid_quad.blender import edge_marks

        values = getattr(edge_marks, store_name).read(result.data)
        corner = (np.abs(points_of(result)[:, :2] - 1) < 1e-5).all(axis=1)
        assert corner.sum() == 1 and np.allclose(values, np.where(corner, weight, 0))

    return check


def both(*checks):
    def check(source, result):
        for each in checks:
            each(source, result)

    return check


def has_vertex_groups(_source, result):
    assert [group.name for group in result.vertex_groups] == ["Up", "Down", "Nobody"]
    assert [group.lock_weight for group in result.vertex_groups] == [False, True, False]
    assert result.vertex_groups.active_index == 1
    weights = np.array(
        [[result.vertex_groups[name].weight(i) for name in ("Up", "Down")] for i in range(len(result.data.vertices))]
    )
    assert np.abs(weights[:, 0] - linear(points_of(result))).max() < ROUNDING
    assert np.abs(weights.sum(axis=1) - 1).max() < ROUNDING
    assert {len(vertex.groups) for vertex in result.data.vertices} == {2}


def has_shape_keys(source, result):
    keys = result.data.shape_keys
    assert keys is not None and keys != source.data.shape_keys
    assert [key.name for key in keys.key_blocks] == ["Basis", "Lift", "More"]
    points = points_of(result)
    assert np.abs(points[:, 2]).max() < ROUNDING  # the shape without any key
    shapes = {key.name: read(key.data, "co", np.float32, 3) for key in keys.key_blocks}
    assert np.array_equal(shapes["Basis"], points.astype(np.float32))
    assert np.abs(shapes["Lift"] - points - np.outer(linear(points), (0, 0, 1))).max() < ROUNDING
    assert np.abs(shapes["More"] - shapes["Lift"] - (0.25, 0, 0)).max() < ROUNDING
    lift, more = keys.key_blocks["Lift"], keys.key_blocks["More"]
    assert lift.slider_max == 2.0 and lift.value == pytest.approx(0.5) and not lift.mute
    assert more.relative_key == lift and more.vertex_group == "Up" and more.mute
    assert [driver.data_path for driver in keys.animation_data.drivers] == ['key_blocks["Lift"].value']


def has_modifiers(source, result):
    assert [modifier.name for modifier in result.modifiers] == ["Armature", "Later"]
    assert result.modifiers["Armature"].object == source.modifiers["Armature"].object is not None
    assert result.modifiers["Armature"].use_deform_preserve_volume
    assert result.modifiers["Later"].levels == 3 and not result.modifiers["Later"].show_viewport


def has_parent(source, result):
    assert result.parent == source.parent is not None
    assert result.matrix_parent_inverse == source.matrix_parent_inverse


def has_collections(source, result):
    assert {each.name for each in result.users_collection} == {"One", "Two"}


def has_constraints(source, result):
    assert [each.type for each in result.constraints] == ["COPY_LOCATION"]
    assert result.constraints[0].target == source.constraints[0].target
    assert result.constraints[0].influence == 0.5


def has_animation(source, result):
    assert result.animation_data is not None and result.animation_data.action == source.animation_data.action
    assert 'modifiers["Later"].levels' in [driver.data_path for driver in result.animation_data.drivers]


def has_custom_properties(_source, result):
    assert result.get("number") == 7 and result.data.get("word") == "mesh"


CHECKS = {
    "materials": has_materials,
    "uv_maps": has_uv_maps,
    "color_attributes": has_color_attributes,
    "attributes": has_attributes,
    "face_sets": has_face_sets,
    "mask": has_mask,
    "sharp_edges": has_mark(1, 1),
    "seams": has_mark(2, 1),
    "creases": both(has_mark(8, 0.75), has_vertex_mark("VERTEX_CREASE", 0.5)),
    "bevel_weights": both(has_mark(16, 0.25), has_vertex_mark("VERTEX_BEVEL", 0.75)),
    "freestyle_marks": has_mark(32, 1),
    "vertex_groups": has_vertex_groups,
    "shape_keys": has_shape_keys,
    "modifiers": has_modifiers,
    "parent": has_parent,
    "collections": has_collections,
    "constraints": has_constraints,
    "animation": has_animation,
    "custom_properties": has_custom_properties,
}


def test_every_kind_comes_along():
    assert set(CHECKS) | {"custom_normals"} == NAMES  # which have tests of their own
    source = add_everything()
    result = remesh()
    assert_sound(result)
    for name, check in CHECKS.items():
        if name != "face_sets" or bpy.app.version >= (3, 6):
            check(source, result)
    # What has no switch: a result elsewhere would be of no use.
    for name in (
        "rotation_mode",
        "delta_location",
        "pass_index",
        "display_type",
        "location",
        "rotation_euler",
        "scale",
    ):
        assert getattr(result, name) == getattr(source, name), name
    assert np.allclose(result.matrix_world, source.matrix_world)
    assert read(result.data.polygons, "use_smooth", np.bool_).all()


@pytest.mark.parametrize("kind", sorted(CHECKS))
def test_what_is_switched_off_stays_behind(kind):
    source = add_everything()
    place = source.matrix_world.copy()
    setattr(source.hybrid_quad.transfer, f"use_{kind}", False)
    result = remesh()
    with pytest.raises((AssertionError, KeyError, IndexError, TypeError)):
        CHECKS[kind](source, result)
    bpy.context.view_layer.update()
    assert np.allclose(result.matrix_world, place, atol=1e-5)
    # All others come along, but for those that need it.
    # Drivers of modifiers go with them, and so do rigs with the groups that they act by.
    needed_by = {"modifiers": {"animation"}, "vertex_groups": {"modifiers"}}
    others = set(CHECKS) - {kind, "face_sets"} - needed_by.get(kind, set())
    for name in sorted(others):
        CHECKS[name](source, result)


def test_replacing_the_mesh_keeps_every_kind():
    source = add_everything()
    expected = {name: [v.name for v in source.modifiers] for name in ("modifiers",)}
    source.hybrid_quad.result_mode = "REPLACE"
    result = remesh()
    assert result is source and [v.name for v in result.modifiers] == expected["modifiers"]
    for name in (
        "materials",
        "uv_maps",
        "attributes",
        "mask",
        "creases",
        "seams",
        "vertex_groups",
        "custom_properties",
    ):
        CHECKS[name](source, result)
    assert result.data.shape_keys.key_blocks["More"].relative_key.name == "Lift"
    assert len(bpy.data.meshes) == 1
    assert_sound(result)


def test_a_material_made_anew_meanwhile_is_found():
    """As undo does during a run."""
    source = add_grid(quads=60)
    source.data.materials.append(bpy.data.materials.new("Paint"))
    source.data.materials.append(None)
    task = prepare_task(source, bpy.context.evaluated_depsgraph_get())
    bpy.data.materials.remove(bpy.data.materials["Paint"])
    bpy.data.materials.new("Paint")
    result = place_result(bpy.context, source, task, task.solve())
    assert [material and material.name for material in result.data.materials] == ["Paint", None]


def test_every_type_on_every_domain():
    """What cannot be mixed comes from the source as it is; what can lies between its values."""
    from hybrid_quad.blender.transfer.attributes import STORAGES

    source = add_grid(quads=60)
    rng = np.random.default_rng(3)
    kinds = {}
    for data_type, storage in STORAGES.items():
        for domain in ("POINT", "EDGE", "FACE", "CORNER"):
            if data_type == "FLOAT2" and domain == "CORNER":
                continue  # which is a UV map from Blender 3.5 on
            name = f"{data_type} {domain}"
            try:
                items = source.data.attributes.new(name, data_type, domain).data
            except TypeError:
                break  # a type of later Blenders
            if data_type == "STRING":
                for index, item in enumerate(items):
                    item.value = str(index % 5) if isinstance(item.value, str) else str(index % 5).encode()
            else:
                values = rng.integers(0, 2, (len(items), storage.width)).astype(storage.dtype)
                items.foreach_set(storage.value, values.ravel())
            kinds[name] = (data_type, domain)
    assert len(kinds) >= 35
    result = remesh()
    for name, (data_type, domain) in kinds.items():
        attribute = result.data.attributes[name]
        assert (attribute.data_type, attribute.domain) == (data_type, domain)
        storage = STORAGES[data_type]
        if data_type == "STRING":
            assert len({item.value for item in attribute.data if item.value}) == 5, name
            continue
        values = read(attribute.data, storage.value, storage.dtype, storage.width)
        assert values.min() == 0 and values.max() > 0.5, name
        assert values.max() <= 1
        if not storage.is_continuous or domain in ("FACE", "EDGE"):
            assert set(np.unique(values)) == {0, 1}, name
