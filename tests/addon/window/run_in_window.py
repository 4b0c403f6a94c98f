"""The add-on in a real window: panel drawn, a run in the background, progress, one undo step, Esc.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -P run_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from collections.abc import Generator, Iterator
from pathlib import Path

import bpy
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, os.environ.get("HQ_ADDON_PARENT", str(HERE.parents[2] / "addon")))
sys.path.insert(0, str(HERE.parent))

import hybrid_quad  # noqa: E402
from hybrid_quad.blender import background_run, panels  # noqa: E402
from scenes import add_sphere, faces_of  # noqa: E402

PICTURES = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
LONG_RUN_QUADS = 150_000
PATIENCE = 60  # seconds
drawn: set[str] = set()


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    watch_drawing()
    hybrid_quad.register()
    with in_view():
        source = add_sphere(quads=500)
        bpy.ops.ed.undo_push(message="sphere")
    yield 0.5
    yield from show_sidebar_tab()
    expect("VIEW3D_PT_hybrid_quad" in drawn, "the panel is drawn")
    closed = {"VIEW3D_PT_hybrid_quad_report"}  # there is none yet
    expect({cls.__name__ for cls in panels.CLASSES} - closed <= drawn, "so are its parts")
    yield from take_picture("1_panel.png")

    with in_view():
        expect(
            bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT") == {"RUNNING_MODAL"},
            "the run goes on in the background",
        )
        expect(not bpy.ops.object.hybrid_quad_remesh.poll(), "a second one cannot be started meanwhile")
    yield from until_finished()
    result = bpy.context.view_layer.objects.active
    expect(result.name == "Sphere Quads" and {len(f) for f in faces_of(result)} == {4}, "the result is there")
    expect(bpy.data.objects["Sphere"].hide_get(), "the source is hidden")
    yield 0.5
    expect("VIEW3D_PT_hybrid_quad_report" in drawn, "the result's report is drawn")
    yield from take_picture("2_done.png")

    with in_view():
        bpy.ops.ed.undo()
    yield 0.5
    expect("Sphere Quads" not in bpy.data.objects, "one undo takes the result away")
    source = bpy.data.objects["Sphere"]
    expect(not source.hide_get(), "and shows the source again")

    with in_view():
        # With an undo step, as a button has.
        expect(bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}, "the same once more")
    run = background_run.current()
    yield from until_finished()
    expect(run.is_known and run.worker is None, "nothing is computed again, and no process is started")
    expect("Sphere Quads" in bpy.data.objects, "the result is as it was")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.5
    expect("Sphere Quads" not in bpy.data.objects, "and is one undo step, too")
    source = bpy.data.objects["Sphere"]

    source.hybrid_quad.quads = LONG_RUN_QUADS
    before = sorted(bpy.data.objects.keys()), sorted(bpy.data.meshes.keys())
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT")
    run = background_run.current()
    started = time.monotonic()
    while run.fraction == 0 and time.monotonic() - started < PATIENCE / 2:
        yield 0.05
    yield from take_picture("3_running.png")
    expect(not run.is_finished, "the long run goes on")
    press("ESC")
    started = time.monotonic()
    yield from until_finished()
    # The worker is dead within a second; a window drawn without a graphics card takes its time between events.
    expect(time.monotonic() - started < 20, "Esc ends it")
    try:
        run.result()
        expect(False, "the run was cancelled")
    except hybrid_quad.Cancelled:
        pass
    expect((sorted(bpy.data.objects.keys()), sorted(bpy.data.meshes.keys())) == before, "and nothing has changed")
    with in_view():
        expect(bpy.ops.object.hybrid_quad_remesh.poll(), "the next run can be started")
    hybrid_quad.unregister()
    yield 0.3


def expect(truth: bool, what: str) -> None:
    if not truth:
        raise AssertionError(f"not so: {what}")
    print(f"ok: {what}", flush=True)


def view() -> tuple[bpy.types.Window, bpy.types.Area]:
    window = bpy.context.window_manager.windows[0]
    return window, next(area for area in window.screen.areas if area.type == "VIEW_3D")


def in_view():
    window, area = view()
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window, area=area, region=region)


def press(key: str) -> None:
    window, area = view()
    x, y = area.x + area.width // 2, area.y + area.height // 2
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type=key, value=value, x=x, y=y)


def watch_drawing() -> None:
    for cls in panels.CLASSES:
        cls.bl_options = set()  # all open
        cls.draw = watched(cls.draw, cls.__name__)


def watched(original, name: str):
    def draw(self, context):  # Blender counts the arguments
        original(self, context)
        drawn.add(name)

    return draw


def show_sidebar_tab() -> Iterator[float]:
    _, area = view()
    area.spaces[0].show_region_ui = True
    yield 1.0
    region = next(region for region in area.regions if region.type == "UI")
    if hasattr(region, "active_panel_category"):  # from Blender 4.3 on
        for _ in range(20):
            area.tag_redraw()  # which Blender 4.3 does not do by itself
            try:
                region.active_panel_category = "Hybrid Quad"
                break
            except (AttributeError, TypeError):  # before the first drawing
                yield 0.3
    else:  # the tabs stand along the right edge, ours is the last
        window, _ = view()
        for y in range(region.y + region.height - 20, region.y + region.height // 3, -25):
            for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
                window.event_simulate(type=kind, value=value, x=region.x + region.width - 12, y=y)
                yield 0.1
            if drawn:
                break
    yield 0.8


def until_finished() -> Iterator[float]:
    started = time.monotonic()
    while background_run.current() is not None:
        expect_in_time = time.monotonic() - started < PATIENCE
        if not expect_in_time:
            raise AssertionError("the run does not end")
        yield 0.05
    yield 0.3


def take_picture(name: str, folder: str = "") -> Generator[float, None, str]:
    """Of the window, into FOLDER, or another where there is none. Gives its path, or an empty text where neither is known.

    Blender 4 and newer take black ones from here, so there somebody else is asked.
    """
    if PICTURES:
        folder = PICTURES[0]
    if not folder:
        return ""
    path = Path(folder).resolve() / name
    if bpy.app.version < (4, 0):
        window, area = view()
        with bpy.context.temp_override(window=window, area=area):
            bpy.ops.screen.screenshot(filepath=str(path))
        yield 0.3
        return str(path)
    yield from ask(name, folder=folder)
    return str(path)


def ask(name: str, text: str = "", folder: str = "") -> Iterator[float]:
    """Has somebody outside do what Blender cannot: the program that removes FOLDER/NAME.wanted when it is done."""
    wanted = Path(folder or PICTURES[0]).resolve() / f"{name}.wanted"
    written = wanted.with_suffix(".part")
    written.write_text(text)
    written.rename(wanted)
    for _ in range(200):
        if not wanted.exists():
            return
        yield 0.2
    raise AssertionError(f"nobody does what is asked for in {wanted.parent}")


def pixels_of(path: str) -> np.ndarray:
    """(height, width, 3) colors of a picture, from its lower left corner on."""
    image = bpy.data.images.load(path)
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[..., :3]


def main(test: Iterator[float]) -> None:
    """Steps through a test, and ends Blender with status 0 or 1."""
    bpy.context.preferences.view.show_splash = False  # now: later it is on the screen already
    test = with_picture_of_failure(test)

    def tick() -> float:
        try:
            return next(test)
        except StopIteration:
            status = 0
        except BaseException:
            status = 1
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)

    bpy.app.timers.register(tick, first_interval=2.0, persistent=True)


def with_picture_of_failure(test: Iterator[float]) -> Iterator[float]:
    """The test; should it fail, ``failed.png`` shows what was on the screen."""
    try:
        yield from test
    except GeneratorExit:  # Blender ends
        raise
    except BaseException:
        traceback.print_exc()
        yield from take_picture("failed.png")
        raise


if __name__ == "__main__":
    main(steps())
