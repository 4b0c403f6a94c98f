"""Painted directions, loops, rings and densities, by strokes that scripts give."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Euler, Vector

from hybrid_quad.blender.guide_attributes import DENSITY_ATTRIBUTE, GUIDE_ATTRIBUTE
from hybrid_quad.blender.painting.paint_operator import Pressure
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.core.painting.stroke_path import PenPlace
from scenes import add_cube, add_grid, add_sphere, points_of, remesh


def paint(points, **settings):
    """One stroke through some places of world space."""
    stroke = [
        {"name": "", "location": tuple(map(float, point)), "pressure": 1.0, "is_start": index == 0}
        for index, point in enumerate(points)
    ]
    return bpy.ops.hybrid_quad.paint_guide(stroke=stroke, **settings)


def directions_of(obj) -> np.ndarray:
    data = obj.data.attributes[GUIDE_ATTRIBUTE].data
    values = np.empty(3 * len(data), np.float32)
    data.foreach_get("vector", values)
    return values.reshape(-1, 3).astype(float)


def density_of(obj) -> np.ndarray:
    data = obj.data.attributes[DENSITY_ATTRIBUTE].data
    values = np.empty(len(data), np.float32)
    data.foreach_get("value", values)
    return values.astype(float)


def degrees_off(vectors: np.ndarray, direction) -> np.ndarray:
    """Of crosses from a direction, in the plane z = 0."""
    angle = np.arctan2(vectors[:, 1], vectors[:, 0]) - np.arctan2(direction[1], direction[0])
    return np.degrees(np.abs((angle + np.pi / 4) % (np.pi / 2) - np.pi / 4))


SLANTED = np.array([[-0.7, -0.4, 0], [0.7, 0.4, 0]])


def test_a_stroke_combs_directions_along_it():
    obj = add_grid(cells=30)
    assert paint(SLANTED, radius=0.3) == {"FINISHED"}
    guides, points = directions_of(obj), points_of(obj)
    along = SLANTED[1] / np.linalg.norm(SLANTED[1])
    away = np.linalg.norm(np.cross(points, along), axis=1)
    strength = np.linalg.norm(guides, axis=1)
    assert strength[(away < 0.05) & (np.abs(points @ along) < 0.6)].min() > 0.85
    assert not strength[away > 0.31].any()
    assert degrees_off(guides[strength > 0], along).max() < 0.1
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get()).guides() == pytest.approx(guides, abs=1e-5)


def test_quads_follow_what_was_painted():
    add_sphere(quads=1500)
    normal = np.array([0.5, 0.0, 0.9]) / np.linalg.norm([0.5, 0.0, 0.9])
    first = np.array([0.0, 1.0, 0.0])
    turn = np.linspace(-1, 1, 60)[:, None]
    paint(np.cos(turn) * first + np.sin(turn) * np.cross(normal, first), radius=0.25)
    result = remesh()
    points = points_of(result)
    pairs = np.array([tuple(edge.vertices) for edge in result.data.edges])
    middle, edges = points[pairs].mean(axis=1), points[pairs[:, 1]] - points[pairs[:, 0]]
    near = (np.abs(middle @ normal) < 0.08) & (middle @ first > 0.6)
    along = np.cross(normal, middle[near])
    cosine = np.einsum("ij,ij->i", edges[near], along)
    cosine /= np.linalg.norm(edges[near], axis=1) * np.linalg.norm(along, axis=1)
    off = np.degrees(np.arccos(np.clip(np.abs(cosine), 0, 1)))
    assert near.sum() > 20
    assert np.median(np.minimum(off, 90 - off)) <= 5


def test_strokes_are_of_the_world_and_what_is_stored_of_the_object():
    obj = add_grid(cells=40)
    obj.location, obj.rotation_euler, obj.scale = (3, -2, 1), Euler((0.3, 0.5, 0.7)), (2, 1, 1)
    bpy.context.view_layer.update()
    paint([obj.matrix_world @ Vector(point) for point in SLANTED.tolist()], radius=0.3)
    guides, points = directions_of(obj), points_of(obj)
    strength = np.linalg.norm(guides, axis=1)
    along = SLANTED[1] / np.linalg.norm(SLANTED[1])
    on = (np.linalg.norm(np.cross(points, along), axis=1) < 0.02) & (np.abs(points @ along) < 0.5)
    assert strength[on].min() > 0.9
    assert np.abs(guides[on] @ along / strength[on]).min() > 0.999
    stretch = np.array([2.0, 1.0])
    in_scene, line = points[:, :2] * stretch, SLANTED[1, :2] * stretch / np.linalg.norm(SLANTED[1, :2] * stretch)
    away = np.abs(in_scene[:, 0] * line[1] - in_scene[:, 1] * line[0])
    assert not strength[away > 0.3].any() and strength[(away < 0.1) & (np.abs(points[:, 0]) < 0.5)].min() > 0.7


def test_directions_of_faces_are_painted_on_faces():
    obj = add_grid(cells=30)
    obj.data.attributes.new(GUIDE_ATTRIBUTE, "FLOAT_VECTOR", "FACE")
    paint(SLANTED, radius=0.3)
    guides = directions_of(obj)
    assert len(guides) == len(obj.data.polygons)
    assert degrees_off(guides[guides.any(axis=1)], SLANTED[1]).max() < 0.1


def test_ctrl_erases_and_shift_smooths():
    obj = add_grid(cells=30)
    paint(SLANTED, radius=0.3)
    before = directions_of(obj)
    paint([(0.3, -0.5, 0), (0.3, 0.8, 0)], radius=0.2, falloff="CONSTANT")
    bent = directions_of(obj)
    assert not np.array_equal(before, bent)
    paint([(0.3, -0.5, 0), (0.3, 0.8, 0)], radius=0.3, mode="SMOOTH")
    even = directions_of(obj)
    first, second = (np.array([edge.vertices[i] for edge in obj.data.edges]) for i in (0, 1))
    both = (np.linalg.norm(bent[first], axis=1) > 0.3) & (np.linalg.norm(bent[second], axis=1) > 0.3)
    turn_of = [np.sum(1 - np.cos(4 * _angles(guides, first, second)[both])) for guides in (bent, even)]
    assert turn_of[1] < 0.7 * turn_of[0]
    paint([(-1, 0, 0), (1, 0, 0)], radius=3, falloff="CONSTANT", mode="INVERT")
    assert not directions_of(obj).any()


def _angles(guides: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    angle = np.arctan2(guides[:, 1], guides[:, 0])
    return angle[first] - angle[second]


def test_pressure_and_strength_make_strokes_stronger():
    strengths = []
    for pressure, strength in ((1.0, 1.0), (0.5, 1.0), (0.5, 0.5)):
        obj = add_grid(cells=20)
        points = [
            {"name": "", "location": tuple(point), "pressure": pressure, "is_start": False}
            for point in SLANTED.tolist()
        ]
        bpy.ops.hybrid_quad.paint_guide(stroke=points, radius=0.4, strength=strength)
        strengths.append(np.linalg.norm(directions_of(obj), axis=1).max())
    assert strengths == pytest.approx([1, 0.5, 0.25], abs=0.03)


@pytest.mark.parametrize("strength", [True, False])
@pytest.mark.parametrize("size", [True, False])
def test_pressure_counts_for_what_the_switches_say(strength, size):
    place = PenPlace(np.zeros(3), np.array((0, 0, 1.0)), 0)
    pressed = Pressure(strength=strength, size=size)
    half = pressed.on(place, 0.5)
    assert (half.pressure, half.size) == (0.5 if strength else 1, 0.5 if size else 1)
    assert pressed.on(place, 0.0).size > 0 and pressed.on(place, 7.0) == place
    brush = bpy.context.workspace.hybrid_quad_brush
    assert brush.use_pressure_strength and not brush.use_pressure_size  # as Blender's brushes have them


def _strokes(obj):
    bpy.context.view_layer.update()
    return prepare_task(obj, bpy.context.evaluated_depsgraph_get()).strokes


def _circle(radius: float = 0.6, count: int = 40) -> np.ndarray:
    turn = np.linspace(0, 2 * np.pi, count)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(count)], axis=1)


@pytest.mark.parametrize("kind", ["LOOP", "RING"])
def test_painted_lines_become_chains_of_edges_or_cross_them(kind):
    obj = add_sphere(quads=1500)
    obj.location, obj.scale = (1, 2, 3), (1.5, 1.5, 1.5)
    bpy.context.view_layer.update()
    lifted = np.array([0, 0, 0.4])
    assert paint(1.5 * (_circle(0.9) + lifted) + [1, 2, 3], kind=kind, radius=0.2) == {"FINISHED"}
    (child,) = obj.children
    assert child.type == "CURVE" and child["hybrid_quad_guide_kind"] == kind.lower()
    assert len(child.data.splines) == 1 and child.data.splines[0].use_cyclic_u
    (stroke,) = _strokes(obj)
    assert stroke.kind == kind.lower()
    assert np.linalg.norm(stroke.points, axis=1) == pytest.approx(1.5, abs=0.02)  # on the sphere of the scene
    assert GUIDE_ATTRIBUTE not in obj.data.attributes
    task = prepare_task(obj, bpy.context.evaluated_depsgraph_get())
    (guide,) = task.solve().report["guides"]
    assert guide["kind"] == kind.lower() and guide["met"]
    obj.hybrid_quad.use_painted_lines = False
    assert _strokes(obj) == ()


def test_lines_are_added_cut_smoothed_and_erased():
    obj = add_grid(cells=30)
    paint([(-0.8, 0.3, 0), (0.8, 0.3, 0)], kind="LOOP", radius=0.1)
    paint([(-0.8, -0.3, 0), (0.8, -0.3, 0)], kind="LOOP", radius=0.1)
    assert len(obj.children) == 1 and len(_strokes(obj)) == 2
    assert paint([(0, 0.8, 0), (0, 0.1, 0)], kind="LOOP", mode="INVERT", radius=0.1) == {"FINISHED"}
    strokes = _strokes(obj)
    assert len(strokes) == 3
    assert min(np.linalg.norm(stroke.points - (0, 0.3, 0), axis=1).min() for stroke in strokes) > 0.09
    assert paint([(0, 0.8, 0), (0, 0.1, 0)], kind="RING", mode="INVERT", radius=0.5) == {"CANCELLED"}
    point = obj.children[0].data.splines[0].points[20]
    x, y = point.co.x, point.co.y
    point.co.y += 0.1
    paint([(x, y + 0.1, 0)], kind="LOOP", mode="SMOOTH", radius=0.2)
    lines = [np.array([point.co[:2] for point in spline.points]) for spline in obj.children[0].data.splines]
    near = np.concatenate(lines)[np.linalg.norm(np.concatenate(lines) - (x, y), axis=1) < 0.15]
    assert 0.02 < np.abs(near[:, 1] - y).max() < 0.08
    paint([(-1, 0, 0), (1, 0, 0)], kind="LOOP", mode="INVERT", radius=3)
    assert not obj.children and not bpy.data.curves


def test_lines_edited_by_hand_stay_where_they_are_moved():
    obj = add_grid(cells=30)
    paint([(-0.8, 0.3, 0), (0.8, 0.3, 0)], kind="LOOP", radius=0.1)
    child = obj.children[0]
    child.location.y = -0.5
    assert np.abs(_strokes(obj)[0].points[:, 1] + 0.2).max() < 1e-5
    paint([(0.013, -0.8, 0), (0.013, 0.8, 0)], kind="LOOP", radius=0.1)
    added = max(_strokes(obj), key=lambda stroke: np.ptp(stroke.points[:, 1])).points
    assert np.ptp(added[:, 1]) > 1.5 and np.abs(added[:, 0] - 0.013).max() < 1e-5


def test_density_is_painted_denser_coarser_smooth_and_neutral():
    obj = add_grid(cells=20)
    line = [(-0.5, 0, 0), (0.5, 0, 0)]
    paint(line, kind="DENSITY", radius=0.4)
    dense = density_of(obj)
    assert dense.max() == pytest.approx(2, rel=0.02) and dense.min() == 1
    paint(line, kind="DENSITY", radius=0.4, mode="INVERT")
    assert density_of(obj) == pytest.approx(1, abs=1e-5)
    paint(line, kind="DENSITY", radius=0.4, density_action="COARSER", density_factor=3.0)
    assert density_of(obj).min() == pytest.approx(1 / 3, rel=0.02)
    before = density_of(obj)
    paint(line, kind="DENSITY", radius=0.6, mode="SMOOTH")
    assert density_of(obj).min() > before.min()
    paint(line, kind="DENSITY", radius=3, falloff="CONSTANT", density_action="NEUTRAL")
    assert density_of(obj) == pytest.approx(1)
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get()).source.density is None


def test_density_comes_from_a_vertex_group():
    obj = add_grid(cells=10)
    with pytest.raises(RuntimeError, match="no vertex group"):
        bpy.ops.hybrid_quad.density_from_layer()
    obj.vertex_groups.new(name="other").add([0], 1.0, "REPLACE")
    group = obj.vertex_groups.new(name="dense")
    group.add([1, 2], 1.0, "REPLACE")
    group.add([3], 0.5, "REPLACE")
    bpy.ops.hybrid_quad.density_from_layer(source="VERTEX_GROUP", layer="dense", low=0.5, high=2)
    assert density_of(obj)[:5] == pytest.approx([0.5, 2, 2, 1, 0.5])


@pytest.mark.parametrize(("data_type", "domain"), [("FLOAT_COLOR", "POINT"), ("BYTE_COLOR", "CORNER")])
def test_density_comes_from_a_color_attribute(data_type, domain):
    obj = add_grid(cells=10)
    layer = obj.data.color_attributes.new("Paint", data_type, domain)
    places = points_of(obj)
    if domain == "CORNER":
        places = places[[loop.vertex_index for loop in obj.data.loops]]
    shade = (places[:, 0] > 0.01).astype(np.float32)
    layer.data.foreach_set("color", np.repeat(shade, 4))
    bpy.ops.hybrid_quad.density_from_layer(source="COLOR", layer="Paint", low=1, high=4)
    right = points_of(obj)[:, 0] > 0.01
    assert density_of(obj) == pytest.approx(np.where(right, 4, 1), rel=1e-3)


def test_symmetry_of_the_mesh_paints_the_other_side_too():
    obj = add_cube(segments=10)
    obj.data.use_mirror_x = True
    paint([(0.3, -0.5, 1), (0.7, 0.5, 1)], radius=0.2)
    guides, points = directions_of(obj), points_of(obj)
    other = [int(np.linalg.norm(points - point * (-1, 1, 1), axis=1).argmin()) for point in points]
    assert guides.any() and degrees_off(guides * (-1, 1, 1) + 1e-9, (0.4, 1))[guides.any(axis=1)].min() < 1
    assert np.linalg.norm(guides, axis=1) == pytest.approx(np.linalg.norm(guides[other], axis=1), abs=1e-3)
    paint([(0.3, -0.5, 1), (0.7, 0.5, 1)], kind="LOOP", radius=0.2)
    assert sorted(np.sign(stroke.points[0, 0]) for stroke in _strokes(obj)) == [-1, 1]


def test_painting_on_what_modifiers_move_paints_the_mesh_that_carries_it():
    from hybrid_quad.blender.painting.paint_surface import PaintSurface

    obj = add_grid(cells=20)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Up")
    for point in key.data:
        point.co.z += 2
    key.value = 1.0
    bpy.context.view_layer.update()
    surface = PaintSurface(obj, bpy.context.evaluated_depsgraph_get())
    seen, place = surface.under(Vector((0.31, 0.17, 9)), Vector((0, 0, -1)))
    assert tuple(seen) == pytest.approx((0.31, 0.17, 2), abs=1e-5)
    assert place.position == pytest.approx([0.31, 0.17, 0], abs=1e-5)
    assert surface.under(Vector((3, 0, 9)), Vector((0, 0, -1))) is None
    obj.shape_key_clear()
    obj.modifiers.new("Beside", "ARRAY").relative_offset_displace = (2, 0, 0)
    obj.modifiers.new("Finer", "SUBSURF")
    bpy.context.view_layer.update()
    surface = PaintSurface(obj, bpy.context.evaluated_depsgraph_get())
    _, place = surface.under(Vector((0.31, 0.17, 9)), Vector((0, 0, -1)))
    assert place.position == pytest.approx([0.31, 0.17, 0], abs=1e-3)
    seen, place = surface.under(Vector((4.3, 0.17, 9)), Vector((0, 0, -1)))  # the second of the array
    assert place is None and seen.z == pytest.approx(0, abs=1e-5)


def test_what_is_painted_survives_saving(tmp_path):
    obj = add_grid(cells=20)
    paint(SLANTED, radius=0.3)
    paint(SLANTED, kind="DENSITY", radius=0.3)
    paint(_circle(), kind="RING", radius=0.1)
    before = directions_of(obj), density_of(obj), _strokes(obj)[0].points
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "painted.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "painted.blend"))
    obj = bpy.data.objects["Grid"]
    assert (directions_of(obj) == before[0]).all() and (density_of(obj) == before[1]).all()
    assert _strokes(obj)[0].points == pytest.approx(before[2])


def test_an_attribute_of_another_kind_is_an_error_and_stays():
    obj = add_grid()
    obj.data.attributes.new(GUIDE_ATTRIBUTE, "FLOAT", "POINT")
    with pytest.raises(RuntimeError, match="convert or remove it"):
        paint(SLANTED, radius=0.3)
    assert obj.data.attributes[GUIDE_ATTRIBUTE].data_type == "FLOAT"


def test_where_nothing_can_be_painted_is_said():
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="Select a mesh object"):
        paint(SLANTED)
    obj = add_grid()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Object Mode or Sculpt Mode"):
        paint(SLANTED)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.clear_geometry()
    with pytest.raises(RuntimeError, match="no faces"):
        paint(SLANTED)


def test_sculpt_mode_is_painted_in():
    obj = add_grid(cells=20)
    bpy.ops.object.mode_set(mode="SCULPT")
    assert paint(SLANTED, radius=0.3) == {"FINISHED"}
    assert paint(_circle(), kind="LOOP", radius=0.1) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert directions_of(obj).any() and len(_strokes(obj)) == 1


@pytest.mark.parametrize("kind", ["DIRECTION", "LOOP", "RING", "DENSITY"])
def test_what_is_painted_can_be_cleared(kind):
    obj = add_grid(cells=20)
    assert bpy.ops.hybrid_quad.clear_painted(kind=kind) == {"CANCELLED"}
    paint(SLANTED, kind=kind, radius=0.3)
    assert bpy.ops.hybrid_quad.clear_painted(kind=kind) == {"FINISHED"}
    assert not obj.children
    assert not {GUIDE_ATTRIBUTE, DENSITY_ATTRIBUTE} & set(obj.data.attributes.keys())


@pytest.mark.parametrize(("source", "words"), [("VERTEX_GROUP", "no vertex group"), ("COLOR", "no color attribute")])
def test_a_button_without_its_layer_says_what_is_missing(source, words):
    add_grid()
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.hybrid_quad.density_from_layer(source=source)
