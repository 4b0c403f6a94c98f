"""The previews in a real window: what is drawn over the surface, how soon, and that it goes away again.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -P run_preview_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Generator, Iterator
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Quaternion

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import expect, in_view, main, pixels_of, show_sidebar_tab, take_picture, view, watch_drawing

import hybrid_quad
from hybrid_quad.blender import panels as main_panels
from hybrid_quad.blender.preview import drawing, panels, sessions
from scenes import activate, add_cube, add_grid, add_sphere

PATIENCE = 90
BALL = 5  # pixels from the middle of a singularity's ball that are surely within it


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    watch_drawing()
    for cls in main_panels.CLASSES[1:]:
        cls.bl_options = set() if cls.__module__ == panels.__name__ else {"DEFAULT_CLOSED"}
    hybrid_quad.register()
    with in_view():
        head = add_head()
    look_at(distance=5.5)
    yield 0.5
    yield from show_sidebar_tab()

    overlay = view()[1].spaces[0].overlay
    overlay.show_overlays = False
    bare = yield from picture()
    overlay.show_overlays = True
    before = yield from picture()
    asked = bpy.context.window_manager.hybrid_quad_preview
    asked.show_field = True
    began = time.monotonic()
    while sessions.field.session.result is None and time.monotonic() - began < PATIENCE:
        yield 0.05
    print(f"{len(head.data.polygons)} faces: shown after {time.monotonic() - began:.2f} s", flush=True)
    yield from settled()
    expect(not sessions.field.session.error, f"there is no error {sessions.field.session.error}")
    field = yield from picture()
    expect(changed(before, field) > 0.02, "the field is drawn over the surface")
    yield from take_picture("7_field.png")

    head.hybrid_quad.adaptivity = 0.9
    yield 0.3
    yield from settled()
    expect(changed(field, (yield from picture())) > 0.005, "a change of a setting is followed")

    asked.show_quads, asked.show_crosses = True, False
    yield from settled()
    yield from take_picture("8_quad_lines.png")
    expect(len(sessions.field.session.result.quads) > 1000, "the quad lines are there")

    overlay.show_overlays = False
    expect(changed(bare, (yield from picture())) < 0.001, "without overlays nothing is drawn")
    overlay.show_overlays = True
    asked.show_field = asked.show_quads = False
    asked.show_crosses = True
    expect(not drawing.is_on(), "nothing draws any more")
    after = yield from picture()
    expect(changed(before, after) < 0.001, "and the view is as it was")

    head.hybrid_quad.adaptivity, head.hybrid_quad.quads = 0.0, 400
    with in_view():
        bpy.ops.object.hybrid_quad_remesh()
    result = bpy.context.view_layer.objects.active
    before = yield from picture()
    asked.show_limit = True
    yield 0.3
    yield from settled()
    expect(sessions.limit.distance is not None and not sessions.limit.session.error, "the distance is known")
    expect(changed(before, (yield from picture())) > 0.02, "the limit surface is drawn")
    yield from take_picture("9_limit_surface.png")
    with in_view():
        activate(result)
        expect(bpy.ops.object.hybrid_quad_apply_subdivision() == {"FINISHED"}, "the modifier is applied")
    asked.show_limit = False

    with in_view():
        cube = add_cube(quads=600)
        head.hide_set(True)
        result.hide_set(True)
        activate(cube)
    look_at(distance=7)
    asked.show_field = True
    yield from settled()
    expect(sessions.field.session.target() == cube, "the preview follows the active object")
    yield from take_picture("10_features.png")
    with in_view():
        bpy.ops.object.delete()
    yield 0.5
    expect(sessions.field.session.target() is None, "a deleted object has no preview")
    asked.show_field = False
    yield from surfaces_hide()
    yield from renders_show_nothing()
    asked.show_field = True
    yield 0.5
    with in_view():
        bpy.ops.wm.read_homefile()
    yield 0.5
    expect(not drawing.is_on(), "loading a file ends the preview")
    hybrid_quad.unregister()
    yield 0.3


def surfaces_hide() -> Iterator[float]:
    """What lies behind a surface is not seen: the object's own far side, and other objects in front of it."""
    asked = sessions.settings()
    with in_view():
        sphere = add_sphere(quads=400)
        activate(sphere)
    look_at(distance=4.5)
    asked.show_crosses = asked.show_features = False
    asked.show_field = True
    yield from settled()
    shown = yield from picture(whole_view=True)
    asked.show_singularities = False
    hidden = yield from picture(whole_view=True)
    points = sessions.field.session.result.singular_points
    eye = np.array(view()[1].spaces[0].region_3d.view_matrix.inverted().translation)
    facing = (points * (eye - points)).sum(axis=1) / np.linalg.norm(eye - points, axis=1)  # of a unit sphere
    places = np.array([place_in_view(point) for point in points])
    seen = [changed(around(shown, place), around(hidden, place)) for place in places]
    print(f"facing: {facing.round(2)}, drawn: {np.round(seen, 2)}", flush=True)
    front, back = facing > 0.3, facing < -0.3
    away = np.array([np.linalg.norm(places[front] - place, axis=1).min() > 6 * BALL for place in places])
    expect(front.any() and (np.array(seen)[front] == 1).all(), "singularities of the side in front are drawn")
    expect((back & away).any() and not np.array(seen)[back & away].any(), "those behind it are not")

    asked.show_field, asked.show_crosses, asked.show_features, asked.show_singularities = False, True, True, True
    with in_view():
        sphere.hide_set(True)
        screen = add_grid(cells=1)
        screen.name = "Screen"
        screen.location = (-1, 0, 0.5)
        grid = add_grid(cells=30)
        activate(grid)
    region = view()[1].spaces[0].region_3d
    region.view_rotation, region.view_perspective = Quaternion((1, 0, 0, 0)), "ORTHO"
    for perspective in ("ORTHO", "PERSP"):
        region.view_perspective = perspective
        yield 0.3
        before = yield from picture(whole_view=True)
        asked.show_field = True
        yield from settled()
        after = yield from picture(whole_view=True)
        left, right = (between(place_in_view((x, -0.5, 0)), place_in_view((x + 0.5, 0.5, 0))) for x in (-0.8, 0.3))
        expect(changed(before[right], after[right]) > 0.02, f"{perspective}: crosses are drawn beside another object")
        expect(changed(before[left], after[left]) == 0, f"{perspective}: and not behind it")
        asked.show_field = False
    with in_view():
        for obj in (grid, screen, sphere):
            bpy.data.objects.remove(obj)
    region.view_perspective = "PERSP"


