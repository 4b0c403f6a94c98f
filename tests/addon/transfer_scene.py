"""One object that carries every kind of data, and for each kind a check that its result carries it too."""

from __future__ import annotations

import bpy
import numpy as np

from scenes import add_grid, points_of

SLOPE = np.array([0.2, -0.1, 0.0])


def linear(points) -> np.ndarray:
    """What the scene's continuous values are of a position."""
    return 0.5 + np.asarray(points) @ SLOPE


def corners_of(mesh) -> np.ndarray:
    """(C,) vertices."""
    return read(mesh.loops, "vertex_index", np.int32)


def read(collection, name, dtype, width=1) -> np.ndarray:
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def middles_of(obj) -> np.ndarray:
    return read(obj.data.polygons, "center", np.float32, 3).astype(float)


def uv_of(layer) -> np.ndarray:
    if hasattr(layer, "uv"):
        return read(layer.uv, "vector", np.float32, 2).astype(float)
    return read(layer.data, "uv", np.float32, 2).astype(float)


def set_uv(layer, values) -> None:
    items, name = (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")
    items.foreach_set(name, np.ascontiguousarray(values, np.float32).ravel())


def middle_line_of(mesh, reach=1e-4) -> np.ndarray:
    """(E,) which edges lie on x = 0."""
    points = read(mesh.vertices, "co", np.float32, 3)
    return (np.abs(points[read(mesh.edges, "vertices", np.int32, 2)][:, :, 0]) < reach).all(axis=1)


def add_everything() -> bpy.types.Object:
    """A square in the plane z = 0; a marked line at x = 0 parts it; values are linear or those of a half."""
    obj = add_grid(cells=12, quads=150)
    mesh = obj.data
    points, middles = points_of(obj), middles_of(obj)
    corners = corners_of(mesh)
    right = middles[:, 0] > 0
    _add_face_data(mesh, right)
    _add_maps(mesh, points[corners], np.repeat(right, 4))
    _add_attributes(mesh, points, points[corners], right)
    _add_marks(mesh)
    _add_groups(obj, points)
    _add_keys(obj)
    _add_object_data(obj)
    bpy.context.view_layer.update()
    return obj


def _add_face_data(mesh, right) -> None:
    for name in ("Left", "Right"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", right.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(right), bool))
    if bpy.app.version >= (3, 6):
        mesh.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", 3 + right.astype(np.int32))


def _add_maps(mesh, at_corners, right) -> None:
    whole, cut = mesh.uv_layers.new(name="Whole"), mesh.uv_layers.new(name="Cut")
    whole, cut = mesh.uv_layers["Whole"], mesh.uv_layers["Cut"]
    set_uv(whole, at_corners[:, :2])
    set_uv(cut, at_corners[:, :2] + np.where(right, 10.0, 0.0)[:, None])
    mesh.uv_layers.active = mesh.uv_layers["Cut"]
    mesh.uv_layers["Whole"].active_render = True


def _add_attributes(mesh, points, at_corners, right) -> None:
    def add(name, data_type, domain, values, value="value"):
        target = mesh.attributes.new(name, data_type, domain)
        target.data.foreach_set(value, np.ascontiguousarray(values).ravel())

    add("Point Float", "FLOAT", "POINT", linear(points).astype(np.float32))
    add("Point Vector", "FLOAT_VECTOR", "POINT", points.astype(np.float32), "vector")
    add("Point Int", "INT", "POINT", np.where(points[:, 0] > 0.3, 7, 5).astype(np.int32))
    add("Corner Float", "FLOAT", "CORNER", linear(at_corners).astype(np.float32))
    add("Corner Int", "INT", "CORNER", np.repeat(np.where(right, 4, 2), 4).astype(np.int32))
    add("Face Bool", "BOOLEAN", "FACE", right)
    add("Face Float", "FLOAT", "FACE", np.where(right, 1.5, -1.5).astype(np.float32))
    add("Edge Int", "INT", "EDGE", np.where(middle_line_of(mesh), 9, 1).astype(np.int32))
    colors = np.repeat(linear(points)[:, None], 4, axis=1).astype(np.float32)
    add("Point Color", "FLOAT_COLOR", "POINT", colors, "color")
    add("Corner Color", "BYTE_COLOR", "CORNER", np.repeat(np.where(right, 1.0, 0.0), 16).astype(np.float32), "color")
    text = mesh.attributes.new("Face Text", "STRING", "FACE")
    for item, is_right in zip(text.data, right, strict=True):
        side = "right" if is_right else "left"
        item.value = side if isinstance(item.value, str) else side.encode()
    names = [layer.name for layer in mesh.color_attributes]
    mesh.color_attributes.active_color_index = names.index("Corner Color")
    mesh.color_attributes.render_color_index = names.index("Point Color")


def _add_marks(mesh) -> None:
    from hybrid_quad.blender import edge_marks

    on_line = middle_line_of(mesh)
    edges = read(mesh.edges, "vertices", np.int32, 2)[on_line]
    marks = edge_marks.SHARP | edge_marks.SEAM | edge_marks.CREASE | edge_marks.BEVEL | edge_marks.FREESTYLE
    weights = np.ones(len(edges), np.float32)
    edge_marks.write(
        mesh, edges, edge_marks.EdgeValues(np.full(len(edges), marks, np.uint16), 0.75 * weights, 0.25 * weights)
    )
    points = read(mesh.vertices, "co", np.float32, 3)
    corner = (points[:, :2] == 1).all(axis=1).astype(np.float32)
    edge_marks.VERTEX_CREASE.write(mesh, 0.5 * corner)
    edge_marks.VERTEX_BEVEL.write(mesh, 0.75 * corner)
    set_mask(mesh, linear(points))
    mesh.update()


def set_mask(mesh, values) -> None:
    from hybrid_quad.blender.transfer import mask

    mask._items(mesh).foreach_set("value", np.ascontiguousarray(values, np.float32))


def _add_groups(obj, points) -> None:
    for name in ("Up", "Down", "Nobody"):
        obj.vertex_groups.new(name=name)
    for index, weight in enumerate(linear(points)):
        obj.vertex_groups["Up"].add([index], weight, "REPLACE")
        obj.vertex_groups["Down"].add([index], 1 - weight, "REPLACE")
    obj.vertex_groups["Down"].lock_weight = True
    obj.vertex_groups.active_index = 1


def _add_keys(obj) -> None:
    obj.shape_key_add(name="Basis")
    lift, more = obj.shape_key_add(name="Lift"), obj.shape_key_add(name="More")
    for index, vertex in enumerate(obj.data.vertices):
        height = float(linear(vertex.co))
        lift.data[index].co.z = height
        more.data[index].co.z = height
        more.data[index].co.x = vertex.co.x + 0.25
    more.relative_key = lift
    more.vertex_group = "Up"
    more.mute = True
    lift.slider_max, lift.value = 2.0, 0.5
    lift.driver_add("value").driver.expression = "0.5"


def _add_object_data(obj) -> None:
    scene = bpy.context.scene.collection
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    parent, target = bpy.data.objects.new("Parent", None), bpy.data.objects.new("Target", None)
    for each in (rig, parent, target):
        scene.objects.link(each)
    armature = obj.modifiers.new("Armature", "ARMATURE")
    armature.object = rig
    armature.use_deform_preserve_volume = True
    later = obj.modifiers.new("Later", "SUBSURF")
    later.show_viewport, later.levels = False, 3
    obj.driver_add('modifiers["Later"].levels').driver.expression = "3"
    parent.location = (1, 2, 3)
    parent.scale = (1, 1, 2)
    bpy.context.view_layer.update()
    obj.parent = parent
    obj.matrix_parent_inverse = parent.matrix_world.inverted()
    for name in ("One", "Two"):
        collection = bpy.data.collections.new(name)
        scene.children.link(collection)
        collection.objects.link(obj)
    scene.objects.unlink(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    constraint = obj.constraints.new("COPY_LOCATION")
    constraint.target, constraint.influence = target, 0.5
    target.location = (4, 0, 0)
    obj.rotation_mode = "XYZ"
    obj.rotation_euler = (0.1, 0.2, 0.3)
    obj.delta_location = (0, 0, 1)
    obj.keyframe_insert("location", frame=1)
    obj["number"], obj.data["word"] = 7, "mesh"
    obj.pass_index, obj.display_type = 3, "SOLID"
