"""How long a change takes until the preview shows what comes of it, in a window, and where the time goes.

    LIBGL_ALWAYS_SOFTWARE=1 xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup -p 0 0 1600 1000 -P benchmarks/preview_in_window.py -- [--model FILE] [--quads N] [--bounds]

Without a model, a bumpy torus of 51 200 triangles. Prints seconds since the change for: the end of the first drawing of the window
that the change itself brings about, the worker asked, its answer there, the view drawn with it; and how long that drawing of the
view took, with how much of it by the preview.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / "addon"), str(ROOT / "tests" / "addon" / "window")]
arguments_behind = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
sys.argv = [*sys.argv[:1]]  # what is behind "--" is a folder for pictures to the window tests

from run_in_window import in_view, main, view  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.blender.preview import drawing, sessions  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402
from scenes import activate, add_object  # noqa: E402

SIDE = 160  # points around the torus, either way
CHANGES = 6
PATIENCE = 60


def steps() -> Iterator[float]:
    """The changes; every number is a pause in seconds, in which Blender handles events."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", type=Path, help="a mesh file")
    parser.add_argument("--quads", type=int, default=5000, help="of the first preview (default %(default)s)")
    parser.add_argument(
        "--bounds",
        action="store_true",
        help="Blender draws the model's box alone, and smooths no edges: nearly as quick as with a graphics card",
    )
    arguments = parser.parse_args(arguments_behind)
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    hybrid_quad.register()
    with in_view():
        obj = activate(add_object("Model", *(read_model(arguments.model) if arguments.model else torus())))
        bpy.ops.view3d.view_selected()
    obj.hybrid_quad.quads = arguments.quads
    if arguments.bounds:
        obj.display_type = "BOUNDS"
        bpy.context.preferences.system.viewport_aa = "OFF"
    watch()
    sessions.settings().show_field = True
    yield from drawn()
    print(f"Blender {bpy.app.version_string}, {len(obj.data.polygons)} faces", flush=True)
    print(f"{'idle':>8}{'asked':>8}{'answer':>8}{'shown':>8}{'view':>8}{'preview':>9}", flush=True)
    for number in range(CHANGES):
        yield 1.5
        moments.clear()
        began = time.monotonic()
        obj.hybrid_quad.quads = arguments.quads + 50 * (number + 1)
        obj.update_tag()  # as the panel does
        view()[1].tag_redraw()
        yield 0.0
        idle = time.monotonic() - began
        yield from drawn()
        times = [idle, *(moments[name] - began for name in ("asked", "answer", "shown"))]
        print("".join(f"{value:8.2f}" for value in times), end="")
        print(f"{moments['view']:8.2f}{moments['preview']:9.3f}", flush=True)
    hybrid_quad.unregister()
    yield 0.1


moments: dict[str, float] = {}


def watch() -> None:
    """Keeps the moments at which the session begins and ends, and how long views are drawn."""
    session = sessions.field.session
    start, accept, draw = session._start_next, session._accept, drawing._draw_all

    def started() -> None:
        start()
        moments["asked"] = time.monotonic()

    def accepted(*arguments) -> None:
        accept(*arguments)
        moments["answer"] = time.monotonic()

    def before_view() -> None:
        moments["began view"] = time.monotonic()

    def drawn_over(*arguments) -> None:
        began = time.monotonic()
        draw(*arguments)
        moments["preview"] = time.monotonic() - began

    def after_view() -> None:
        moments["view"] = time.monotonic() - moments["began view"]
        if "answer" in moments:
            moments.setdefault("shown", time.monotonic())

    session._start_next, session._accept, drawing._draw_all = started, accepted, drawn_over
    space = bpy.types.SpaceView3D
    space.draw_handler_add(before_view, (), "WINDOW", "PRE_VIEW")
    space.draw_handler_add(after_view, (), "WINDOW", "POST_PIXEL")


def drawn() -> Iterator[float]:
    """Until the answer is shown."""
    began = time.monotonic()
    while "shown" not in moments:
        if time.monotonic() - began > PATIENCE:
            raise AssertionError(f"no preview: {sessions.field.session.error}")
        yield 0.005


def torus() -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """A torus with bumps, of two triangles for each point."""
    angles = np.linspace(0, 2 * np.pi, SIDE, endpoint=False)
    around, across = (each.ravel() for each in np.meshgrid(angles, angles, indexing="ij"))
    radius = 0.5 + 0.06 * np.sin(3 * around) * np.cos(2 * across)
    out = 1.3 + radius * np.cos(across)
    points = np.stack([out * np.cos(around), out * np.sin(around), radius * np.sin(across)], axis=1)
    faces = []
    for i in range(SIDE):
        for j in range(SIDE):
            a, b = i * SIDE + j, (i + 1) % SIDE * SIDE + j
            c, d = (i + 1) % SIDE * SIDE + (j + 1) % SIDE, i * SIDE + (j + 1) % SIDE
            faces += [(a, b, c), (a, c, d)]
    return points, faces


def read_model(path: Path) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    points, polygons = read_mesh(path)
    return points, [tuple(face) for face in np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])]


if __name__ == "__main__":
    view()
    main(steps())