def renders_show_nothing() -> Iterator[float]:
    """Renders are the same to the last bit with the preview and without, final ones and those of the viewport's kind."""
    asked = sessions.settings()
    with in_view():
        obj = activate(add_sphere(quads=400))
        bpy.ops.object.camera_add(location=(0, 0, 5), rotation=(0, 0, 0))
        scene = bpy.context.scene
        scene.camera = bpy.context.object
        activate(obj)
    scene.render.resolution_x = scene.render.resolution_y = 200
    scene.render.resolution_percentage = 100
    scene.render.engine = "BLENDER_WORKBENCH"
    without = rendered("without.png")
    expect(np.array_equal(without[0], rendered("again.png")[0]), "a scene's render is the same each time")
    asked.show_field = True
    yield from settled()
    expect(len(sessions.field.session.result.crosses) > 500, "the preview is there")
    with_preview = rendered("with.png")
    expect(np.array_equal(without[0], with_preview[0]), "final renders do not show it")
    expect(np.array_equal(without[1], with_preview[1]), "nor do those by OpenGL from the camera")
    expect(np.array_equal(without[2], with_preview[2]), "or from the view")
    obj.location.x = 0.2
    expect(changed(without[0], rendered("moved.png")[0]) > 0.02, "which show the scene as it is")
    obj.location.x = 0.0
    asked.show_field = False
    with in_view():
        bpy.data.objects.remove(obj)
        bpy.data.objects.remove(scene.camera)


def rendered(name: str) -> list[np.ndarray]:
    """The final render of the scene, and those by OpenGL from the camera and from the view, as arrays."""
    path = bpy.context.scene.render.filepath = str(Path(bpy.app.tempdir, name))
    made = []
    with in_view():
        bpy.ops.render.render(write_still=True)
        made.append(pixels_of(path))
        for from_view in (False, True):
            bpy.ops.render.opengl(write_still=True, view_context=from_view)
            made.append(pixels_of(path))
    return made


def place_in_view(point) -> np.ndarray:
    """Of a point in the scene, in pixels of the 3D view's area."""
    _, area = view()
    region = next(region for region in area.regions if region.type == "WINDOW")
    at = location_3d_to_region_2d(region, area.spaces[0].region_3d, point)
    return np.array([at.x + region.x - area.x, at.y + region.y - area.y])


def around(pixels: np.ndarray, place: np.ndarray) -> np.ndarray:
    """(n, 3): the pixels within a ball's middle."""
    x, y = place.round().astype(int)
    steps = np.arange(-BALL, BALL + 1)
    return pixels[y - BALL : y + BALL + 1, x - BALL : x + BALL + 1][np.hypot(*np.meshgrid(steps, steps)) <= BALL]


def between(low: np.ndarray, high: np.ndarray) -> tuple[slice, slice]:
    (left, bottom), (right, top) = low.round().astype(int), high.round().astype(int)
    return slice(bottom, top), slice(left, right)


def add_head() -> bpy.types.Object:
    """The monkey, smooth, of 31 thousand quads."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    modifier = obj.modifiers.new("Smooth", "SUBSURF")
    modifier.levels = 3
    bpy.ops.object.modifier_apply(modifier="Smooth")
    bpy.ops.object.shade_smooth()
    obj.hybrid_quad.quads = 3000
    bpy.ops.ed.undo_push(message="head")
    return obj


def look_at(distance: float) -> None:
    region = view()[1].spaces[0].region_3d
    region.view_rotation = Quaternion((0.78, 0.52, 0.17, 0.29)).normalized()
    region.view_location, region.view_distance = (0, 0, 0), distance


def settled() -> Iterator[float]:
    """Until nothing goes on any more, and it is drawn."""
    yield 0.3
    sessions.step()
    began = time.monotonic()
    while sessions.field.session.is_busy or sessions.limit.session.is_busy:
        if time.monotonic() - began > PATIENCE:
            raise AssertionError("the preview does not end")
        yield 0.05
    yield 0.8


def picture(*, whole_view: bool = False) -> Generator[float, None, np.ndarray]:
    """The 3D view, or its middle, as an array."""
    _, area = view()
    area.tag_redraw()
    yield 0.6
    path = yield from take_picture("view.png", bpy.app.tempdir)
    inside = pixels_of(path)[area.y : area.y + area.height, area.x : area.x + area.width]
    height, width = inside.shape[:2]
    return inside if whole_view else inside[height // 6 : -height // 6, width // 6 : width * 2 // 3]


def changed(first: np.ndarray, second: np.ndarray) -> float:
    """Which part of the pixels is another color."""
    return float((np.abs(first - second).max(axis=-1) > 0.08).mean())


if __name__ == "__main__":
    main(steps())
