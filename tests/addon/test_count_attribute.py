"""Numbers of quads along chains of edges, from the attribute of the mesh's edges."""

from __future__ import annotations

import bpy
import numpy as np

from hybrid_quad.blender.remesh_task import prepare_task
from scenes import add_cube, points_of


def _task(obj):
    bpy.context.view_layer.update()
    return prepare_task(obj, bpy.context.evaluated_depsgraph_get())


def _ask(obj, number: int, is_asked) -> None:
    points = points_of(obj)
    values = [number if all(is_asked(points[v]) for v in edge.vertices) else 0 for edge in obj.data.edges]
    obj.data.attributes.new("hybrid_quad_count", "INT", "EDGE").data.foreach_set("value", values)


def _on_edge(point) -> bool:
    return bool(np.allclose(point[:2], -1))


def test_the_attribute_asks_for_a_number_of_quads_along_a_chain():
    obj = add_cube()
    _ask(obj, 9, _on_edge)
    obj.scale = (2, 1, 1)
    task = _task(obj)
    ((path, number),) = task.curve_counts
    assert number == 9
    assert len(path) == 7
    result = task.solve()
    assert result.report["curve_counts"] == [{"asked": 9, "got": 9, "reason": ""}]
    ends = task.source.vertices[[path[0], path[-1]]]
    on = np.isclose(result.vertices[:, :2], ends[0, :2], atol=1e-5).all(axis=1)
    assert on[result.feature_edges].all(axis=1).sum() == 9


def test_nothing_is_asked_without_the_attribute_or_where_it_is_zero():
    obj = add_cube()
    assert _task(obj).curve_counts == []
    _ask(obj, 0, _on_edge)
    assert _task(obj).curve_counts == []
