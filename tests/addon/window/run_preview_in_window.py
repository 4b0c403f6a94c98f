"""The previews in a real window: what is drawn over the surface, how soon, and that it goes away again.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -P run_preview_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Quaternion

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import expect, in_view, main, show_sidebar_tab, take_picture, view, watch_drawing

import hybrid_quad
from hybrid_quad.blender import panels as main_panels
from hybrid_quad.blender.preview import drawing, panels, sessions
from scenes import activate, add_cube

PATIENCE = 90


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
    with in_view():
        bpy.ops.wm.read_homefile()
    yield 0.5
    expect(not drawing.is_on(), "loading a file ends the preview")
    hybrid_quad.unregister()
    yield 0.3


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


def picture() -> Iterator[float]:
    """The middle of the 3D view as an array."""
    _, area = view()
    area.tag_redraw()
    yield 0.6
    path = yield from take_picture("view.png", bpy.app.tempdir)
    image = bpy.data.images.load(path)
    width, height = image.size
    pixels = np.array(image.pixels[:], np.float32).reshape(height, width, 4)[..., :3]
    bpy.data.images.remove(image)
    inside = pixels[area.y : area.y + area.height, area.x : area.x + area.width]
    height, width = inside.shape[:2]
    return inside[height // 6 : -height // 6, width // 6 : width * 2 // 3]


def changed(first: np.ndarray, second: np.ndarray) -> float:
    """Which part of the pixels is another color."""
    return float((np.abs(first - second).max(axis=-1) > 0.08).mean())


if __name__ == "__main__":
    main(steps())
