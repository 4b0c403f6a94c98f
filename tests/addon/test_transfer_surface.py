"""Where one surface answers for another: thin sheets, creases, mirrored and squeezed objects, custom normals."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from hybrid_quad.blender.result_mesh import read_report
from scenes import add_cube, add_object, add_sphere, assert_sound, faces_of, points_of, remesh, sharp_edges_of
from transfer_scene import corners_of, middles_of, read, set_uv, uv_of


def add_plate(thickness: float, cells: int = 16) -> bpy.types.Object:
    """A bent plate, with 1 in the attribute "Side" above and 0 below; the sides' material, UV island and color differ too."""
    steps = np.linspace(-1, 1, cells + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(steps, steps))
    bend = 0.3 * x**2
    points = np.concatenate([np.stack([x, y, bend + thickness * side], axis=1) for side in (1, 0)])
    count, row = len(x), cells + 1
    faces, border = [], []
    for i in range(cells):
        for j in range(cells):
            top = (i * row + j, i * row + j + 1, (i + 1) * row + j + 1, (i + 1) * row + j)
            faces += [top, tuple(count + v for v in reversed(top))]
    border += [(j, j + 1) for j in range(cells)]
    border += [(i * row + cells, (i + 1) * row + cells) for i in range(cells)]
    border += [(cells * row + j + 1, cells * row + j) for j in range(cells)]
    border += [((i + 1) * row, i * row) for i in range(cells)]
    faces += [(a, count + a, count + b, b) for a, b in border]
    obj = add_object("Plate", points, faces)
    side = (np.arange(2 * count) < count).astype(np.float32)
    obj.data.attributes.new("Side", "FLOAT", "POINT").data.foreach_set("value", side)
    is_top = np.array([len(set(f) - set(range(count))) == 0 for f in faces])
    obj.data.attributes.new("Top", "BOOLEAN", "FACE").data.foreach_set("value", is_top)
    for name in ("Below", "Above"):
        obj.data.materials.append(bpy.data.materials.new(name))
    obj.data.polygons.foreach_set("material_index", is_top.astype(np.int32))
    corners, top_corners = corners_of(obj.data), np.repeat(is_top, 4)
    obj.data.uv_layers.new(name="Sides")
    set_uv(obj.data.uv_layers["Sides"], points[corners][:, :2] + np.where(top_corners, 5.0, 0.0)[:, None])
    colors = np.repeat(top_corners[:, None], 4, axis=1).astype(np.float32)
    obj.data.attributes.new("Color", "FLOAT_COLOR", "CORNER").data.foreach_set("color", colors.ravel())
    obj.hybrid_quad.quads = 400
    return obj


@pytest.mark.parametrize("thickness", [0.03, 0.002])
def test_the_sides_of_a_thin_sheet_keep_apart(thickness):
    add_plate(thickness)
    result = remesh()
    points, faces = points_of(result), np.array(faces_of(result))
    normals = read(result.data.polygons, "normal", np.float32, 3)
    is_top = read(result.data.attributes["Top"].data, "value", np.bool_)
    clear = np.abs(normals[:, 2]) > 0.5
    assert clear.sum() > 300
    is_up = normals[:, 2] > 0
    assert np.array_equal(is_top[clear], is_up[clear])
    assert np.array_equal(read(result.data.polygons, "material_index", np.int32)[clear], is_up[clear])
    clear_corners, up_corners = np.repeat(clear, 4), np.repeat(is_up, 4)
    colors = read(result.data.attributes["Color"].data, "color", np.float32, 4)
    assert np.array_equal(colors[clear_corners, 0], up_corners[clear_corners])
    places = uv_of(result.data.uv_layers["Sides"]) - np.where(up_corners, 5.0, 0.0)[:, None]
    assert np.abs(places - points[corners_of(result.data)][:, :2])[clear_corners].max() < 0.05
    # Vertices on the rim belong to both.
    inner = (np.abs(points[:, :2]).max(axis=1) < 0.95) & np.isin(np.arange(len(points)), faces[clear])
    side = read(result.data.attributes["Side"].data, "value", np.float32)
    up = np.zeros(len(points))
    np.add.at(up, faces[clear].ravel(), np.repeat(normals[clear, 2], 4))
    assert np.abs(side[inner] - (up[inner] > 0)).max() < 0.25
    assert read_report(result)["transfer"]["vertices_against"] == 0


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (3, 1, 0.5), (-2, -1, -1)])
def test_scaled_and_mirrored_objects_carry_the_same(scale):
    source = add_cube(segments=8, quads=400)
    points = points_of(source)
    values = source.data.attributes.new("Position", "FLOAT_VECTOR", "POINT")
    values.data.foreach_set("vector", points.astype(np.float32).ravel())
    at_corners = points[corners_of(source.data)] + 5 * np.repeat(
        read(source.data.polygons, "normal", np.float32, 3), 4, axis=0
    )
    values = source.data.attributes.new("Sided", "FLOAT_VECTOR", "CORNER")
    values.data.foreach_set("vector", at_corners.astype(np.float32).ravel())
    source.scale = scale
    result = remesh()
    points = points_of(result)
    found = read(result.data.attributes["Position"].data, "vector", np.float32, 3)
    assert np.abs(found - points).max() < 2e-6
    # What changes at the cube's edges changes there on the result too, as its edges are kept.
    normals = np.repeat(np.round(read(result.data.polygons, "normal", np.float32, 3)), 4, axis=0)
    found = read(result.data.attributes["Sided"].data, "vector", np.float32, 3)
    assert np.abs(found - points[corners_of(result.data)] - 5 * normals).max() < 1e-5


