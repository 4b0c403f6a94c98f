"""Remeshing from Sculpt Mode in a real window: after strokes of a brush, a masked part, a picked face set, the whole mesh.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -p 0 0 1600 1000 -P run_sculpt_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import expect, in_view, main, press, show_sidebar_tab, take_picture, until_finished, view

import hybrid_quad
from hybrid_quad.blender import background_run, panels, task_solving
from hybrid_quad.blender.part_source import knows_face_sets
from scenes import activate, points_of

FACES = 1536  # of the ball
BOX = 90  # pixels from the view's middle to the sides of what is masked


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    for cls in panels.CLASSES:
        is_open = cls in (panels.VIEW3D_PT_hybrid_quad, panels.VIEW3D_PT_hybrid_quad_part)
        cls.bl_options = set() if is_open else {"DEFAULT_CLOSED"}
    hybrid_quad.register()
    press("ESC")  # the splash screen
    view()[1].spaces[0].overlay.show_wireframes = True
    for test in (masked_part, picked_face_set, whole_mesh, sculpted_meanwhile):
        print(f"-- {test.__name__.replace('_', ' ')}", flush=True)
        yield from new_scene()
        if test == masked_part:
            yield from show_sidebar_tab()
        yield from test()
        expect(background_run.current() is None, "no run is left")
    hybrid_quad.unregister()
    yield 0.3


def masked_part() -> Iterator[float]:
    yield from stroke()
    sculpted = points_of(ball())
    yield from mask()
    settings = ball().hybrid_quad
    settings.part.region, settings.result_mode = "MASK", "REPLACE"
    settings.part.use_border_length, settings.quads = False, 4 * 32
    yield from remesh_from_sculpt_mode()
    done = len(ball().data.polygons)
    expect(done != FACES, f"the faces are others: {done}")
    expect(are_among(sculpted[:50], points_of(ball())), "the rest is where it was sculpted")
    yield from take_picture("sculpt_part.png")
    yield from undo()
    expect(len(ball().data.polygons) == FACES, "one undo brings the faces back")
    expect(np.array_equal(points_of(ball()), sculpted), "with what was sculpted")
    with in_view():
        bpy.ops.ed.redo()
    yield 0.7
    expect(len(ball().data.polygons) == done and bpy.context.mode == "SCULPT", "redo brings the new ones")
    remeshed = points_of(ball())
    yield from stroke()
    expect(len(ball().data.polygons) == done, "sculpting goes on")
    yield from undo()
    expect(np.array_equal(points_of(ball()), remeshed), "an undo takes that stroke back")
    yield from undo()
    expect(len(ball().data.polygons) == FACES, "and another one the quads")


def picked_face_set() -> Iterator[float]:
    yield from mask()
    with in_view():
        bpy.ops.sculpt.face_sets_create("EXEC_DEFAULT", True, mode="MASKED")
        if not knows_face_sets():
            expect(not bpy.ops.object.hybrid_quad_pick_face_set.poll(), "this Blender does not tell of face sets")
            return
        bpy.ops.object.hybrid_quad_pick_face_set("INVOKE_DEFAULT")
    yield 0.3
    yield from click(*middle())
    part = ball().hybrid_quad.part
    expect(part.region == "FACE_SET" and part.face_set > 1, f"the face set under the mouse is chosen: {part.face_set}")
    ball().hybrid_quad.result_mode, part.use_border_length = "REPLACE", False
    yield from remesh_from_sculpt_mode()
    expect(len(ball().data.polygons) != FACES, "its faces are others")
    yield from take_picture("sculpt_face_set.png")
    with in_view():
        bpy.ops.object.hybrid_quad_pick_face_set("INVOKE_DEFAULT")
    yield 0.3
    press("ESC")
    yield 0.3
    expect(part.region == "FACE_SET", "Esc leaves it as it is")


def whole_mesh() -> Iterator[float]:
    yield from stroke()
    yield from remesh_from_sculpt_mode()
    result = bpy.context.object
    expect(result.name == "Ball Quads" and ball().hide_get(), "a new object is in its place")
    yield from undo()
    expect("Ball Quads" not in bpy.data.objects and not ball().hide_get(), "one undo takes it away")


def sculpted_meanwhile() -> Iterator[float]:
    ball().hybrid_quad.result_mode = "REPLACE"
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT")
    worker = background_run.current().worker.process_id
    os.kill(worker, signal.SIGSTOP)
    yield from stroke()
    sculpted = points_of(ball())
    os.kill(worker, signal.SIGCONT)
    yield from until_finished()
    expect(np.array_equal(points_of(ball()), sculpted), "what was sculpted meanwhile is not replaced")
    expect("Ball Quads" in bpy.data.objects and not ball().hide_get(), "the result is beside it")
    expect(bpy.context.object == ball() and bpy.context.mode == "SCULPT", "and sculpting goes on")


def new_scene() -> Iterator[float]:
    """A ball of squares in Sculpt Mode."""
    task_solving.forget_results()
    with in_view():
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
        bpy.ops.mesh.primitive_cube_add(size=2)
        obj = bpy.context.object
        obj.name = "Ball"
        obj.modifiers.new("Smooth", "SUBSURF").levels = 4
        bpy.ops.object.modifier_apply(modifier="Smooth")
        obj.hybrid_quad.quads = 600
        activate(obj)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    yield 1.0
    with in_view():
        bpy.ops.ed.undo_push(message="scene")
        bpy.ops.object.mode_set(mode="SCULPT")
        have_brush()
        bpy.ops.ed.undo_push(message="Sculpt Mode")
    yield 0.5
    expect(len(obj.data.polygons) == FACES, "the ball is there")


def have_brush() -> None:
    """One of the file's own where there is none: Debian's Blender 4.3 comes without the files that they are in."""
    if bpy.context.tool_settings.sculpt.brush is not None:
        return
    bpy.data.brushes.new("Draw", mode="SCULPT").asset_mark()
    bpy.ops.brush.asset_activate(asset_library_type="LOCAL", relative_asset_identifier="Brush/Draw")


def ball() -> bpy.types.Object:
    return bpy.data.objects["Ball"]


def remesh_from_sculpt_mode() -> Iterator[float]:
    with in_view():
        expect(bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "a run begins in Sculpt Mode")
    expect(bpy.context.mode == "SCULPT", "which is not left for it")
    yield from until_finished()
    expect(bpy.context.mode == "SCULPT", "nor afterwards")
    yield 0.5


def stroke() -> Iterator[float]:
    """Drags the brush across the ball's upper half."""
    before = points_of(ball())
    window, _ = view()
    x, y = middle()
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x - 120, y=y + 150)
    yield 0.3
    window.event_simulate(type="LEFTMOUSE", value="PRESS", x=x - 120, y=y + 150)
    for shift in range(-120, 121, 20):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x + shift, y=y + 150)
        yield 0.1
    window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=x + 120, y=y + 150)
    yield 0.5
    expect(not np.array_equal(points_of(ball()), before), "the brush sculpts")


def mask() -> Iterator[float]:
    """Masks a square around the view's middle, on both sides, with an undo step."""
    x, y = middle(of_region=True)
    with in_view():
        bpy.ops.paint.mask_box_gesture(
            "EXEC_DEFAULT", True, xmin=x - BOX, xmax=x + BOX, ymin=y - BOX, ymax=y + BOX, mode="VALUE", value=1.0
        )
    yield 0.3


def click(x: int, y: int) -> Iterator[float]:
    window, _ = view()
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        window.event_simulate(type=kind, value=value, x=x, y=y)
        yield 0.3


def middle(*, of_region: bool = False) -> tuple[int, int]:
    """Of the view, in pixels of the window."""
    region = next(region for region in view()[1].regions if region.type == "WINDOW")
    x, y = region.width // 2, region.height // 2
    return (x, y) if of_region else (region.x + x, region.y + y)


def undo() -> Iterator[float]:
    with in_view():
        bpy.ops.ed.undo()
    yield 0.7


def are_among(points: np.ndarray, others: np.ndarray) -> bool:
    return all((others == point).all(axis=1).any() for point in points)


if __name__ == "__main__":
    main(steps())
