"""Makes the pictures of docs/stages.md: what each stage of one run handed to `on_snapshot`.

    blender -b --factory-startup --python-exit-code 1 -P docs/pictures/stages.py -- [--out FOLDER] [--samples N]

The model is tests/data/meshes/c3d_fandisk.obj. Where a stage was run more than once, for the number of quads, its last is shown.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from field_crosses import add_field  # noqa: E402
from stage import FEATURES, INPUT, LINES, SURFACE, Stage, save_side_by_side  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402
from hybrid_quad.core.snapshots import Snapshot  # noqa: E402

QUADS, SIZE, VIEW = 800, 340, (70.0, 75.0)
UPSIDE_DOWN = np.array((1.0, -1.0, -1.0))  # the side with the most patches up
PATCH = (0.92, 0.62, 0.20)
LOW, HIGH = np.array((0.10, 0.22, 0.55)), np.array((0.95, 0.80, 0.35))

Draw = Callable[[Stage, Snapshot, float], None]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images" / "stages")
    parser.add_argument("--samples", type=int, default=24)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    arguments.out.mkdir(parents=True, exist_ok=True)
    points, polygons = read_mesh(ROOT / "tests" / "data" / "meshes" / "c3d_fandisk.obj")
    points = points * UPSIDE_DOWN
    last: dict[str, Snapshot] = {}
    result = hybrid_quad.remesh(points, polygons, quads=QUADS, on_snapshot=lambda s: last.update({s.stage: s}))
    report = result.report
    print(f"{report['quads']} quads, {report['irregular_vertices']} irregular, field {report['field_singularities']}")
    print(f"patches {report['patches']}, {100 * report['singular_area_fraction']:.1f} % of the area")
    for snapshot in last.values():
        print(f"{snapshot.stage}: {len(snapshot.points)} vertices, {len(snapshot.face_sizes)} faces")
    edge = float(np.linalg.norm(np.diff(result.vertices[result.quads[:, :2]], axis=1), axis=2).mean())
    stage, folder = Stage(points, SIZE, arguments.samples, VIEW), Path(tempfile.mkdtemp())
    for name, drawn in PICTURES.items():
        panels = []
        for stage_name, draw in drawn:
            stage.clear()
            draw(stage, last[stage_name], edge)
            panels.append(stage.render(folder / f"{name}_{len(panels)}.png"))
        save_side_by_side(panels, arguments.out / f"{name}.png")
        print(f"{name}.png: {(arguments.out / f'{name}.png').stat().st_size // 1024} KiB", flush=True)


def triangles(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """The faces with their edges, and features in red."""
    stage.add_surface(snapshot.points, faces_of(snapshot), INPUT)
    stage.add_wires(snapshot.points, sides_of(snapshot)[0], LINES, 0.018 * edge)
    stage.add_wires(snapshot.points, snapshot.lines, FEATURES, 0.07 * edge)


def frame_field(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """A cross for about every quad; balls where the field is singular."""
    stage.add_surface(snapshot.points, faces_of(snapshot), SURFACE)
    add_field(stage, snapshot, edge)
    stage.add_wires(snapshot.points, snapshot.lines, FEATURES, 0.05 * edge)


def periodic_field(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """The product of the waves in both directions: light hills and dark hollows are the vertices to be."""
    share = 0.5 + 0.5 * np.clip(snapshot.vertex_values["morse"], -1, 1)
    colours = LOW + share[:, None] * (HIGH - LOW)
    stage.add_surface(snapshot.points, faces_of(snapshot), SURFACE, colours)
    stage.add_wires(snapshot.points, snapshot.lines, FEATURES, 0.05 * edge)


def parameterization(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """Faces that have grid coordinates, and those that have none in orange."""
    is_regular = snapshot.face_values["regular"] > 0
    draw_groups(stage, snapshot, is_regular)
    stage.add_wires(snapshot.points, sides_of(snapshot)[0], LINES, 0.018 * edge)
    stage.add_wires(snapshot.points, snapshot.lines, FEATURES, 0.05 * edge)


def regular_quads(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """The cells of the integer grid, and patches in orange."""
    cell = snapshot.face_values["quad"].astype(int)
    draw_groups(stage, snapshot, cell >= 0)
    edges, first, second = sides_of(snapshot)
    border = cell[first] != np.where(second < 0, -2, cell[second])
    stage.add_wires(snapshot.points, edges[border], LINES, 0.04 * edge)
    stage.add_wires(snapshot.points, snapshot.lines, FEATURES, 0.06 * edge)


def quads(stage: Stage, snapshot: Snapshot, edge: float) -> None:
    """The quads, with irregular vertices as balls."""
    rows = snapshot.face_vertices.reshape(-1, 4)
    stage.draw_quads(snapshot.points, rows, sides_of(snapshot)[0], snapshot.lines, 0.04 * edge)
    stage.add_irregular_vertices(snapshot.points, rows, 0.24 * edge)


def draw_groups(stage: Stage, snapshot: Snapshot, is_regular: np.ndarray) -> None:
    faces = faces_of(snapshot)
    for truth, colour in ((True, SURFACE), (False, PATCH)):
        own = [faces[f] for f in np.flatnonzero(is_regular == truth)]
        if own:
            stage.add_surface(snapshot.points, own, colour)


def faces_of(snapshot: Snapshot) -> list[tuple[int, ...]]:
    rows = np.split(snapshot.face_vertices, np.cumsum(snapshot.face_sizes)[:-1])
    return [tuple(row.tolist()) for row in rows]


def sides_of(snapshot: Snapshot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (k, 2), a face of each, and the other one, or -1 at the boundary."""
    size = snapshot.face_sizes
    end = np.cumsum(size)
    following = np.arange(1, len(snapshot.face_vertices) + 1)
    following[end - 1] = end - size
    sides = np.sort(np.stack([snapshot.face_vertices, snapshot.face_vertices[following]], axis=1), axis=1)
    face = np.repeat(np.arange(len(size)), size)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, face = sides[order], face[order]
    is_first = np.ones(len(sides), bool)
    is_first[1:] = (sides[1:] != sides[:-1]).any(axis=1)
    at = np.flatnonzero(is_first)
    has_second = np.append(~is_first[1:], False)[at]
    return sides[at], face[at], np.where(has_second, face[np.minimum(at + 1, len(face) - 1)], -1)


PICTURES: dict[str, tuple[tuple[str, Draw], ...]] = {
    "surface": (("mesh", triangles), ("features", triangles), ("working surface", triangles)),
    "field": (
        ("frame field", frame_field),
        ("periodic field", periodic_field),
        ("spanning parameterization", parameterization),
    ),
    "quads": (("regular quads", regular_quads), ("assemble", quads), ("improve", quads)),
}

main()
