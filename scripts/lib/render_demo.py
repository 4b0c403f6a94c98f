"""Pictures of a remeshed object: input, frame field and result. Runs in Blender, on the file that batch.py wrote.

    blender -b RESULT.blend -P scripts/lib/render_demo.py -- --report R.json --out FOLDER [--size PIXELS] [--samples N]

Writes input.png, field.png, result.png, overview.png (the three side by side) and result.obj.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from field_crosses import add_field
from stage import FEATURES, SURFACE, Stage, save_side_by_side

import hybrid_quad
from hybrid_quad.blender import edge_marks
from hybrid_quad.blender.mesh_source import read_source
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.core.mesh_io import write_mesh
from hybrid_quad.core.remesh import remesh_with_options
from hybrid_quad.core.snapshots import Snapshot


class FieldSeen(Exception):
    """Ends a run once the frame field, which is all that is wanted of it, is there."""

    def __init__(self, snapshot: Snapshot) -> None:
        super().__init__("frame field")
        self.snapshot = snapshot


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--report", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", type=int, default=900)
    parser.add_argument("--samples", type=int, default=40)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    out = Path(arguments.out)
    record = json.loads(Path(arguments.report).read_text())
    result = bpy.data.objects[record["object"]]
    source = bpy.data.objects[record["source_object"]]

    hybrid_quad.register()
    try:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        quads = read_source(result, depsgraph)
        task = prepare_task(source, depsgraph)
        field = find_field(task)
    finally:
        hybrid_quad.unregister()
    faces = quads.polygons.vertices.reshape(-1, 4)
    write_mesh(out / "result.obj", quads.vertices, faces)

    stage = Stage(quads.vertices, arguments.size, arguments.samples)
    edge = float(np.linalg.norm(quads.vertices[faces[:, 0]] - quads.vertices[faces[:, 1]], axis=1).mean())
    polygons = np.split(task.source.polygons.vertices, np.cumsum(task.source.polygons.sizes)[:-1])
    thin = 0.035 * edge
    stage.draw_input(task.source.vertices, polygons, task.source.edges, task.marked_edges, thin)
    pictures = [stage.render(out / "input.png")]
    if field is not None:
        pictures.append(draw_field(stage, field, edge, out / "field.png"))
    sharp = (quads.marks & edge_marks.SHARP) != 0
    stage.draw_quads(quads.vertices, faces, quads.edges[~sharp], quads.edges[sharp], thin)
    stage.add_irregular_vertices(quads.vertices, faces, 0.22 * edge)
    pictures.append(stage.render(out / "result.png"))
    save_side_by_side(pictures, out / "overview.png")


def find_field(task) -> Snapshot | None:
    """The frame field that belongs to the result: the last one that the run shows."""
    seen: list[Snapshot] = []

    def look(snapshot: Snapshot) -> None:
        if "u direction" in snapshot.face_vectors:
            seen.append(snapshot)
        elif seen and snapshot.stage == "periodic field":
            raise FieldSeen(seen[-1])

    try:
        remesh_with_options(
            task.source.vertices, task.source.polygons, task.options, sharp_edges=task.marked_edges, on_snapshot=look
        )
    except FieldSeen as stop:
        return stop.snapshot
    return seen[-1] if seen else None


def draw_field(stage: Stage, field: Snapshot, edge: float, path: Path) -> Path:
    """Crosses about as far apart as the quads are large; cones as balls."""
    stage.clear()
    stage.add_surface(field.points, list(field.face_vertices.reshape(-1, 3)), SURFACE)
    add_field(stage, field, edge)
    stage.add_wires(field.points, field.lines, FEATURES, 0.05 * edge)
    return stage.render(path)


main()
