"""Makes the Blender files of this folder.

    blender -b --factory-startup --python-exit-code 1 -P blend_samples/build_samples.py -- \\
        --fandisk data/fandisk.obj --spot spot/spot_triangulated.obj

The two mesh files are those of the collection that README.md names; the other two models are made here. Use the oldest
Blender that is supported (3.4), so that every later one can read the files.
"""

from __future__ import annotations

import argparse
import math
import shutil
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "addon"))

import hybrid_quad  # noqa: E402
from hybrid_quad.core.edge_mark_values import SHARP  # noqa: E402
from hybrid_quad.core.mesh_arrays import as_polygons  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402
from hybrid_quad.core.transfer.edges import add_sharp_by_angle  # noqa: E402

MARK_ANGLE = math.radians(40)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--fandisk", required=True)
    parser.add_argument("--spot", required=True)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    hybrid_quad.register()
    try:
        make_cad_part(arguments.fandisk)
        make_smooth_model(arguments.spot)
        make_open_surface()
        make_sculpted_head()
    finally:
        hybrid_quad.unregister()


def make_cad_part(path: str) -> None:
    """Fandisk, with its creases marked sharp: what is kept follows from the marks, not from an angle."""
    obj = _object_of_file("Fandisk", path)
    mesh = obj.data
    points = np.array([tuple(v.co) for v in mesh.vertices], float)
    edges = np.array([tuple(e.vertices) for e in mesh.edges], np.int32)
    polygons = as_polygons([tuple(p.vertices) for p in mesh.polygons])
    marks = add_sharp_by_angle(np.zeros(len(edges), np.uint16), points, polygons, edges, MARK_ANGLE)
    mesh.edges.foreach_set("use_edge_sharp", (marks & SHARP) != 0)
    _shade_smooth(mesh)
    obj.hybrid_quad.quads = 2000
    obj.hybrid_quad.use_sharp_angle = False
    _save("cad_part", obj)


def make_smooth_model(path: str) -> None:
    """Spot the cow: closed, smooth, no feature."""
    obj = _object_of_file("Spot", path)
    obj.rotation_euler = (math.radians(90), 0, math.radians(175))
    _shade_smooth(obj.data)
    obj.hybrid_quad.quads = 3000
    obj.hybrid_quad.use_sharp_angle = False
    _save("smooth_model", obj)


def make_open_surface() -> None:
    """A tent roof with a round opening and a wavy rim: two boundary loops."""
    rings, spokes = 28, 112
    points = []
    for ring in range(rings + 1):
        share = ring / rings
        for spoke in range(spokes):
            # Every other ring is turned by half a step, so that the triangles are near to equilateral.
            angle = 2 * math.pi * (spoke + 0.5 * (ring % 2)) / spokes
            radius = 0.5 + share * (1.5 + 0.16 * math.cos(6 * angle))
            height = 1.1 * (1 - share) ** 1.8 + 0.16 * share**2 * math.cos(6 * angle)
            points.append((radius * math.cos(angle), radius * math.sin(angle), height))
    faces = []
    for ring in range(rings):
        for spoke in range(spokes):
            inner, inner_next = ring * spokes + spoke, ring * spokes + (spoke + 1) % spokes
            outer, outer_next = inner + spokes, inner_next + spokes
            if ring % 2 == 0:
                faces += [(inner, outer, inner_next), (inner_next, outer, outer_next)]
            else:
                faces += [(inner, outer, outer_next), (inner, outer_next, inner_next)]
    obj = _object_of_arrays("Tent Roof", points, faces)
    _shade_smooth(obj.data)
    obj.hybrid_quad.quads = 1500
    obj.hybrid_quad.use_sharp_angle = False
    _save("open_surface", obj)


def make_sculpted_head() -> None:
    """Blender's monkey, made one closed skin and worked over with noise, as a sculptor's mesh of small triangles."""
    _clear()
    bpy.ops.mesh.primitive_monkey_add(size=2.0)
    obj = bpy.context.object
    obj.name = obj.data.name = "Sculpted Head"
    skin = obj.modifiers.new("Skin", "SUBSURF")
    skin.levels = 2
    solid = obj.modifiers.new("Solid", "SOLIDIFY")
    solid.thickness = 0.09
    voxels = obj.modifiers.new("One Piece", "REMESH")
    voxels.mode, voxels.voxel_size = "VOXEL", 0.032
    soften = obj.modifiers.new("Soften", "SMOOTH")
    soften.iterations = 12
    _displace(obj, "Lumps", size=0.35, strength=0.07)
    _displace(obj, "Pores", size=0.09, strength=0.014)
    triangles = obj.modifiers.new("Triangles", "TRIANGULATE")
    triangles.quad_method = "SHORTEST_DIAGONAL"
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(evaluated)
    obj.modifiers.clear()
    obj.data = mesh
    mesh.name = obj.name
    _keep_largest_shell(mesh)
    for texture in list(bpy.data.textures):
        bpy.data.textures.remove(texture)
    obj.rotation_euler = (math.radians(-8), 0, math.radians(12))
    _shade_smooth(mesh)
    obj.hybrid_quad.quads = 4000
    obj.hybrid_quad.use_sharp_angle = False
    _save("sculpted_head", obj)


def _displace(obj: bpy.types.Object, name: str, size: float, strength: float) -> None:
    texture = bpy.data.textures.new(name, "CLOUDS")
    texture.noise_scale = size
    modifier = obj.modifiers.new(name, "DISPLACE")
    modifier.texture, modifier.strength = texture, strength


def _keep_largest_shell(mesh: bpy.types.Mesh) -> None:
    """Drops what lies loose inside, such as the inner side of a hollow head."""
    import bmesh

    work = bmesh.new()
    work.from_mesh(mesh)
    left, shells = set(work.verts), []
    while left:
        shell, front = set(), [left.pop()]
        while front:
            vertex = front.pop()
            shell.add(vertex)
            for edge in vertex.link_edges:
                other = edge.other_vert(vertex)
                if other in left:
                    left.remove(other)
                    front.append(other)
        shells.append(shell)
    extent = [max(v.co.length for v in shell) for shell in shells]
    kept = shells[extent.index(max(extent))]
    bmesh.ops.delete(work, geom=[v for v in work.verts if v not in kept], context="VERTS")
    work.to_mesh(mesh)
    work.free()


def _object_of_file(name: str, path: str) -> bpy.types.Object:
    vertices, polygons = read_mesh(path)
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    return _object_of_arrays(name, vertices, faces)


def _object_of_arrays(name: str, points, faces) -> bpy.types.Object:
    _clear()
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, p)) for p in points], [], [tuple(map(int, f)) for f in faces])
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _clear() -> None:
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    for mesh in list(bpy.data.meshes):
        bpy.data.meshes.remove(mesh)


def _shade_smooth(mesh: bpy.types.Mesh) -> None:
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = math.pi
    mesh.update()


def _save(name: str, obj: bpy.types.Object) -> None:
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.data.orphans_purge(do_local_ids=True, do_linked_ids=True, do_recursive=True)
    bpy.context.preferences.filepaths.save_version = 0
    path = HERE / f"{name}.blend"
    # A Blender file holds the path it was saved to; that is nobody's business, so it is saved elsewhere and moved.
    neutral = Path(tempfile.gettempdir()) / path.name
    bpy.ops.wm.save_as_mainfile(filepath=str(neutral), compress=True, copy=True)
    shutil.move(neutral, path)
    print(f"{path.name}: {len(obj.data.polygons)} faces, {path.stat().st_size // 1024} KiB")


main()
