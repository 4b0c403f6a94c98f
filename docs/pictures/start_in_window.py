"""Takes the pictures of docs/start-in-blender.md in Blender's window, on a screen that need not be there.

    LIBGL_ALWAYS_SOFTWARE=1 xvfb-run -a -s "-screen 0 1600x1000x24" blender --factory-startup --enable-event-simulate \\
        -p 0 0 1240 860 -P docs/pictures/start_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import bpy
from mathutils import Quaternion

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / "lib"), str(ROOT / "tests" / "addon" / "window")]

from run_in_window import expect, in_view, main, show_sidebar_tab, until_finished, view, watch_drawing  # noqa: E402
from stage import save_side_by_side  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.blender import background_run, panels  # noqa: E402

OUT = Path(sys.argv[-1]) if "--" in sys.argv[:-1] else ROOT / "docs" / "images" / "start"


def steps() -> Iterator[float]:
    """Panel, run, result; every number is a pause in seconds, in which Blender handles events."""
    OUT.mkdir(parents=True, exist_ok=True)
    bpy.context.preferences.view.show_splash = False
    watch_drawing()
    for cls in panels.CLASSES[1:]:
        cls.bl_options = {"DEFAULT_CLOSED"}
    panels.VIEW3D_PT_hybrid_quad_report.bl_options = set()
    hybrid_quad.register()
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_samples" / "sculpted_head.blend"), load_ui=False)
    yield 1.0
    head = next(obj for obj in bpy.context.view_layer.objects if obj.type == "MESH")
    space = view()[1].spaces[0]
    space.overlay.show_wireframes, space.overlay.wireframe_threshold = True, 1.0
    with in_view():
        bpy.context.view_layer.objects.active = head
        head.select_set(True)
        space.region_3d.view_rotation = Quaternion((0.78, 0.52, 0.17, 0.29)).normalized()
        bpy.ops.view3d.view_selected()
    yield from show_sidebar_tab()
    yield from take_picture("panel.png")
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT")
    while background_run.current().fraction < 0.3:
        yield 0.05
    yield from take_picture("running.png")
    yield from until_finished()
    expect(bpy.context.view_layer.objects.active != head, "the result is there")
    yield 1.0
    yield from take_picture("result.png")
    hybrid_quad.unregister()
    yield 0.3


def take_picture(name: str) -> Iterator[float]:
    window, area = view()
    area.tag_redraw()
    yield 0.3
    path = Path(tempfile.mkdtemp()) / name
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screenshot_area(filepath=str(path))
    save_side_by_side([path], OUT / name)


main(steps())
