"""How long each step of a run from the window holds Blender's own thread, on a large mesh that carries much.

    blender -b --factory-startup --python-exit-code 1 -P benchmarks/blender_thread.py -- [--quads N] [--levels N] [--model FILE]

Also by a Python that has the package bpy. The model is subdivided, and gets four vertex groups with weights everywhere, a UV map
of two islands, and colors of vertices and face corners. Prints seconds, wall and of the processor, of each step between two of
which Blender's window answers; what the worker processes do meanwhile counts in the total only.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "addon"))

import hybrid_quad  # noqa: E402
from hybrid_quad.blender import background_run  # noqa: E402
from hybrid_quad.blender.result_mesh import Placement, place_result  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402

MODEL = ROOT.parent / "shared" / "meshes" / "dev" / "c3d_spot_triangulated.obj"
PAUSE = 0.02  # seconds in which a window would answer


def main() -> None:
    """Prints the steps."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", type=Path, default=MODEL, help="of triangles or quads (default %(default)s)")
    parser.add_argument("--levels", type=int, default=3, help="how often it is subdivided (default %(default)s)")
    parser.add_argument("--quads", type=int, default=20_000, help="of the result (default %(default)s)")
    behind = sys.argv.index("--") + 1 if "--" in sys.argv else 1
    arguments = parser.parse_args(sys.argv[behind:] if "--" in sys.argv or not bpy.app.binary_path else [])
    hybrid_quad.register()
    obj = add_model(arguments.model, arguments.levels)
    obj.hybrid_quad.quads = arguments.quads
    print(f"Blender {bpy.app.version_string}: {len(obj.data.polygons)} faces, {arguments.quads} quads asked for")
    steps = Steps()
    began = time.perf_counter()
    run_by_steps(obj, steps)
    print(f"{'longest step':24} {max(steps.wall):6.3f} s")
    print(f"{'total':24} {time.perf_counter() - began:6.3f} s", flush=True)


def run_by_steps(obj: bpy.types.Object, steps: Steps) -> None:
    """What the operator does at every tick of its timer."""
    run = steps("digest of the source", lambda: background_run.start(None, obj))
    while not run.is_finished:
        name = "reading" if run.is_reading else f"looking at: {run.worker.stage}"
        steps(name, run.poll)
    while not steps("making the mesh", lambda: run.build(obj)):
        pass
    built, result, carried, task = run.take_built(), run.result(), run.carried(), run.task

    def place() -> None:
        is_changed = run.source.has_changed(obj)
        place_result(bpy.context, obj, task, result, Placement(in_place=is_changed), carried, built)

    steps("digest and placing", place)
    background_run.forget()


class Steps:
    """Times steps, and prints those that a person could feel.

    Attributes
    ----------
    wall : list of float
        Seconds of all steps.
    """

    def __init__(self) -> None:
        self.wall: list[float] = []

    def __call__(self, name: str, step: Callable[[], Any]) -> Any:
        """Does a step."""
        wall, processor = time.perf_counter(), time.thread_time()
        found = step()
        wall, processor = time.perf_counter() - wall, time.thread_time() - processor
        self.wall.append(wall)
        if wall > PAUSE:
            print(f"{name:40} {wall:6.3f} s, {processor:6.3f} s of the processor")
        time.sleep(PAUSE)
        return found


def add_model(path: Path, levels: int) -> bpy.types.Object:
    """The active object, which carries data of many kinds."""
    vertices, polygons = read_mesh(path)
    fine = hybrid_quad.subdivide(vertices, polygons.vertices.reshape(len(polygons.sizes), -1), levels=levels)
    points, quads = np.asarray(fine.vertices, np.float32), np.asarray(fine.quads, np.int32)
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(points.tolist(), [], quads.tolist())
    obj = bpy.data.objects.new(path.stem, mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    corners = quads.ravel()
    mesh.uv_layers.new(name="UV")
    layer = mesh.uv_layers["UV"]
    items, name = (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")
    is_right = points[quads].mean(axis=1)[:, 0] > 0
    items.foreach_set(
        name, (points[corners, :2] + np.where(np.repeat(is_right, 4), 3, 0)[:, None]).astype(np.float32).ravel()
    )
    colors = points[:, [0, 1, 2, 0]]
    mesh.attributes.new("Smooth", "FLOAT_COLOR", "POINT").data.foreach_set("color", colors.ravel())
    mesh.attributes.new("Corners", "BYTE_COLOR", "CORNER").data.foreach_set("color", colors[corners].ravel())
    add_groups(obj, points)
    bpy.context.view_layer.update()
    return obj


def add_groups(obj: bpy.types.Object, points: Any) -> None:
    """Four groups, of which every vertex is in all."""
    import bmesh  # which a bpy of PyPI has only once that is loaded

    weights = np.abs(points @ np.random.default_rng(0).standard_normal((3, 4)))
    weights /= weights.sum(axis=1, keepdims=True)
    for name in "ABCD":
        obj.vertex_groups.new(name=name)
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    layer = edited.verts.layers.deform.verify()
    for vertex, row in zip(edited.verts, weights.tolist(), strict=True):
        for group, weight in enumerate(row):
            vertex[layer][group] = weight
    edited.to_mesh(obj.data)
    edited.free()


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # some Blenders hang while Python winds down
