"""What a sweep asks for besides a number of quads: random fields, sizes and features, the same for a model every time.

The values are hostile on purpose: fields without any smoothness, sizes that jump, features that end anywhere.
"""

from __future__ import annotations

import zlib
from pathlib import Path

import numpy as np

from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.mesh_arrays import FloatArray, IntArray, Polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.strokes import vertex_normals

VARIANTS = ("default", "field", "sizes", "features")
REGIONS = 20  # of sizes
WALKS, LONGEST_WALK = 40, 30  # features: chains of edges


def arguments_of(variant: str, source: Path, folder: Path) -> tuple[str, ...]:
    """The command line's, whose files are made in `folder`; none for "default" and where the model has nothing to vary."""
    if variant == "default":
        return ()
    try:
        vertices, polygons = read_mesh(source)
    except MeshFileError:
        return ()  # the run says why
    if not len(vertices) or not len(polygons.vertices):
        return ()
    random = np.random.default_rng([zlib.crc32(source.stem.encode()), VARIANTS.index(variant)])
    path = folder / f"{source.stem}.{variant}.txt"
    if variant == "field":
        np.savetxt(path, random_crosses(vertices, polygons, random).reshape(-1, 6), fmt="%.9g")
        return ("--frames", str(path))
    if variant == "sizes":
        np.savetxt(path, random_density(vertices, random), fmt="%.9g")
        return ("--density", str(path))
    edges = random_walks(polygons, len(vertices), random)
    if not len(edges):
        return ()
    np.savetxt(path, edges, fmt="%d")
    return ("--features", str(path))


def random_crosses(vertices: FloatArray, polygons: Polygons, random: np.random.Generator) -> FloatArray:
    """(n, 2, 3) orthonormal tangents, turned by any angle at every vertex."""
    with np.errstate(all="ignore"):
        normals = vertex_normals(np.nan_to_num(vertices, posinf=0, neginf=0), _in_range(polygons, len(vertices)))
    normals = np.nan_to_num(normals)
    normals[np.linalg.norm(normals, axis=1) < 0.5] = (0, 0, 1)
    first = np.cross(normals, random.normal(size=normals.shape))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normals, first)], axis=1)


def random_density(vertices: FloatArray, random: np.random.Generator) -> FloatArray:
    """(n,) a number for each region about a random vertex; edges between 1 / sqrt(10) and sqrt(10) of the usual length."""
    points = np.nan_to_num(vertices, posinf=0, neginf=0)
    seeds = points[random.integers(len(points), size=REGIONS)]
    values = 10 ** random.uniform(-0.5, 0.5, REGIONS)
    distance = np.stack([np.linalg.norm(points - seed, axis=1) for seed in seeds])
    density: FloatArray = values[distance.argmin(axis=0)]
    return density


def random_walks(polygons: Polygons, count: int, random: np.random.Generator) -> IntArray:
    """(k, 2) edges of chains that go along edges as they come, between vertices that there are: a mesh with others is to be
    refused for them, not for a wish."""
    last = np.cumsum(polygons.sizes) - 1
    corners = polygons.vertices
    following = np.append(corners[1:], 0)
    following[last] = corners[last - polygons.sizes + 1]
    ways: dict[int, list[int]] = {}
    for a, b in zip(corners.tolist(), following.tolist(), strict=True):
        if a != b and min(a, b) >= 0 and max(a, b) < count:
            ways.setdefault(a, []).append(b)
            ways.setdefault(b, []).append(a)
    edges = []
    starts = list(ways)
    for _ in range(WALKS if starts else 0):
        vertex = starts[random.integers(len(starts))]
        for _ in range(random.integers(1, LONGEST_WALK + 1)):
            step = ways[vertex][random.integers(len(ways[vertex]))]
            edges.append((vertex, step))
            vertex = step
    return np.unique(np.sort(np.array(edges, np.int32).reshape(-1, 2), axis=1), axis=0)


def _in_range(polygons: Polygons, count: int) -> Polygons:
    return Polygons(polygons.sizes, np.clip(polygons.vertices, 0, count - 1))
