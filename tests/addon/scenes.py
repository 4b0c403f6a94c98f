"""Small objects to test with, and questions about the results."""

from __future__ import annotations

import itertools

import bpy
import numpy as np


def add_object(name: str, vertices, faces) -> bpy.types.Object:
    """A mesh object in the scene, active and selected."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return activate(obj)


def activate(obj: bpy.types.Object) -> bpy.types.Object:
    bpy.context.view_layer.update()
    for other in bpy.context.view_layer.objects:
        other.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def add_cube(segments: int = 6, quads: int = 300) -> bpy.types.Object:
    """The cube [-1, 1]^3, each side a grid of squares."""
    points: dict[tuple[int, int, int], int] = {}
    faces = []

    def vertex(*key: int) -> int:
        return points.setdefault(key, len(points))

    for axis in range(3):
        for side in (0, segments):
            for i in range(segments):
                for j in range(segments):
                    corners = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        key = [0, 0, 0]
                        key[axis], key[(axis + 1) % 3], key[(axis + 2) % 3] = side, a, b
                        corners.append(vertex(*key))
                    faces.append(corners if side else corners[::-1])
    obj = add_object("Cube", 2.0 * np.array(list(points)) / segments - 1.0, faces)
    obj.hybrid_quad.quads = quads
    return obj


def add_sphere(quads: int = 400) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16)
    obj = bpy.context.object
    obj.name = "Sphere"
    obj.hybrid_quad.quads = quads
    return obj


def add_grid(cells: int = 12, quads: int = 200) -> bpy.types.Object:
    """The square [-1, 1]^2 in the plane z = 0: open, flat."""
    steps = np.linspace(-1.0, 1.0, cells + 1)
    points = [(x, y, 0.0) for y in steps for x in steps]
    faces = [
        (
            row * (cells + 1) + col,
            row * (cells + 1) + col + 1,
            (row + 1) * (cells + 1) + col + 1,
            (row + 1) * (cells + 1) + col,
        )
        for row in range(cells)
        for col in range(cells)
    ]
    obj = add_object("Grid", points, faces)
    obj.hybrid_quad.quads = quads
    return obj


def remesh() -> bpy.types.Object:
    """Runs the operator on the active object and returns the object with the result."""
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def points_of(obj: bpy.types.Object, in_world: bool = False) -> np.ndarray:
    points = np.array([tuple(v.co) for v in obj.data.vertices], float).reshape(-1, 3)
    if in_world:
        matrix = np.array(obj.matrix_world)
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
    return points


def faces_of(obj: bpy.types.Object) -> list[tuple[int, ...]]:
    return [tuple(polygon.vertices) for polygon in obj.data.polygons]


def assert_sound(obj: bpy.types.Object) -> None:
    """All quads, and nothing for Blender to repair."""
    assert {len(face) for face in faces_of(obj)} == {4}
    assert not obj.data.validate(verbose=True)


def sharp_edges_of(obj: bpy.types.Object) -> np.ndarray:
    """(k, 2) vertex pairs."""
    edges = [tuple(edge.vertices) for edge in obj.data.edges if edge.use_edge_sharp]
    return np.array(edges, int).reshape(-1, 2)


def signed_volume(points: np.ndarray, faces: list[tuple[int, ...]]) -> float:
    """Volume inside a closed surface; negative where it is wound inside out."""
    total = 0.0
    for face in faces:
        for second, third in itertools.pairwise(face[1:]):
            total += np.dot(points[face[0]], np.cross(points[second], points[third])) / 6.0
    return float(total)
