#!/usr/bin/env python3
"""Writes the surface that a run makes of a dirty mesh, before it is remeshed: what a judge has to compare the result with.

    repaired.py IN OUT.obj

Vertices that the repair put in one place on purpose, one for each sheet, are moved apart a little (1e-8 of the diagonal),
since judges weld what coincides, and edges that have both ends in common get vertices in their middles, since a list of faces
cannot tell them apart. Exit status 1 where the surface is not what it was: where area is lost or made up.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from hybrid_quad.core.mesh_arrays import FloatArray, IntArray, Polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.remesh import remesh
from hybrid_quad.core.snapshots import Snapshot
from hybrid_quad.core.surface_points import fan_triangles

SPREAD = 1e-8  # of the diagonal
TOLERANCE = 0.01  # of the area: polygons that are not flat have no area of their own


class _Seen(Exception):
    """Ends the run as soon as the repaired mesh is there."""

    def __init__(self, snapshot: Snapshot) -> None:
        super().__init__("mesh")
        self.snapshot = snapshot


def repaired_mesh(vertices: FloatArray, polygons: Polygons) -> Snapshot:
    """The oriented manifold of triangles that a run starts from, with its boundary.

    Raises
    ------
    InputError
        If there is none.
    """

    def look(snapshot: Snapshot) -> None:
        if snapshot.stage == "mesh":
            raise _Seen(snapshot)

    try:
        remesh(vertices, polygons, on_snapshot=look)
    except _Seen as seen:
        return seen.snapshot
    raise AssertionError("a run has a first stage")


def with_edges_apart(mesh: Snapshot) -> tuple[FloatArray, list[list[int]]]:
    """Points and faces in which no two edges have the same two ends."""
    triangles = mesh.face_vertices.reshape(-1, 3)
    opposite = np.stack([mesh.face_values[f"opposite of side {side}"] for side in range(3)], axis=1).astype(int).ravel()
    own = np.arange(len(opposite))
    first = (opposite < 0) | (own < opposite)  # one side of each edge
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    _, pair, edges = np.unique(np.sort(ends[first], axis=1), axis=0, return_inverse=True, return_counts=True)
    shared = own[first][edges[pair.reshape(-1)] > 1]
    faces = [list(face) for face in triangles.tolist()]
    middle = np.full(len(opposite), -1)
    middle[shared] = len(mesh.points) + np.arange(len(shared))
    middle[opposite[shared[opposite[shared] >= 0]]] = middle[shared[opposite[shared] >= 0]]
    for side in sorted(np.flatnonzero(middle >= 0).tolist(), reverse=True):  # later sides of a face first
        faces[side // 3].insert(side % 3 + 1, int(middle[side]))
    return np.concatenate([mesh.points, mesh.points[ends[shared]].mean(axis=1)]), faces


def moved_apart(points: FloatArray) -> FloatArray:
    """Points of which no two are in one place."""
    _, inverse = np.unique(points, axis=0, return_inverse=True)
    inverse = inverse.reshape(-1)
    order = np.argsort(inverse, kind="stable")
    first = np.flatnonzero(np.diff(inverse[order], prepend=-1))
    rank = np.empty(len(points), int)
    rank[order] = np.arange(len(points)) - np.repeat(first, np.diff(np.append(first, len(points))))
    step = SPREAD * np.linalg.norm(np.ptp(points, axis=0))
    moved: FloatArray = points + step * rank[:, None] * np.array([1.0, 0.7, 0.4])
    return moved


def area_changed(vertices: FloatArray, polygons: Polygons, points: FloatArray, triangles: IntArray) -> bool:
    """Whether the repaired surface has another area than the input, duplicates counted once or twice."""
    used = np.unique(polygons.vertices)
    centre, size = points.mean(axis=0), np.ptp(points, axis=0).max()
    places = np.zeros(vertices.shape)
    places[used] = (vertices[used] - centre) / size
    _, welded = np.unique(places, axis=0, return_inverse=True)
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    once = {tuple(sorted(welded.reshape(-1)[face].tolist())): face for face in faces}.values()
    least = sum(_area_inside(places[face]) for face in once)
    most, found = _area(places, fan_triangles(polygons)), _area((points - centre) / size, triangles)
    return not (1 - TOLERANCE) * least <= found <= (1 + TOLERANCE) * most


def _area_inside(ring: FloatArray) -> float:
    """Of a flat polygon, concave or not."""
    arms = ring[1:] - ring[:1]
    return float(0.5 * np.linalg.norm(np.cross(arms[:-1], arms[1:]).sum(axis=0)))


def _area(points: FloatArray, triangles: IntArray) -> float:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def main() -> int:
    """Writes the file."""
    source, target = map(Path, sys.argv[1:])
    vertices, polygons = read_mesh(source)
    mesh = repaired_mesh(vertices, polygons)
    points, faces = with_edges_apart(mesh)
    with target.open("w") as file:
        np.savetxt(file, moved_apart(points), fmt="v %.17g %.17g %.17g")
        file.writelines("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)
    return int(area_changed(vertices, polygons, mesh.points, mesh.face_vertices.reshape(-1, 3)))


if __name__ == "__main__":
    sys.exit(main())
