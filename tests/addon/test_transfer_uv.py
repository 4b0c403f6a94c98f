"""UV maps of real models: no face of the result lies in two islands, whether the result follows the seams or not."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.edge_borders import EdgeSides
from hybrid_quad.core.mesh_arrays import Polygons
from scenes import add_object, assert_sound, points_of, remesh
from transfer_scene import corners_of, read, set_uv, uv_of

MESHES = Path(__file__).resolve().parents[1] / "data" / "meshes"


def add_model(name: str) -> bpy.types.Object:
    from hybrid_quad.core.mesh_io import read_mesh

    vertices, polygons = read_mesh(MESHES / name)[:2]
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    return add_object(name.partition(".")[0], vertices, [face.tolist() for face in faces])


def unwrap(obj, angle=1.15) -> None:
    """Islands that are well apart from each other."""
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=angle, island_margin=0.02)
    bpy.ops.object.mode_set(mode="OBJECT")


def polygons_of(obj) -> Polygons:
    return Polygons(read(obj.data.polygons, "loop_total", np.int32), corners_of(obj.data).astype(np.int32))


def cut_edges(obj) -> np.ndarray:
    """(E,) edges at which the active map is cut."""
    edges = read(obj.data.edges, "vertices", np.int32, 2)
    sides = EdgeSides(polygons_of(obj), edges, len(obj.data.vertices))
    return sides.where_corners_differ(uv_of(obj.data.uv_layers.active), 1e-5)


def stretch_of(obj) -> np.ndarray:
    """(F,) longest side of each face in the map, by its length on the surface."""
    polygons, places, points = polygons_of(obj), uv_of(obj.data.uv_layers.active), points_of(obj)
    starts = np.cumsum(polygons.sizes) - polygons.sizes
    following = np.arange(1, len(places) + 1)
    following[starts + polygons.sizes - 1] = starts
    on_surface = points[polygons.vertices]
    ratio = np.linalg.norm(places[following] - places, axis=1) / np.linalg.norm(
        on_surface[following] - on_surface, axis=1
    ).clip(1e-9)
    return np.maximum.reduceat(ratio, starts)


@pytest.mark.parametrize("name", ["c3d_spot_triangulated.obj", "c3d_fandisk.obj"])
@pytest.mark.parametrize("follows_seams", [False, True])
def test_no_face_lies_in_two_islands(name, follows_seams):
    source = add_model(name)
    unwrap(source)
    source.hybrid_quad.quads = 1500
    source.hybrid_quad.use_uv_borders = follows_seams
    result = remesh()
    assert_sound(result)
    # A face with corners of two islands, or from both sides of a seam, would be stretched many times as much as any other.
    assert stretch_of(result).max() < 1.25 * stretch_of(source).max()

    # The map is cut where the source's is: about as long, not everywhere.
    def cut_length(obj):
        ends = points_of(obj)[read(obj.data.edges, "vertices", np.int32, 2)[cut_edges(obj)]]
        return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()

    assert 0.9 * cut_length(source) < cut_length(result) < 1.1 * cut_length(source)


def test_a_seam_within_one_island_is_not_crossed():
    """A tube has one island, whose two ends meet at the seam."""
    around, along = 48, 24
    angle = 2 * np.pi * np.arange(around) / around
    points = np.array([(np.cos(a), np.sin(a), z) for z in np.linspace(0, 3, along + 1) for a in angle])
    faces = [
        (
            row * around + col,
            row * around + (col + 1) % around,
            (row + 1) * around + (col + 1) % around,
            (row + 1) * around + col,
        )
        for row in range(along)
        for col in range(around)
    ]
    source = add_object("Tube", points, faces)
    columns = np.tile(np.arange(around), along)
    u = np.stack([columns, columns + 1, columns + 1, columns], axis=1) / around
    layer = source.data.uv_layers.new(name="Map")
    set_uv(layer, np.stack([u.ravel(), points[np.array(faces).ravel(), 2]], axis=1))
    seam = [bool(abs(points[list(edge.vertices)] - (1, 0, 0))[:, :2].max() < 1e-6) for edge in source.data.edges]
    source.data.edges.foreach_set("use_seam", seam)
    source.hybrid_quad.quads = 400
    result = remesh()
    places = uv_of(result.data.uv_layers["Map"]).reshape(-1, 4, 2)
    assert np.ptp(places[:, :, 0], axis=1).max() < 0.15
    # Everywhere the angle, on the one side of the seam or beyond it on the other.
    at = points_of(result)[corners_of(result.data)]
    turns = np.arctan2(at[:, 1], at[:, 0]) / (2 * np.pi)
    off = places.reshape(-1, 2)[:, 0] - turns
    assert np.abs(off - np.round(off)).max() < 0.01
    assert np.abs(places.reshape(-1, 2)[:, 1] - at[:, 2]).max() < 0.01
    # The seam is marked anew where the map is now cut, and goes through from end to end.
    seams = read(result.data.edges, "use_seam", np.bool_)
    assert np.array_equal(seams, cut_edges(result))
    heights = points_of(result)[read(result.data.edges, "vertices", np.int32, 2)[seams]][:, :, 2]
    assert heights.min() < 1e-3 and heights.max() > 3 - 1e-3


def test_split_models_are_cut_where_they_were_split():
    """Models from games have vertices of their own for each island."""
    source = add_model("c3d_spot_triangulated.obj")
    unwrap(source)
    whole = uv_of(source.data.uv_layers.active)
    corners = corners_of(source.data)
    keys, first, inverse = np.unique(
        np.column_stack([corners, np.round(whole * 1e5).astype(np.int64)]),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    inverse = inverse.reshape(-1)
    assert len(keys) > len(source.data.vertices)
    sizes = read(source.data.polygons, "loop_total", np.int32)
    faces = [face.tolist() for face in np.split(inverse, np.cumsum(sizes)[:-1])]
    split = add_object("Split", points_of(source)[corners[first]], faces)
    set_uv(split.data.uv_layers.new(name="Map"), whole)
    split.hybrid_quad.quads = 1000
    result = remesh()
    assert stretch_of(result).max() < 1.25 * stretch_of(split).max()
    assert hybrid_quad.check(points_of(result), polygons_of(result)) == []
