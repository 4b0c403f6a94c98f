"""Painting guides in a real window, with a simulated mouse: strokes of all kinds, undo, remeshing, saving and loading.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -p 0 0 1600 1000 -P run_paint_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import expect, in_view, main, pixels_of, show_sidebar_tab, take_picture, view

import hybrid_quad
from hybrid_quad.blender.guide_attributes import DENSITY_ATTRIBUTE, GUIDE_ATTRIBUTE
from hybrid_quad.blender.painting.stroke_view import TOOL
from hybrid_quad.core.mesh_io import read_mesh
from scenes import add_object, points_of

MODEL = Path(__file__).resolve().parents[2] / "data" / "meshes" / "c3d_spot_triangulated.obj"
# On Spot's flank, as seen along x: (y, z), around her middle.
STROKE = np.stack([np.linspace(-0.3, 0.55, 31), -0.15 + 0.12 * np.sin(np.linspace(-1.3, 1.5, 31))], axis=1)
ALONG = np.stack([np.linspace(-0.3, 0.55, 20), np.full(20, -0.12)], axis=1)
ACROSS = np.stack([np.full(20, 0.25), np.linspace(-0.4, 0.1, 20)], axis=1)
LOOP = (1.0, 0.65, 0.05)  # color of loops
NEAR = 0.06  # edges as near as this to the stroke are to follow it


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    hybrid_quad.register()
    add_model()
    yield from look_at_flank()
    yield from show_sidebar_tab()
    with in_view():
        bpy.ops.ed.undo_push(message="model")
        bpy.ops.wm.tool_set_by_id(name=TOOL)
    yield 0.5

    print("-- a direction", flush=True)
    brush().size = 70
    yield from drag(STROKE, picture="paint_stroke.png")
    expect(GUIDE_ATTRIBUTE in model().data.attributes, "a stroke makes the attribute")
    off, count = guides_off_the_stroke()
    expect(
        count > 50 and off < 3, f"directions near the stroke run along it: {off:.1f} degrees off at {count} vertices"
    )
    yield from move_to(STROKE[-1])
    yield from take_picture("paint_direction.png")

    print("-- erasing, smoothing and undo", flush=True)
    painted = guides()
    yield from drag(STROKE[20:], ctrl=True)
    expect(np.linalg.norm(guides(), axis=1).sum() < 0.8 * np.linalg.norm(painted, axis=1).sum(), "Ctrl erases")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.5
    expect(np.array_equal(guides(), painted), "one undo takes one stroke back")
    expect(brush().size == 70, "and leaves the brush as it is")
    yield from drag(STROKE, shift=True)
    expect(not np.array_equal(guides(), painted), "Shift smooths")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.5
    expect(np.array_equal(guides(), painted), "and one undo takes that back")
    window, _ = view()
    yield from drag(STROKE, cancel=True)
    expect(np.array_equal(guides(), painted), "Esc during a stroke leaves all as it was")

    print("-- the radius by F", flush=True)
    yield from move_to(STROKE[10])
    x, y = pixel(STROKE[10])
    window.event_simulate(type="F", value="PRESS", x=x, y=y)
    window.event_simulate(type="F", value="RELEASE", x=x, y=y)
    yield 0.5
    for shift in range(0, 41, 10):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x + shift, y=y)
        yield 0.1
    yield from click(x + 40, y)
    expect(100 <= brush().size <= 120, f"F sets the radius: {brush().size}")
    brush().size = 70

    print("-- remeshing", flush=True)
    model().hybrid_quad.quads = 2500
    model().hybrid_quad.use_sharp_angle = False
    yield from remesh_and_compare("paint_result.png")

    print("-- saving and loading", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "painted.blend")
        with in_view():
            bpy.ops.wm.save_as_mainfile(filepath=path)
            bpy.ops.wm.open_mainfile(filepath=path)
        yield 1.0
    expect(np.array_equal(guides(), painted), "directions are as they were saved")
    expect(brush().size == 70, "so is the brush")
    with in_view():
        bpy.ops.wm.tool_set_by_id(name=TOOL)
        bpy.ops.hybrid_quad.clear_painted(kind="DIRECTION")
        bpy.ops.ed.undo_push(message="cleared")
    yield 0.5

    print("-- a loop and a ring", flush=True)
    brush().kind = "LOOP"
    yield from drag(ALONG, picture="paint_loop_stroke.png", color=LOOP)
    expect(len(model().children) == 1, "a line is a child of the mesh")
    brush().kind = "RING"
    yield from drag(ACROSS)
    expect(sorted(child["hybrid_quad_guide_kind"] for child in model().children) == ["loop", "ring"], "so is a ring")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.5
    expect([child["hybrid_quad_guide_kind"] for child in model().children] == ["loop"], "one undo takes the ring back")
    yield from drag(ACROSS)
    yield from take_picture("paint_lines.png")
    result = yield from remesh("paint_lines_result.png")
    guides_met = [guide["met"] for guide in json.loads(result.hybrid_quad.last_report)["guides"]]
    expect(guides_met == [True, True], "both lines are met")
    yield from back_to_model(result)

    print("-- density", flush=True)
    brush().kind = "DENSITY"
    brush().size, brush().density_factor = 90, 3.0
    yield from drag(STROKE[20:])
    expect(density().max() > 2.5 and density().min() == 1, "the density is painted")
    brush().density_action = "COARSER"
    yield from drag(STROKE[:12])
    expect(density().min() < 0.5, "coarser too")
    yield from take_picture("paint_density.png")

    print("-- Sculpt Mode", flush=True)
    with in_view():
        bpy.ops.object.mode_set(mode="SCULPT")
        bpy.ops.wm.tool_set_by_id(name=TOOL)
    yield 0.5
    brush().kind, brush().size = "DIRECTION", 70
    before = points_of(model())
    yield from drag(STROKE)
    expect(guides_off_the_stroke()[0] < 3, "strokes are painted in Sculpt Mode")
    expect(np.array_equal(points_of(model()), before), "and nothing is sculpted")
    once = guides()
    yield from drag(STROKE[20:], ctrl=True)
    yield from take_picture("paint_sculpt.png")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.7
    expect(bpy.context.mode == "SCULPT" and np.array_equal(guides(), once), "undo works there too")
    brush().kind = "LOOP"
    lines = spline_count()
    yield from drag(STROKE - [0, 0.1])
    expect(spline_count() == lines + 1, "a loop is drawn in Sculpt Mode")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.7
    expect(bpy.context.mode == "SCULPT" and spline_count() == lines, "and undone")
    with in_view():
        bpy.ops.object.mode_set(mode="OBJECT")
    hybrid_quad.unregister()
    yield 0.3


def add_model() -> None:
    vertices, polygons = read_mesh(MODEL)
    vertices = vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    # Upright, looking along y: Blender's up is z.
    turned = np.stack([vertices[:, 0], vertices[:, 2], vertices[:, 1]], axis=1)
    obj = add_object("Spot", turned.tolist(), [face[::-1].tolist() for face in faces])
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    obj.data.update()


def brush() -> bpy.types.PropertyGroup:
    return bpy.context.workspace.hybrid_quad_brush


def model() -> bpy.types.Object:
    return bpy.data.objects["Spot"]


def look_at_flank() -> Iterator[float]:
    with in_view():
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
    yield 1.5  # the view turns smoothly


def on_flank(places: np.ndarray) -> np.ndarray:
    """Places (y, z) of the side view on the model's surface, in world space."""
    points = []
    for y, z in places:
        hit, location, _normal, _face = model().ray_cast((5, y, z), (-1, 0, 0))
        expect_hit = hit
        if not expect_hit:
            raise AssertionError(f"nothing at {y}, {z}")
        points.append(tuple(location))
    return np.array(points)


