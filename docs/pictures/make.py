"""Makes the pictures of docs/direction-and-size.md, and prints the figures that stand there.

    blender -b --factory-startup --python-exit-code 1 -P docs/pictures/make.py -- [NAME ...] [--out FOLDER]

The models are those of blend_samples and tests/data/meshes, whose lists name sources and licences.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from stage import FEATURES, Stage, save_side_by_side  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.core.curve_counts import chains_of_edges  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402
from hybrid_quad.core.strokes import joined_lines  # noqa: E402

GUIDE = (0.05, 0.55, 0.20)
DENSE, SPARSE = np.array((0.85, 0.25, 0.10)), np.array((0.92, 0.90, 0.86))


@dataclass
class Model:
    """A surface as it stands in the picture."""

    points: np.ndarray
    faces: list[tuple[int, ...]]
    view: tuple[float, float] = (64.0, 32.0)
    edges_by_mark: np.ndarray | None = None


class Panels:
    """The panels of one picture, drawn one after the other at the same scale."""

    def __init__(self, model: Model, size: int, samples: int) -> None:
        self.model = model
        self._stage = Stage(model.points, size, samples, model.view)
        self._folder = Path(tempfile.mkdtemp())
        self._paths: list[Path] = []
        self._extent = float(np.linalg.norm(np.ptp(model.points, axis=0)))

    def draw_input(
        self,
        marked: np.ndarray | None = None,
        lines: list[np.ndarray] | None = None,
        density: np.ndarray | None = None,
        vectors: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> None:
        """The surface with what is asked for: marked edges, drawn lines, density, or directions at places."""
        model, stage = self.model, self._stage
        colours = None if density is None else SPARSE + _share(density)[:, None] * (DENSE - SPARSE)
        stage.draw_input(model.points, model.faces, _edges(model.faces), marked, 0.0018 * self._extent, colours)
        self._draw_lines(lines, 0.005)
        for begin, vector in zip(*vectors, strict=True) if vectors else []:
            stage.add_wires(np.stack([begin, begin + vector]), np.array([[0, 1]]), GUIDE, 0.0025 * self._extent)
        self._take()

    def draw_result(
        self,
        result: hybrid_quad.RemeshResult,
        marked: np.ndarray | None = None,
        lines: list[np.ndarray] | None = None,
        cones: bool = False,
        dots: np.ndarray | None = None,
    ) -> None:
        """The quads; `marked` edges of theirs in red, drawn lines, irregular vertices as balls where asked, and red dots."""
        stage, points, quads = self._stage, result.vertices, result.quads
        edges = _edges(quads)
        edge = float(np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).mean())
        width = max(0.045 * edge, 0.0011 * self._extent)
        stage.draw_quads(points, quads, edges, marked, width)
        self._draw_lines(lines, 0.003)
        if cones:
            stage.add_irregular_vertices(points, quads, 0.3 * edge)
        if dots is not None:
            stage.add_balls(dots, FEATURES, 0.22 * edge)
        self._take()

    def _draw_lines(self, lines: list[np.ndarray] | None, width: float) -> None:
        for line in lines or []:
            steps = np.arange(len(line) - 1)
            self._stage.add_wires(line, np.stack([steps, steps + 1], axis=1), GUIDE, width * self._extent)

    def save(self, path: Path) -> None:
        save_side_by_side(self._paths, path)
        print(f"{path.name}: {path.stat().st_size // 1024} KiB", flush=True)

    def _take(self) -> None:
        self._paths.append(self._stage.render(self._folder / f"{len(self._paths)}.png"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="pictures to make (default: all)")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images" / "direction-and-size")
    parser.add_argument("--samples", type=int, default=24)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name, make in PICTURES.items():
        if not arguments.names or name in arguments.names:
            make(arguments.samples).save(arguments.out / f"{name}.png")


def features(samples: int) -> Panels:
    """Edges marked sharp on a CAD part."""
    model = _sample("cad_part", view=(60.0, 32.0))
    panels = Panels(model, 450, samples)
    panels.draw_input(marked=model.edges_by_mark)
    result = _remesh(model, quads=2000, sharp_angle=None, sharp_edges=model.edges_by_mark)
    panels.draw_result(result, marked=result.feature_edges)
    return panels


def borders(samples: int) -> Panels:
    """The border between two materials on a smooth model."""
    model = _sample("smooth_model", view=(75.0, 60.0))
    middles = np.array([model.points[list(face)].mean(axis=0) for face in model.faces])
    low, high = model.points.min(axis=0), model.points.max(axis=0)
    height, along = ((middles - low) / (high - low))[:, 2], ((middles - low) / (high - low))[:, 1]
    marked = _border(model.faces, height > 0.42 + 0.1 * np.sin(9 * along))
    panels = Panels(model, 450, samples)
    panels.draw_input(marked=marked)
    result = _remesh(model, quads=2500, sharp_angle=None, sharp_edges=marked)
    panels.draw_result(result, marked=result.feature_edges)
    return panels


def guides(samples: int) -> Panels:
    """Lines drawn across a flank."""
    model = _sample("smooth_model", view=(75.0, 75.0))
    lines = _lines_on_flank(model)
    panels = Panels(model, 450, samples)
    panels.draw_input(lines=lines)
    directions = hybrid_quad.guides_from_strokes(model.points, model.faces, lines, radius=0.12)
    result = _remesh(model, quads=2500, sharp_angle=None, guides=directions)
    panels.draw_result(result, lines=lines, cones=True)
    return panels


def hard_guides(samples: int) -> Panels:
    """A line around the neck as a loop, and as a ring; another one crosses it."""
    model = _sample("smooth_model", view=(75.0, 60.0))
    panels = Panels(model, 450, samples)
    lines = _belts(model)
    for kind in ("loop", "ring"):
        strokes = [hybrid_quad.Stroke(line, 1.0, kind) for line in lines]
        result = _remesh(model, quads=1500, sharp_angle=None, strokes=strokes)
        panels.draw_result(result, lines=lines, cones=True)
        print(
            "   ", [{k: g[k] for k in ("kind", "met", "edges", "distance", "angle")} for g in result.report["guides"]]
        )
    return panels


def counts(samples: int) -> Panels:
    """Two creases of a CAD part: left as they come, right with exactly 6 and 11 quads along them, counted by dots."""
    model = _sample("cad_part", view=(60.0, 32.0))
    curves = _two_creases(model)
    lines = [model.points[curve] for curve in curves]
    panels = Panels(model, 450, samples)
    for asked in (None, [(curve, n) for curve, n in zip(curves, (6, 11), strict=True)]):
        result = _remesh(model, quads=1000, sharp_angle=None, sharp_edges=model.edges_by_mark, curve_counts=asked)
        on_lines = [_points_on(result.vertices, line) for line in lines]
        print("   ", [len(each) - 1 for each in on_lines], "quads along the two creases")
        panels.draw_result(result, marked=result.feature_edges, lines=lines, dots=np.concatenate(on_lines))
        print("   ", result.report["curve_counts"])
    return panels


def field(samples: int) -> Panels:
    """One model at both ends and in the middle of field_smoothness."""
    model = _sample("smooth_model", view=(75.0, 60.0))
    panels = Panels(model, 300, samples)
    for smoothness in (0.0, 0.5, 1.0):
        result = _remesh(model, quads=2000, sharp_angle=None, field_smoothness=smoothness)
        panels.draw_result(result, cones=True)
    return panels


def density(samples: int) -> Panels:
    """A painted head."""
    model, values = _painted_spot()
    panels = Panels(model, 450, samples)
    panels.draw_input(density=values)
    panels.draw_result(_remesh(model, quads=3500, sharp_angle=None, density=values), cones=True)
    return panels


def adaptivity(samples: int) -> Panels:
    """Even quads, and quads as small as the bends ask for."""
    model = _sample("sculpted_head", view=(78.0, 20.0))
    panels = Panels(model, 450, samples)
    for value in (0.0, 1.0):
        panels.draw_result(_remesh(model, quads=2500, sharp_angle=None, adaptivity=value), cones=True)
    return panels


def fidelity(samples: int) -> Panels:
    """The painted head at both ends and in the middle of size_fidelity."""
    model, values = _painted_spot()
    panels = Panels(model, 300, samples)
    for value in (0.0, 0.5, 1.0):
        result = _remesh(model, quads=2500, sharp_angle=None, density=values, size_fidelity=value)
        panels.draw_result(result, cones=True)
    return panels


def anisotropy(samples: int) -> Panels:
    """Squares, and quads that are longer where the surface bends less."""
    model = _sample("cad_part", view=(60.0, 32.0))
    panels = Panels(model, 450, samples)
    for value in (1.0, 4.0):
        result = _remesh(model, quads=700, sharp_angle=None, sharp_edges=model.edges_by_mark, anisotropy=value)
        panels.draw_result(result, marked=result.feature_edges)
    return panels


def frames(samples: int) -> Panels:
    """Frames that lean: one vector around, the other up the roof and aside."""
    model = _sample("open_surface", view=(45.0, 32.0))
    around, up = _around_and_up(model)
    radius = np.linalg.norm(model.points[:, :2], axis=1, keepdims=True)  # as many quads around everywhere
    asked = np.stack([around, up + 0.6 * around], axis=1) * (radius / np.sqrt((radius**2).mean()))[:, None]
    panels = Panels(model, 450, samples)
    shown = np.flatnonzero((np.arange(len(model.points)) // 112 % 4 == 2) & (np.arange(len(model.points)) % 4 == 0))
    length = 0.03 * float(np.linalg.norm(np.ptp(model.points, axis=0)))
    lift = 0.004 * np.array((0.0, 0.0, 1.0))
    places = np.repeat(model.points[shown] + lift, 2, axis=0)
    panels.draw_input(vectors=(places, length * asked[shown].reshape(-1, 3)))
    panels.draw_result(_remesh(model, quads=1500, sharp_angle=None, frames=asked, size_fidelity=1.0))
    return panels


def symmetry(samples: int) -> Panels:
    """A head whose triangles are not symmetric, and its exactly mirrored quads with the seam."""
    points, polygons = read_mesh(ROOT / "tests" / "data" / "meshes" / "c3d_suzanne.obj")
    points = points - 0.5 * (points.min(axis=0) + points.max(axis=0))
    faces = [tuple(face.tolist()) for face in np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])]
    upright = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    model = Model(upright, faces, view=(80.0, 15.0))
    panels = Panels(model, 450, samples)
    panels.draw_input()
    result = _remesh(model, quads=2500, sharp_angle=None, symmetry="auto")
    edges = _edges(result.quads)
    panels.draw_result(result, marked=edges[(result.vertices[edges][:, :, 0] == 0).all(axis=1)])
    print("   ", result.report["symmetry"])
    return panels


PICTURES: dict[str, Callable[[int], Panels]] = {
    make.__name__: make
    for make in (
        features,
        borders,
        guides,
        hard_guides,
        counts,
        field,
        density,
        adaptivity,
        fidelity,
        anisotropy,
        frames,
        symmetry,
    )
}


def _sample(name: str, view: tuple[float, float]) -> Model:
    """The object of a sample file, as it stands there."""
    with bpy.data.libraries.load(str(ROOT / "blend_samples" / f"{name}.blend")) as (stored, wanted):
        wanted.objects = list(stored.objects)
    obj = next(each for each in wanted.objects if each.type == "MESH")
    obj.rotation_mode = "XYZ"
    matrix = np.array(obj.rotation_euler.to_matrix())
    points = np.array([tuple(v.co) for v in obj.data.vertices], float) @ matrix.T
    marks = np.array([tuple(e.vertices) for e in obj.data.edges if e.use_edge_sharp], int).reshape(-1, 2)
    return Model(points, [tuple(p.vertices) for p in obj.data.polygons], view, marks)


def _remesh(model: Model, **options: object) -> hybrid_quad.RemeshResult:
    result = hybrid_quad.remesh(model.points, model.faces, **options)
    report = result.report
    names = {key: value for key, value in options.items() if np.isscalar(value)}
    print(
        f"    {names}: {len(result.quads)} quads, {report['irregular_vertices']} irregular "
        f"({report['field_singularities']} in the field), "
        f"mean SJ {report['scaled_jacobian']['mean']:.3f}, mean distance {report['mean_distance_percent']:.3f} %",
        flush=True,
    )
    return result


def _painted_spot() -> tuple[Model, np.ndarray]:
    """Spot, with three times the density around her muzzle and eyes."""
    model = _sample("smooth_model", view=(75.0, 60.0))
    low, high = model.points.min(axis=0), model.points.max(axis=0)
    centre = np.array([0.5 * (low[0] + high[0]), low[1], low[2] + 0.68 * (high[2] - low[2])])
    distance = np.linalg.norm(model.points - centre, axis=1)
    return model, 1 + 2 * np.clip(1.6 - distance / 0.4, 0, 1)


def _lines_on_flank(model: Model) -> list[np.ndarray]:
    """Three slanted lines on the side that the picture shows."""
    tree = BVHTree.FromPolygons(model.points.tolist(), model.faces)
    low, high = model.points.min(axis=0), model.points.max(axis=0)
    lines = []
    for shift in (0.28, 0.45, 0.62):
        line = []
        for t in np.linspace(0.0, 1.0, 40):
            across, height = shift + 0.24 * t, 0.34 + 0.24 * t
            origin = Vector((high[0] + 1, low[1] + across * (high[1] - low[1]), low[2] + height * (high[2] - low[2])))
            hit = tree.ray_cast(origin, Vector((-1, 0, 0)))[0]
            if hit is not None:
                line.append(tuple(hit))
        lines.append(np.array(line))
    return lines


def _belts(model: Model) -> list[np.ndarray]:
    """Around the belly, and along the back from the neck to the tail."""
    low, high = model.points.min(axis=0), model.points.max(axis=0)
    along = 0.62 * (high - low)[1] + low[1]
    return [_section(model, 1, along), _section(model, 2, 0.36 * (high - low)[2] + low[2])]


def _section(model: Model, axis: int, place: float) -> np.ndarray:
    """The longest line in which a plane cuts a surface, in even steps."""
    height = model.points[:, axis] - place
    pieces = []
    for face in model.faces:
        ends = []
        for a, b in zip(face, [*face[1:], face[0]], strict=True):
            if (height[a] > 0) != (height[b] > 0):
                first, second = min(a, b), max(a, b)  # the same point from both faces
                share = height[first] / (height[first] - height[second])
                ends.append((1 - share) * model.points[first] + share * model.points[second])
        if len(ends) == 2:
            pieces.append(np.array(ends))
    lines = joined_lines(pieces)
    arcs = [np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]) for line in lines]
    longest = max(range(len(lines)), key=lambda index: arcs[index][-1])
    at = np.linspace(0, arcs[longest][-1], 240)
    return np.stack([np.interp(at, arcs[longest], lines[longest][:, i]) for i in range(3)], axis=1)


def _two_creases(model: Model) -> list[list[int]]:
    """The two creases nearest to the camera that are neither short nor long, as paths of vertices."""
    tilt, turn = np.radians(model.view)
    towards = np.array([np.sin(tilt) * np.sin(turn), -np.sin(tilt) * np.cos(turn), np.cos(tilt)])
    chains = [path for path, _ in chains_of_edges(model.edges_by_mark, np.ones(len(model.edges_by_mark), np.int32))]
    extent = float(np.ptp(model.points, axis=0).max())
    fit = [path for path in chains if path[0] != path[-1] and 0.3 < _length(model.points[path]) / extent < 0.6]
    return sorted(fit, key=lambda path: -float((model.points[path] @ towards).mean()))[:2]


def _length(line: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def _points_on(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Those of the points that lie on a line."""
    begin, along = line[:-1], np.diff(line, axis=0)
    share = np.clip(np.einsum("pij,ij->pi", points[:, None] - begin, along) / (along**2).sum(axis=1), 0, 1)
    away = np.linalg.norm(points[:, None] - begin - share[:, :, None] * along, axis=2).min(axis=1)
    return points[away < 1e-4 * _length(line)]


