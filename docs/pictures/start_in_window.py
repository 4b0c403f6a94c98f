"""Takes the pictures of docs/start-in-blender.md in Blender's window, on a screen that need not be there.

    BLENDER_USER_SCRIPTS=$(mktemp -d) LIBGL_ALWAYS_SOFTWARE=1 xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -p 0 0 1240 1000 -P docs/pictures/start_in_window.py -- [FOLDER]

The add-on is linked into that folder of scripts, as an installed one would lie there. Ends Blender with status 0 or 1.
"""

from __future__ import annotations

import os
import signal
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Quaternion

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / "lib"), str(ROOT / "tests" / "addon" / "window")]

from run_in_window import expect, in_view, main, show_sidebar_tab, until_finished, view, watched  # noqa: E402
from stage import save_side_by_side  # noqa: E402

from hybrid_quad.blender import background_run  # noqa: E402
from hybrid_quad.blender.main_panel import VIEW3D_PT_hybrid_quad  # noqa: E402

OUT = Path(sys.argv[-1]) if "--" in sys.argv[:-1] else ROOT / "docs" / "images" / "start"


def steps() -> Iterator[float]:
    """Panel, run, result; every number is a pause in seconds, in which Blender handles events."""
    OUT.mkdir(parents=True, exist_ok=True)
    VIEW3D_PT_hybrid_quad.draw = watched(VIEW3D_PT_hybrid_quad.draw, VIEW3D_PT_hybrid_quad.__name__)
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_samples" / "sculpted_head.blend"), load_ui=False)
    yield 1.0
    yield from show_installed()
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
    yield from take_panel_picture("target.png")
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT")
    run = background_run.current()
    while run.fraction < 0.3:
        yield 0.02
    os.kill(run.worker.process_id, signal.SIGSTOP)  # a picture takes longer than many a stage
    yield from take_picture("running.png")
    os.kill(run.worker.process_id, signal.SIGCONT)
    yield from until_finished()
    expect(bpy.context.view_layer.objects.active != head, "the result is there")
    yield 1.0
    yield from take_picture("result.png")
    bpy.ops.preferences.addon_disable(module="hybrid_quad")
    yield 0.3


def show_installed() -> Iterator[float]:
    """The add-on in the preferences, switched on; then back to the view."""
    folder = Path(os.environ["BLENDER_USER_SCRIPTS"], "addons")
    folder.mkdir()
    (folder / "hybrid_quad").symlink_to(ROOT / "addon" / "hybrid_quad")
    bpy.ops.preferences.addon_refresh()
    bpy.ops.preferences.addon_enable(module="hybrid_quad")
    area = view()[1]
    area.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Hybrid Quad"
    yield 1.0
    yield from take_picture("install.png", area, (0.0, 0.865, 1.0, 1.0))
    area.type = "VIEW_3D"
    yield 1.0


def take_panel_picture(name: str) -> Iterator[float]:
    """Only the sidebar's upper part, with another target than the usual one."""
    settings = bpy.context.object.hybrid_quad
    settings.target_mode = "LENGTH"
    area = view()[1]
    region = next(region for region in area.regions if region.type == "UI")
    left, right = (region.x - area.x) / area.width, (region.x - area.x + region.width) / area.width
    yield from take_picture(name, area, (left, 0.77, right, 0.94))
    settings.target_mode = "COUNT"


def take_picture(
    name: str, area: bpy.types.Area | None = None, kept: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
) -> Iterator[float]:
    """The part of an area (default: the view) that lies between two corners, in shares of its width and height."""
    window = bpy.context.window_manager.windows[0]
    area = area or view()[1]
    area.tag_redraw()
    yield 0.3
    path = Path(tempfile.mkdtemp()) / name
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screenshot_area(filepath=str(path))
    if kept != (0.0, 0.0, 1.0, 1.0):
        crop(path, kept)
    save_side_by_side([path], OUT / name)


def crop(path: Path, kept: tuple[float, float, float, float]) -> None:
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    left, low, right, high = (round(share * size) for share, size in zip(kept, (width, height) * 2, strict=True))
    inside = pixels.reshape(height, width, 4)[low:high, left:right]
    part = bpy.data.images.new("part", right - left, high - low)
    part.pixels.foreach_set(np.ascontiguousarray(inside).ravel())
    part.filepath_raw, part.file_format = str(path), "PNG"
    part.save()
    for each in (image, part):
        bpy.data.images.remove(each)


main(steps())