def pixel(place: np.ndarray) -> tuple[int, int]:
    """Where a place (y, z) of the side view is in the window."""
    _, area = view()
    region = next(region for region in area.regions if region.type == "WINDOW")
    at = location_3d_to_region_2d(region, area.spaces[0].region_3d, Vector((0, *map(float, place))))
    return round(region.x + at.x), round(region.y + at.y)


def move_to(place: np.ndarray) -> Iterator[float]:
    window, _ = view()
    x, y = pixel(place)
    for shift in (3, 0):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x - shift, y=y)
        yield 0.3


def click(x: int, y: int) -> Iterator[float]:
    window, _ = view()
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)
        yield 0.3


def drag(
    places: np.ndarray,
    picture: str = "",
    color: tuple[float, float, float] | None = None,
    cancel: bool = False,
    **keys: bool,
) -> Iterator[float]:
    """Moves the mouse with its button down; half way takes a picture, in which the line is to be seen in its color."""
    window, _ = view()
    yield from move_to(places[0])
    way = [pixel(place) for place in places[::3]]
    window.event_simulate(type="LEFTMOUSE", value="PRESS", x=way[0][0], y=way[0][1], **keys)
    yield 0.3
    for index, (x, y) in enumerate(way[1:]):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y, **keys)
        yield 0.03
        if picture and index == len(way) // 2:
            yield 0.5
            path = yield from take_picture(picture, bpy.app.tempdir)
            if color is not None:
                drawn = [is_seen(color, pixels_of(path), place) for place in way[: index + 1]]
                expect(len(drawn) > 3 and all(drawn), f"a line is seen as it is drawn: {drawn}")
    if cancel:
        window.event_simulate(type="ESC", value="PRESS", x=x, y=y)
        window.event_simulate(type="ESC", value="RELEASE", x=x, y=y)
        yield 0.3
    window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y, **keys)
    yield 0.5


