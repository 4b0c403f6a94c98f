"""The extension's zip dragged into Blender's window by a real mouse, installed by the dialog that asks, and used by a click.

    blender --factory-startup -p 0 0 1600 1000 -P run_drop_in_window.py -- FOLDER

for Blender 4.2 and newer, on a screen of 1600 x 1000 with nothing else. scripts/test_newer_window does what is asked for in FOLDER
with mouse and keys: here nothing is simulated within Blender. The zip lies in FOLDER's parent. Blender's own folders are those
that BLENDER_USER_RESOURCES names: an empty one. Ends Blender with status 0 or 1.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import (
    PATIENCE,
    PICTURES,
    ask,
    drawn,
    expect,
    in_view,
    main,
    show_sidebar_tab,
    take_picture,
    view,
    watched,
)

NAME = "bl_ext.user_default.hybrid_quad"
REPORT = "VIEW3D_PT_hybrid_quad_report"
REMESH_BUTTON = 125  # pixels from the sidebar's top down to its middle


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    zips = list(Path(PICTURES[0]).resolve().parent.glob("*.zip"))
    expect(len(zips) == 1, f"one zip to drag: {zips}")
    expect(not is_enabled(), "the add-on is not there yet")
    _, area = view()
    yield from ask("drag", f"{zips[0]} {on_screen(area.x + area.width // 2, area.y + area.height // 2)}")
    yield 1.0
    yield from take_picture("drop_1_dialog.png")
    expect(not is_enabled(), "Blender asks before it installs")

    yield from ask("key", "Return")
    yield from until(is_enabled, "Return in the dialog installs the extension and switches it on")
    expect(
        Path(sys.modules[NAME].__file__).is_relative_to(bpy.utils.user_resource("EXTENSIONS")), "in the user's folder"
    )
    source = bpy.data.objects["Cube"]
    expect(hasattr(source, "hybrid_quad"), "objects have its settings")
    with in_view():
        bpy.context.space_data.overlay.show_wireframes = True
    yield from show_sidebar_tab()
    yield from take_picture("drop_2_installed.png")

    report = getattr(bpy.types, REPORT)
    report.draw = watched(report.draw, REPORT)
    region = next(region for region in view()[1].regions if region.type == "UI")
    yield from ask("click", on_screen(region.x + region.width // 2, region.y + region.height - REMESH_BUTTON))
    yield from until(lambda: "Cube Quads" in bpy.data.objects, "a click on the button remeshes")
    faces = bpy.data.objects["Cube Quads"].data.polygons
    expect(len(faces) > 100 and {len(face.vertices) for face in faces} == {4}, f"{len(faces)} quads")
    expect(source.hide_get(), "the source is hidden")
    yield from until(lambda: REPORT in drawn, "the result's report is drawn")
    yield 5.0  # panels move to their new places, slowly without a graphics card
    yield from take_picture("drop_3_remeshed.png")
    bpy.ops.wm.quit_blender()
    yield float(PATIENCE)
    expect(False, "Blender ends, and with status 0")


def is_enabled() -> bool:
    return NAME in bpy.context.preferences.addons


def on_screen(x: int, y: int) -> str:
    """A place of the window as one of the screen, which counts from the top."""
    return f"{x} {view()[0].height - 1 - y}"


def until(is_so, what: str) -> Iterator[float]:
    began = time.monotonic()
    while not is_so():
        expect_in_time = time.monotonic() - began < PATIENCE
        if not expect_in_time:
            raise AssertionError(f"not so: {what}")
        yield 0.1
    print(f"ok: {what}", flush=True)


if __name__ == "__main__":
    main(steps())
