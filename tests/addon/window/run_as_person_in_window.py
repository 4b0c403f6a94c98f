"""One session as a person has it, with mouse and keys alone: sidebar, tool, stroke, preview, remesh, undo, cancel, save, reload.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -p 0 0 1600 1000 -P run_as_person_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives a picture of each step.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import expect, in_view, main, show_sidebar_tab, take_picture, until_finished, view, watched
from run_paint_in_window import STROKE, add_model, brush, click, drag, guides, look_at_flank, model

import hybrid_quad
from hybrid_quad.blender import background_run
from hybrid_quad.blender.main_panel import VIEW3D_PT_hybrid_quad
from hybrid_quad.blender.painting.stroke_view import TOOL
from hybrid_quad.blender.preview import sessions

# Pixels from the top of the sidebar down to the middles of what is clicked on.
QUADS_FIELD = 69
REMESH_BUTTON = 125
PREVIEW_SWITCH = 532
# And from the top of the toolbar.
FIRST_TOOL = 25
TOOL_STEP, TOOL_GAP = 36, 5  # from tool to tool, and more where a separator is
PREVIEW_LEFT = 51  # from the sidebar's left
PATIENCE = 90
LONG_RUN_QUADS = 150_000


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    folder = tempfile.TemporaryDirectory()
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    VIEW3D_PT_hybrid_quad.draw = watched(VIEW3D_PT_hybrid_quad.draw, VIEW3D_PT_hybrid_quad.__name__)
    hybrid_quad.register()
    add_model()
    model().hybrid_quad.quads = 2500
    path = str(Path(folder.name) / "spot.blend")
    with in_view():
        bpy.ops.wm.save_as_mainfile(filepath=path)
    yield from look_at_flank()

    yield from key("N")
    expect(view()[1].spaces[0].show_region_ui, "N opens the sidebar")
    yield from show_sidebar_tab()
    yield from take_picture("person_1_panel.png")

    yield from choose_tool()
    brush().size = 70
    yield from drag(STROKE)
    painted = guides()
    expect((np.linalg.norm(painted, axis=1) > 0.3).sum() > 50, "a stroke paints directions")
    yield from take_picture("person_2_painted.png")

    yield from click(*place(PREVIEW_LEFT, PREVIEW_SWITCH))
    expect(sessions.settings().show_field, "a click switches the preview on")
    yield from settled()
    expect(not sessions.field.session.error and sessions.field.session.result is not None, "there is something to see")
    yield from take_picture("person_3_preview.png")
    yield from click(*place(PREVIEW_LEFT, PREVIEW_SWITCH))
    expect(not sessions.settings().show_field, "and another one off")

    yield from click(*place(None, REMESH_BUTTON))
    expect(background_run.current() is not None, "the button begins a run")
    yield from until_finished()
    result = bpy.context.view_layer.objects.active
    expect(result.name == "Spot Quads" and {len(face.vertices) for face in result.data.polygons} == {4}, "quads")
    with in_view():
        bpy.context.space_data.overlay.show_wireframes = True
    yield 0.5
    yield from take_picture("person_4_result.png")
    with in_view():
        bpy.context.space_data.overlay.show_wireframes = False

    yield from key("Z", ctrl=True)
    yield 0.5
    expect("Spot Quads" not in bpy.data.objects and not model().hide_get(), "Ctrl Z takes it back")
    expect(np.array_equal(guides(), painted), "and leaves what was painted")
    yield from take_picture("person_5_undone.png")

    yield from click(*place(None, QUADS_FIELD))
    yield from key("A", ctrl=True)
    for digit in str(LONG_RUN_QUADS):
        yield from key(DIGITS[int(digit)], unicode=digit)
    yield from key("RET")
    expect(model().hybrid_quad.quads == LONG_RUN_QUADS, f"a number is typed: {model().hybrid_quad.quads}")
    yield from click(*place(None, REMESH_BUTTON))
    run = background_run.current()
    expect(run is not None, "a long run begins")
    began = time.monotonic()
    while run.fraction < 0.05 and time.monotonic() - began < PATIENCE:
        yield 0.05
    yield from take_picture("person_6_running.png")
    yield from key("ESC")
    yield from until_finished()
    expect("Spot Quads" not in bpy.data.objects and not run.has_result, "Esc ends it, and nothing has come of it")
    yield 0.5
    yield from take_picture("person_7_cancelled.png")

    before = Path(path).stat().st_mtime_ns
    yield from key("S", ctrl=True)
    yield 1.0
    expect(Path(path).stat().st_mtime_ns > before and not bpy.data.is_dirty, "Ctrl S saves")
    with in_view():  # there is no key for File > Revert
        bpy.ops.wm.revert_mainfile()
    yield 1.5
    expect(np.array_equal(guides(), painted), "what was painted is there after loading")
    expect(model().hybrid_quad.quads == LONG_RUN_QUADS, "so are the settings")
    yield from choose_tool()
    yield from take_picture("person_8_reloaded.png")
    hybrid_quad.unregister()
    yield 0.3


DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")


def key(name: str, ctrl: bool = False, unicode: str = "") -> Iterator[float]:
    """Presses a key with the mouse where it was last, or over the view."""
    window, area = view()
    x, y = area.x + area.width // 2, area.y + area.height // 2
    words = {"unicode": unicode} if unicode else {}
    window.event_simulate(type=name, value="PRESS", x=x, y=y, ctrl=ctrl, **words)
    yield 0.2
    window.event_simulate(type=name, value="RELEASE", x=x, y=y, ctrl=ctrl)
    yield 0.3


def place(left: int | None, down: int) -> tuple[int, int]:
    """A place of the sidebar in the window; its middle where `left` is None. The mouse is moved there."""
    window, area = view()
    region = next(region for region in area.regions if region.type == "UI")
    x = region.x + (region.width // 2 if left is None else left)
    y = region.y + region.height - down
    for shift in (3, 0):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x - shift, y=y)
    return x, y


def choose_tool() -> Iterator[float]:
    """Clicks on the comb, the last in the toolbar. (Blender 3.4 dies of simulated clicks on its own tools.)"""
    window, area = view()
    region = next(region for region in area.regions if region.type == "TOOLS")
    with in_view():
        tools = list(VIEW3D_PT_tools_active.tools_from_context(bpy.context, "OBJECT"))
    gaps = tools.count(None)  # other Blenders have other tools
    down = FIRST_TOOL + TOOL_STEP * (len(tools) - gaps - 1) + TOOL_GAP * gaps
    x, y = region.x + 25, region.y + region.height - down
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield 0.3
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)
    yield 0.5
    tool = bpy.context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    expect(tool is not None and tool.idname == TOOL, "a click in the toolbar chooses the comb")


def settled() -> Iterator[float]:
    began = time.monotonic()
    while sessions.field.session.is_busy or sessions.field.session.result is None:
        if time.monotonic() - began > PATIENCE:
            raise AssertionError("the preview does not end")
        yield 0.05
    yield 0.8


if __name__ == "__main__":
    main(steps())