def is_seen(color: tuple[float, float, float], pixels: np.ndarray, place: tuple[int, int]) -> bool:
    """Whether a picture has a color within three pixels of a place."""
    x, y = place
    around = pixels[y - 3 : y + 4, x - 3 : x + 4]
    return bool((np.abs(around - color).max(axis=-1) < 0.1).any())


def guides() -> np.ndarray:
    data = model().data.attributes[GUIDE_ATTRIBUTE].data
    values = np.empty(3 * len(data), np.float32)
    data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def density() -> np.ndarray:
    data = model().data.attributes[DENSITY_ATTRIBUTE].data
    values = np.empty(len(data), np.float32)
    data.foreach_get("value", values)
    return values


def spline_count() -> int:
    return sum(len(child.data.splines) for child in model().children)


def degrees_off_the_stroke(places: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Of vectors as crosses near the stroke, from its direction where it is nearest."""
    line = on_flank(STROKE)
    near = np.linalg.norm(places[:, None] - line[None], axis=2)
    chosen = near.min(axis=1) < NEAR
    at = near[chosen].argmin(axis=1)
    along = np.gradient(line, axis=0)[at]
    vectors = vectors[chosen]
    cosine = np.einsum("ij,ij->i", vectors, along) / np.linalg.norm(vectors, axis=1) / np.linalg.norm(along, axis=1)
    off = np.degrees(np.arccos(np.clip(np.abs(cosine), 0, 1)))
    return np.minimum(off, 90 - off)


def guides_off_the_stroke() -> tuple[float, int]:
    values, points = guides(), points_of(model())
    painted = np.linalg.norm(values, axis=1) > 0.3
    off = degrees_off_the_stroke(points[painted], values[painted])
    return float(np.median(off)), len(off)


def remesh(picture: str) -> Iterator[float]:
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("EXEC_DEFAULT")
    result = bpy.context.view_layer.objects.active
    expect(result.name != "Spot", "there is a result")
    with in_view():
        bpy.context.space_data.overlay.show_wireframes = True
    yield 0.7
    yield from take_picture(picture)
    return result


def remesh_and_compare(picture: str) -> Iterator[float]:
    result = yield from remesh(picture)
    points = points_of(result)
    pairs = np.array([tuple(edge.vertices) for edge in result.data.edges])
    off = degrees_off_the_stroke(points[pairs].mean(axis=1), points[pairs[:, 1]] - points[pairs[:, 0]])
    median = float(np.median(off))
    expect(len(off) > 20 and median <= 5, f"edges near the stroke follow it: {median:.1f} degrees at {len(off)} edges")
    yield from back_to_model(result)


def back_to_model(result: bpy.types.Object) -> Iterator[float]:
    bpy.data.objects.remove(result)
    model().hide_set(False)
    model().hide_render = False
    bpy.context.view_layer.objects.active = model()
    model().select_set(True)
    with in_view():
        bpy.context.space_data.overlay.show_wireframes = False
        bpy.ops.ed.undo_push(message="back")
    yield 0.5


if __name__ == "__main__":
    main(steps())