def _around_and_up(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors at the points of a surface of about rotational shape: around the axis, and up along the surface."""
    normals = np.zeros_like(model.points)
    for face in model.faces:
        a, b, c = model.points[list(face[:3])]
        normals[list(face)] += np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    around = np.stack([-model.points[:, 1], model.points[:, 0], np.zeros(len(model.points))], axis=1)
    around -= (around * normals).sum(axis=1, keepdims=True) * normals
    around /= np.linalg.norm(around, axis=1, keepdims=True)
    return around, np.cross(normals, around)


def _edges(faces: object) -> np.ndarray:
    pairs = [(a, b) for face in faces for a, b in zip(face, [*face[1:], face[0]], strict=True)]
    return np.unique(np.sort(np.array(pairs, int), axis=1), axis=0)


def _border(faces: list[tuple[int, ...]], inside: np.ndarray) -> np.ndarray:
    """Edges between faces inside and faces outside."""
    ours, others = (
        _edges([f for f, i in zip(faces, inside, strict=True) if i]),
        _edges([f for f, i in zip(faces, inside, strict=True) if not i]),
    )
    common = set(map(tuple, ours.tolist())) & set(map(tuple, others.tolist()))
    return np.array(sorted(common), int)


def _share(values: np.ndarray) -> np.ndarray:
    return (values - values.min()) / max(float(np.ptp(values)), 1e-12)


main()
