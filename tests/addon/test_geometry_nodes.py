"""Geometry Nodes write and edit what guides the quads: the evaluated mesh counts, and the object's own stays as it is."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest

from hybrid_quad.blender.preview import sessions
from hybrid_quad.blender.remesh_task import prepare_task
from scenes import activate, add_cube, add_grid, assert_sound, faces_of, points_of, remesh

DIAGONAL = np.array([1.0, 1.0, 0.0]) / np.sqrt(2)


class Nodes:
    """A modifier that hands a mesh from node to node."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self.tree = bpy.data.node_groups.new("Guides", "GeometryNodeTree")
        if hasattr(self.tree, "interface"):  # from Blender 4.0 on
            for direction in ("INPUT", "OUTPUT"):
                self.tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
        else:
            for sockets in (self.tree.inputs, self.tree.outputs):
                sockets.new("NodeSocketGeometry", "Geometry")
        self.out = self.tree.nodes.new("NodeGroupOutput")
        self.link(self.tree.nodes.new("NodeGroupInput").outputs[0], self.out.inputs[0])
        self.modifier = obj.modifiers.new("Guides", "NODES")
        self.modifier.node_group = self.tree

    def link(self, start: Any, end: Any) -> None:
        self.tree.links.new(start, end)

    def named(self, name: str, data_type: str) -> Any:
        """The socket that gives an attribute's values."""
        node = self.tree.nodes.new("GeometryNodeInputNamedAttribute")
        node.data_type = data_type
        node.inputs["Name"].default_value = name
        return next(socket for socket in node.outputs if socket.name == "Attribute" and socket.enabled)

    def store(self, name: str, data_type: str, domain: str, value: Any) -> None:
        """Has the mesh carry an attribute: a constant, or what a socket gives. (Blender 3.4 stores everywhere.)"""
        node = self.tree.nodes.new("GeometryNodeStoreNamedAttribute")
        node.data_type, node.domain = data_type, domain
        node.inputs["Name"].default_value = name
        self.link(self.out.inputs[0].links[0].from_socket, node.inputs["Geometry"])
        self.link(node.outputs["Geometry"], self.out.inputs[0])
        wanted = next(socket for socket in node.inputs if socket.name == "Value" and socket.enabled)
        if isinstance(value, bpy.types.NodeSocket):
            self.link(value, wanted)
        else:
            wanted.default_value = value

    def math(self, operation: str, first: Any, second: float) -> Any:
        """The socket that gives a number computed of another one."""
        node = self.tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        self.link(first, node.inputs[0])
        node.inputs[1].default_value = second
        return node.outputs[0]

    def two_where_x_is_over(self, border: float) -> Any:
        """The socket that gives 2 where the place along the x axis is beyond a border, and 1 elsewhere."""
        parts = self.tree.nodes.new("ShaderNodeSeparateXYZ")
        self.link(self.tree.nodes.new("GeometryNodeInputPosition").outputs[0], parts.inputs[0])
        return self.math("ADD", self.math("GREATER_THAN", parts.outputs[0], border), 1.0)


def _task(obj: bpy.types.Object):
    bpy.context.view_layer.update()
    return prepare_task(obj, bpy.context.evaluated_depsgraph_get())


def _paint(obj: bpy.types.Object, name: str, values: np.ndarray) -> None:
    data_type, key = ("FLOAT", "value") if values.ndim == 1 else ("FLOAT_VECTOR", "vector")
    attribute = obj.data.attributes.new(name, data_type, "POINT")
    attribute.data.foreach_set(key, values.astype(np.float32).ravel())


def _inner_sides_of(obj: bpy.types.Object) -> np.ndarray:
    """(k, 3) edges of the quads in the middle of the square, where its border does not say how they run."""
    faces, points = np.array(faces_of(obj)), points_of(obj)
    inner = faces[np.abs(points[faces].mean(axis=1)).max(axis=1) < 0.4]
    return (points[np.roll(inner, -1, axis=1)] - points[inner]).reshape(-1, 3)


def test_quads_are_small_where_nodes_write_density():
    obj = add_grid(cells=20, quads=400)
    nodes = Nodes(obj)
    nodes.store("hybrid_quad_density", "FLOAT", "POINT", nodes.two_where_x_is_over(0.0))
    result = remesh()
    assert_sound(result)
    middles = points_of(result)[np.array(faces_of(result))].mean(axis=1)[:, 0]
    fine, coarse = (middles > 0.3).sum(), (middles < -0.3).sum()
    assert 3.0 < fine / coarse < 5.0  # half as long: four times as many
    assert "hybrid_quad_density" not in obj.data.attributes


