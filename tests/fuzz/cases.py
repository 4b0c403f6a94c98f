"""A case: a mesh and what is asked of it. Made from a number, kept in a folder."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fuzz.frames import random_frames
from fuzz.parallel_chains import with_parallel_chains
from hybrid_quad.core.mesh_io import read_mesh
from support import surfaces

Faces = list[list[int]]
Mesh = tuple[np.ndarray, Faces]


@dataclass(frozen=True)
class Case:
    """Arguments of ``hybrid_quad.remesh``; options as JSON can hold them."""

    vertices: np.ndarray
    faces: Faces
    options: dict[str, Any]

    def save(self, folder: Path) -> None:
        """Writes ``mesh.obj`` and ``options.json``."""
        folder.mkdir(parents=True, exist_ok=True)
        lines = ["v {!r} {!r} {!r}".format(*row) for row in self.vertices.tolist()]
        lines += ["f " + " ".join(str(v + 1) for v in face) for face in self.faces]
        (folder / "mesh.obj").write_text("\n".join(lines) + "\n")
        (folder / "options.json").write_text(json.dumps(self.options) + "\n")


def load_case(folder: Path) -> Case:
    """What `Case.save` wrote."""
    vertices, polygons = read_mesh(folder / "mesh.obj")
    faces = [part.tolist() for part in np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])]
    return Case(vertices, faces, json.loads((folder / "options.json").read_text()))


def make_case(seed: int) -> Case:
    """The same case for the same number, whatever was made before."""
    random = np.random.default_rng(seed)
    mesh = _pick(random, SURFACES)(random)
    for damage in DAMAGES:
        if random.random() < 0.2:
            mesh = damage(mesh, random)
    vertices, faces = mesh
    # What came later draws from numbers of its own: most cases stay what their seeds made before.
    later = np.random.default_rng([seed, 1])
    features: list[list[int]] = []
    if later.random() < 0.15:
        vertices, faces, features = with_parallel_chains(vertices, faces, later)
    options = _options(vertices, faces, random)
    if features:
        options["sharp_edges"] = options.get("sharp_edges", []) + features
    if later.random() < 0.25:
        options["threads"] = 2
    if random.random() < 0.2:
        vertices = vertices * 10.0 ** random.integers(-12, 7) + random.choice([0.0, 0.0, 1e3]) * random.normal(size=3)
    return Case(np.asarray(vertices, float), faces, options)


def _pick(random: np.random.Generator, choices: list[Any]) -> Any:
    return choices[random.integers(len(choices))]


def _as_lists(mesh: tuple[np.ndarray, Any]) -> Mesh:
    return np.asarray(mesh[0], float), [[int(v) for v in face] for face in mesh[1]]


# Surfaces


def _torus(random: np.random.Generator) -> Mesh:
    around, across = random.integers(3, 40), random.integers(3, 24)
    return _as_lists(surfaces.torus(int(around), int(across), float(random.uniform(0.02, 0.95))))


def _sphere(random: np.random.Generator) -> Mesh:
    return _as_lists(surfaces.sphere(int(random.integers(1, 14))))


def _box(random: np.random.Generator) -> Mesh:
    return _as_lists(surfaces.box(int(random.integers(1, 10)), tuple(10.0 ** random.uniform(-2, 0, 3))))


def _open_surface(random: np.random.Generator) -> Mesh:
    n, m = (int(x) for x in random.integers(1, 25, 2))
    made = [
        lambda: surfaces.grid(n, m, 1.0, float(10.0 ** random.uniform(-2, 0))),
        lambda: surfaces.wavy_grid(n),
        lambda: surfaces.annulus(n + 3, m),
        lambda: surfaces.cylinder(n + 3, m),
        lambda: surfaces.moebius(2 * n + 3, m),
        surfaces.mixed_polygons,
    ]
    return _as_lists(_pick(random, made)())


def _voxels(random: np.random.Generator) -> Mesh:
    """Border of a random set of cells: any genus, cavities, edges of four faces, vertices of two fans."""
    shape = random.integers(1, 6, 3)
    cells = np.pad(random.random(shape) < random.uniform(0.3, 0.95), 1)
    number: dict[tuple[int, ...], int] = {}
    faces = []
    for cell in np.argwhere(cells):
        for axis in range(3):
            for side in (-1, 1):
                beside = cell.copy()
                beside[axis] += side
                if cells[tuple(beside)]:
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
                face = []
                for a, b in ring if side > 0 else ring[::-1]:
                    corner = cell.copy()
                    corner[axis] += side > 0
                    corner[u] += a
                    corner[v] += b
                    face.append(number.setdefault(tuple(int(x) for x in corner), len(number)))
                faces.append(face)
    if not faces:
        return _as_lists(surfaces.sphere(2))
    vertices = np.array(list(number), float)
    if random.random() < 0.5:  # rounder
        vertices = _smoothed(vertices, faces)
    return vertices, faces


def _smoothed(vertices: np.ndarray, faces: Faces) -> np.ndarray:
    for _ in range(3):
        total, count = np.zeros_like(vertices), np.zeros((len(vertices), 1))
        for face in faces:
            total[face] += vertices[face].mean(axis=0)
            count[face] += 1
        vertices = total / np.maximum(count, 1)
    return vertices


def _several(random: np.random.Generator) -> Mesh:
    parts = [_pick(random, SURFACES[:-1])(random) for _ in range(random.integers(2, 5))]
    vertices, faces, count = [], [], 0
    for points, polygons in parts:
        vertices.append(points * 10.0 ** random.uniform(-2, 0) + random.normal(size=3) * random.choice([0.1, 3.0]))
        faces += [[v + count for v in face] for face in polygons]
        count += len(points)
    return np.concatenate(vertices), faces


SURFACES: list[Callable[[np.random.Generator], Mesh]] = [
    _torus,
    _sphere,
    _box,
    _open_surface,
    _voxels,
    _voxels,
    _several,
]


# Damages


def _noise(mesh: Mesh, random: np.random.Generator) -> Mesh:
    size = np.ptp(mesh[0], axis=0).max()
    return mesh[0] + size * 10.0 ** random.uniform(-6, -1) * random.normal(size=mesh[0].shape), mesh[1]


def _holes(mesh: Mesh, random: np.random.Generator) -> Mesh:
    keep = random.random(len(mesh[1])) > random.uniform(0, 0.2)
    faces = [face for face, is_kept in zip(mesh[1], keep, strict=True) if is_kept]
    return mesh[0], faces or mesh[1]


def _slivers(mesh: Mesh, random: np.random.Generator) -> Mesh:
    """Cuts corners off faces, as thin as a millionth of them."""
    vertices, faces = list(mesh[0]), [list(face) for face in mesh[1]]
    share = random.uniform(0, 0.2)
    for face in [face for face in faces if random.random() < share]:
        a, b, c = face[0], face[1], face[2]
        near, inside = 10.0 ** random.uniform(-6, 0), random.random()
        vertices.append(
            vertices[a] + near * (inside * (vertices[b] - vertices[a]) + (1 - inside) * (vertices[c] - vertices[a])) / 2
        )
        new = len(vertices) - 1
        faces.remove(face)
        faces += [[face[i], face[(i + 1) % len(face)], new] for i in range(len(face))]
    return np.array(vertices), faces


def _squash(mesh: Mesh, random: np.random.Generator) -> Mesh:
    return mesh[0] * 10.0 ** random.uniform(-4, 0, 3), mesh[1]


def _dust(mesh: Mesh, random: np.random.Generator) -> Mesh:
    vertices, faces = [mesh[0]], list(mesh[1])
    size, count = np.ptp(mesh[0], axis=0).max(), len(mesh[0])
    for _ in range(random.integers(1, 8)):
        corner = mesh[0][random.integers(len(mesh[0]))] + size * random.normal(size=3) * random.choice([0.001, 0.5])
        vertices.append(corner + 10.0 ** random.uniform(-5, -1) * size * random.normal(size=(4, 3)))
        faces += [[v + count for v in face] for face in ([0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3])]
        count += 4
    return np.concatenate(vertices), faces


def _flips(mesh: Mesh, random: np.random.Generator) -> Mesh:
    share = random.uniform(0, 0.5)
    return mesh[0], [face[::-1] if random.random() < share else face for face in mesh[1]]


def _duplicates(mesh: Mesh, random: np.random.Generator) -> Mesh:
    more = [mesh[1][random.integers(len(mesh[1]))] for _ in range(random.integers(1, 10))]
    return mesh[0], mesh[1] + [face[::-1] if random.random() < 0.5 else list(face) for face in more]


def _pinches(mesh: Mesh, random: np.random.Generator) -> Mesh:
    """One index for pairs of vertices, wherever they are; sometimes for the same place."""
    target = np.arange(len(mesh[0]))
    for _ in range(random.integers(1, 4)):
        a, b = random.integers(len(mesh[0]), size=2)
        target[a] = b
    return mesh[0], [[int(target[v]) for v in face] for face in mesh[1]]


def _fins(mesh: Mesh, random: np.random.Generator) -> Mesh:
    vertices, faces = list(mesh[0]), list(mesh[1])
    for _ in range(random.integers(1, 6)):
        face = mesh[1][random.integers(len(mesh[1]))]
        vertices.append(mesh[0][face[0]] + np.ptp(mesh[0], axis=0).max() * 0.2 * random.normal(size=3))
        faces.append([face[0], face[1], len(vertices) - 1])
    return np.array(vertices), faces


def _unwelded(mesh: Mesh, random: np.random.Generator) -> Mesh:
    share = random.choice([0.1, 1.0])
    vertices, faces = list(mesh[0]), []
    for face in mesh[1]:
        if random.random() < share:
            vertices += [mesh[0][v] for v in face]
            face = list(range(len(vertices) - len(face), len(vertices)))
        faces.append(face)
    return np.array(vertices), faces


def _shuffled(mesh: Mesh, random: np.random.Generator) -> Mesh:
    order = random.permutation(len(mesh[0]))
    place = np.argsort(order)
    faces = [[int(place[v]) for v in mesh[1][i]] for i in random.permutation(len(mesh[1]))]
    return mesh[0][order], faces


DAMAGES = [_noise, _holes, _slivers, _squash, _dust, _flips, _duplicates, _pinches, _fins, _unwelded, _shuffled]


# Wishes


def _options(vertices: np.ndarray, faces: Faces, random: np.random.Generator) -> dict[str, Any]:
    options: dict[str, Any] = {"quads": int(10.0 ** random.uniform(0.5, 3.2))}
    options["sharp_angle"] = _pick(random, [40.0, None, float(random.uniform(1, 120))])

    def maybe(name: str, value: Callable[[], Any], chance: float = 0.15) -> None:
        if random.random() < chance:
            options[name] = value()

    maybe("sharp_edges", lambda: _random_walks(faces, random))
    maybe("density", lambda: (10.0 ** random.uniform(-1, 1, len(vertices))).tolist())
    maybe("frames", lambda: random_frames(vertices, faces, random).tolist())
    maybe("guides", lambda: random.normal(size=(len(vertices), 3)).tolist())
    maybe("curve_counts", lambda: _counted_edges(faces, random))
    maybe("strokes", lambda: _strokes(vertices, random))
    maybe("field_smoothness", lambda: float(random.uniform(0, 1)))
    maybe("anisotropy", lambda: float(random.uniform(1, 10)))
    maybe("narrow_quads", lambda: 1)
    maybe("fit_limit_surface", lambda: True, 0.1)
    maybe("size_fidelity", lambda: float(random.uniform(0, 1)))
    maybe("adaptivity", lambda: float(random.uniform(0, 1)))
    maybe("symmetry", lambda: _pick(random, ["x", "yz", "xyz", "auto"]), 0.08)
    return options


def _random_walks(faces: Faces, random: np.random.Generator) -> list[list[int]]:
    """Edges of chains that turn as they like, and so lie beside each other, touch and end anywhere."""
    ways: dict[int, list[int]] = {}
    for face in faces:
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            if a != b:
                ways.setdefault(a, []).append(b)
                ways.setdefault(b, []).append(a)
    edges = set()
    starts = list(ways)
    for _ in range(random.integers(1, 12) if starts else 0):
        vertex = starts[random.integers(len(starts))]
        for _ in range(random.integers(1, 15)):
            step = ways[vertex][random.integers(len(ways[vertex]))]
            edges.add((min(vertex, step), max(vertex, step)))
            vertex = step
    return [list(edge) for edge in sorted(edges)]


def _counted_edges(faces: Faces, random: np.random.Generator) -> list[Any]:
    face = faces[random.integers(len(faces))]
    return [[[face[0], face[1]], int(random.integers(1, 30))]] if face[0] != face[1] else []


def _strokes(vertices: np.ndarray, random: np.random.Generator) -> list[Any]:
    low, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
    strokes = []
    for _ in range(random.integers(1, 4)):
        steps = np.cumsum(0.15 * random.normal(size=(random.integers(2, 12), 3)), axis=0)
        points = low + size * (random.random(3) + steps)
        strokes.append([points.tolist(), float(random.uniform(0, 1)), _pick(random, ["direction", "loop", "ring"])])
    return strokes