def corner_normals(obj) -> np.ndarray:
    if hasattr(obj.data, "calc_normals_split"):
        obj.data.calc_normals_split()
        return read(obj.data.loops, "normal", np.float32, 3).astype(float)
    return read(obj.data.corner_normals, "vector", np.float32, 3).astype(float)


def set_custom_normals(obj, normals) -> None:
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), bool))
    if hasattr(obj.data, "use_auto_smooth"):
        obj.data.use_auto_smooth = True
    obj.data.normals_split_custom_set(normals.tolist())
    obj.data.update()


def test_custom_normals_come_along():
    source = add_sphere(quads=500)
    source.hybrid_quad.use_sharp_angle = False
    corners = corners_of(source.data)
    wanted = points_of(source)[corners] * (1, 1, 0.2)  # as if it were a tall ellipsoid
    set_custom_normals(source, wanted / np.linalg.norm(wanted, axis=1, keepdims=True))
    result = remesh()
    assert result.data.has_custom_normals and len(sharp_edges_of(result)) == 0
    wanted = points_of(result)[corners_of(result.data)] * (1, 1, 0.2)
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    assert (corner_normals(result) * wanted).sum(axis=1).min() > np.cos(np.radians(6))
    source.hybrid_quad.transfer.use_custom_normals = False
    source.hide_set(False)
    bpy.context.view_layer.objects.active = source
    assert not remesh().data.has_custom_normals


def test_custom_normals_are_split_at_sharp_edges_only():
    source = add_cube(segments=6, quads=400)
    # Flat faces of a smoothly shaded cube, as weighted normals make them.
    set_custom_normals(source, np.repeat(read(source.data.polygons, "normal", np.float32, 3), 4, axis=0))
    result = remesh()
    assert_sound(result)
    flat = np.repeat(read(result.data.polygons, "normal", np.float32, 3), 4, axis=0)
    assert (corner_normals(result) * flat).sum(axis=1).min() > 0.9999
    points, sharp = points_of(result), sharp_edges_of(result)
    assert ((np.abs(np.abs(points) - 1) < 1e-4).sum(axis=1) >= 2)[sharp].all()


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="free normals came with Blender 4.5")
def test_free_normals_stay_free():
    source = add_sphere(quads=300)
    wanted = points_of(source)
    attribute = source.data.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", wanted.astype(np.float32).ravel())
    result = remesh()
    attribute = result.data.attributes["custom_normal"]
    assert (attribute.data_type, attribute.domain) == ("FLOAT_VECTOR", "POINT")
    found = read(attribute.data, "vector", np.float32, 3)
    points = points_of(result)
    assert ((found * points).sum(axis=1) / np.linalg.norm(points, axis=1)).min() > 0.99


def test_materials_keep_their_share_of_the_surface():
    source = add_sphere(quads=1500)
    for name in ("A", "B", "C"):
        source.data.materials.append(bpy.data.materials.new(name))
    middles = middles_of(source)
    source.data.polygons.foreach_set("material_index", (middles[:, 2] > 0.3).astype(np.int32) + (middles[:, 0] > 0.2))
    source.data.update()

    def shares(obj):
        areas, slots = read(obj.data.polygons, "area", np.float32), read(obj.data.polygons, "material_index", np.int32)
        return np.bincount(slots, areas, minlength=3) / areas.sum()

    expected = shares(source)
    assert np.abs(shares(remesh()) - expected).max() < 0.02