def test_quads_run_as_nodes_point():
    obj = add_grid(cells=20, quads=1600)
    Nodes(obj).store("hybrid_quad_guide", "FLOAT_VECTOR", "FACE", tuple(DIAGONAL))
    result = remesh()
    assert_sound(result)
    sides = _inner_sides_of(result)
    along, across = np.abs(sides @ DIAGONAL), np.abs(np.cross(sides, DIAGONAL)[:, 2])
    off = np.degrees(np.arctan2(np.minimum(along, across), np.maximum(along, across)))
    assert np.median(off) < 10.0  # without it, 45


def test_nodes_read_and_edit_what_is_painted():
    obj = add_grid()
    count = len(obj.data.vertices)
    painted = np.where(points_of(obj)[:, 0] > 0, 3.0, 1.0)
    _paint(obj, "hybrid_quad_density", painted)
    _paint(obj, "hybrid_quad_guide", np.tile([0.5, 0.0, 0.0], (count, 1)))
    nodes = Nodes(obj)
    halved = nodes.math("MULTIPLY", nodes.named("hybrid_quad_density", "FLOAT"), 0.5)
    nodes.store("hybrid_quad_density", "FLOAT", "POINT", halved)
    turned = nodes.tree.nodes.new("ShaderNodeVectorRotate")
    turned.inputs["Angle"].default_value = np.pi / 4
    nodes.link(nodes.named("hybrid_quad_guide", "FLOAT_VECTOR"), turned.inputs["Vector"])
    nodes.store("hybrid_quad_guide", "FLOAT_VECTOR", "POINT", turned.outputs[0])

    task = _task(obj)
    assert task.source.density == pytest.approx(0.5 * painted)
    assert task.guides() == pytest.approx(np.tile(0.5 * DIAGONAL, (count, 1)), abs=1e-6)
    own = [item.value for item in obj.data.attributes["hybrid_quad_density"].data]
    assert own == painted.tolist()
    nodes.modifier.show_viewport = False
    assert _task(obj).source.density == pytest.approx(painted)


def test_nodes_choose_edges_to_keep_and_count_quads():
    obj = add_cube(segments=4)
    obj.hybrid_quad.use_sharp_angle = False
    nodes = Nodes(obj)
    angle = nodes.tree.nodes.new("GeometryNodeInputMeshEdgeAngle").outputs["Unsigned Angle"]
    is_crease = nodes.math("GREATER_THAN", angle, 1.0)
    nodes.store("hybrid_quad_feature", "BOOLEAN", "EDGE", is_crease)
    nodes.store("hybrid_quad_count", "INT", "EDGE", nodes.math("MULTIPLY", is_crease, 7.0))
    task = _task(obj)
    assert len(task.marked_edges) == 12 * 4
    places = np.sort(np.abs(task.source.vertices[task.marked_edges]), axis=-1)
    assert places[:, :, 1:] == pytest.approx(1.0)  # on two sides of the cube
    assert (task.source.counts == 7).sum() == 12 * 4


def test_nodes_on_new_geometry_count_on_that():
    obj = add_grid(cells=4)
    nodes = Nodes(obj)
    finer = nodes.tree.nodes.new("GeometryNodeSubdivideMesh")
    finer.inputs["Level"].default_value = 2
    nodes.link(nodes.out.inputs[0].links[0].from_socket, finer.inputs["Mesh"])
    nodes.link(finer.outputs["Mesh"], nodes.out.inputs[0])
    nodes.store("hybrid_quad_density", "FLOAT", "POINT", nodes.two_where_x_is_over(0.1))
    source = _task(obj).source
    assert len(source.vertices) == 17 * 17
    assert source.density == pytest.approx(np.where(source.vertices[:, 0] > 0.1, 2.0, 1.0))


def test_the_preview_follows_what_nodes_do():
    obj = activate(add_grid())
    nodes = Nodes(obj)
    asked = bpy.context.window_manager.hybrid_quad_preview
    asked.show_field = True
    try:
        sessions.step(at_once=True)
        assert sessions.field.session._changed_at is None
        nodes.store("hybrid_quad_density", "FLOAT", "POINT", 2.0)
        bpy.context.view_layer.update()
        assert sessions.field.session._changed_at is not None
    finally:
        asked.show_field = False
