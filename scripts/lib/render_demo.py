"""Pictures of a remeshed object: input, frame field and result. Runs in Blender, on the file that batch.py wrote.

    blender -b RESULT.blend -P scripts/lib/render_demo.py -- --report R.json --out FOLDER [--size PIXELS] [--samples N]

Writes input.png, field.png, result.png, overview.png (the three side by side) and result.obj.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Vector

HERE = Path(__file__).resolve().parent
sys.path.insert(0, os.environ.get("HQ_ADDON_PARENT", str(HERE.parent.parent / "addon")))

import hybrid_quad  # noqa: E402
from hybrid_quad.blender import edge_marks  # noqa: E402
from hybrid_quad.blender.mesh_source import read_source  # noqa: E402
from hybrid_quad.blender.remesh_task import prepare_task  # noqa: E402
from hybrid_quad.core.mesh_io import write_mesh  # noqa: E402
from hybrid_quad.core.remesh import remesh_with_options  # noqa: E402
from hybrid_quad.core.snapshots import Snapshot  # noqa: E402

SURFACE = (0.36, 0.50, 0.66)
INPUT = (0.56, 0.54, 0.50)
LINES = (0.03, 0.04, 0.06)
FEATURES = (0.80, 0.10, 0.08)
FEWER = (0.95, 0.42, 0.05)  # vertices with three quads
MORE = (0.05, 0.25, 0.85)  # with five and more
CROSS = (0.02, 0.10, 0.20)
CREASE = math.radians(35)  # shaded as an edge from this angle on


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
    stage.clear()
    stage.add_surface(task.source.vertices, polygons, INPUT)
    stage.add_wires(task.source.vertices, task.source.edges, LINES, 0.5 * thin)
    stage.add_wires(task.source.vertices, task.marked_edges, FEATURES, 1.2 * thin)
    pictures = [stage.render(out / "input.png")]
    if field is not None:
        pictures.append(draw_field(stage, field, edge, out / "field.png"))
    stage.clear()
    stage.add_surface(quads.vertices, list(faces), SURFACE)
    sharp = (quads.marks & edge_marks.SHARP) != 0
    stage.add_wires(quads.vertices, quads.edges[~sharp], LINES, thin)
    stage.add_wires(quads.vertices, quads.edges[sharp], FEATURES, 1.2 * thin)
    fewer, more = irregular_vertices(len(quads.vertices), faces)
    stage.add_balls(quads.vertices[fewer], FEWER, 0.22 * edge)
    stage.add_balls(quads.vertices[more], MORE, 0.22 * edge)
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
    triangles = field.face_vertices.reshape(-1, 3)
    corners = field.points[triangles]
    middles = corners.mean(axis=1)
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    shown = spread(middles, 1.2 * edge)
    stage.clear()
    stage.add_surface(field.points, list(triangles), SURFACE)
    centre = middles[shown] + 0.03 * edge * normals[shown]
    for name in ("u direction", "v direction"):
        step = 0.5 * edge * unit(field.face_vectors[name][shown])
        ends = np.concatenate([centre - step, centre + step])
        pairs = np.stack([np.arange(len(shown)), np.arange(len(shown)) + len(shown)], axis=1)
        stage.add_wires(ends, pairs, CROSS, 0.05 * edge)
    stage.add_wires(field.points, field.lines, FEATURES, 0.05 * edge)
    index = field.vertex_values["cone index"]
    stage.add_balls(field.points[index > 0], FEWER, 0.22 * edge)
    stage.add_balls(field.points[index < 0], MORE, 0.22 * edge)
    return stage.render(path)


def spread(points: np.ndarray, distance: float) -> list[int]:
    """Indices of as many of the points as fit with no two closer than `distance`."""
    chosen: list[int] = []
    in_cell: dict[tuple[int, ...], list[int]] = {}
    for index, cell in enumerate(np.floor(points / distance).astype(int).tolist()):
        near = (
            other
            for offset in np.ndindex(3, 3, 3)
            for other in in_cell.get((cell[0] + offset[0] - 1, cell[1] + offset[1] - 1, cell[2] + offset[2] - 1), ())
        )
        if all(np.linalg.norm(points[other] - points[index]) >= distance for other in near):
            chosen.append(index)
            in_cell.setdefault(tuple(cell), []).append(index)
    return chosen


def irregular_vertices(vertex_count: int, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inner vertices with fewer, and with more, than four quads."""
    valence = np.bincount(faces.ravel(), minlength=vertex_count)
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    inner = np.ones(vertex_count, bool)
    inner[edges[uses == 1]] = False
    return np.flatnonzero(inner & (valence < 4)), np.flatnonzero(inner & (valence > 4))


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-30)


def save_side_by_side(paths: list[Path], path: Path) -> None:
    """One picture of several of the same height."""
    parts = []
    for each in paths:
        image = bpy.data.images.load(str(each))
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        parts.append(pixels.reshape(height, width, 4))
    whole = np.concatenate(parts, axis=1)
    image = bpy.data.images.new("overview", whole.shape[1], whole.shape[0])
    image.pixels.foreach_set(np.ascontiguousarray(whole).ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()


class Stage:
    """A scene with camera and light around some points, in which things are drawn and removed.

    Parameters
    ----------
    points : (n, 3) float
        What the camera has to see.
    size : int
        Width and height of the pictures in pixels.
    samples : int
        Of Cycles, for every pixel.
    """

    def __init__(self, points: np.ndarray, size: int, samples: int) -> None:
        self._scene = bpy.data.scenes.new("Demo")
        self._things: list[bpy.types.Object] = []
        render = self._scene.render
        render.engine = "CYCLES"
        render.resolution_x = render.resolution_y = size
        render.image_settings.file_format = "PNG"
        self._scene.cycles.samples = samples
        self._scene.cycles.use_denoising = False
        self._scene.cycles.max_bounces = 2
        self._scene.cycles.pixel_filter_type = "BLACKMAN_HARRIS"
        self._scene.view_settings.view_transform = "Standard"
        self._scene.world = bpy.data.worlds.new("Demo")
        self._scene.world.use_nodes = True
        self._light_the_background()
        self._add_sun((math.radians(48), 0.0, math.radians(28)), 2.0)
        self._add_camera(points)

    def clear(self) -> None:
        for thing in self._things:
            bpy.data.objects.remove(thing)
        self._things.clear()

    def add_surface(self, points: np.ndarray, faces: list, colour: tuple) -> None:
        """Shaded smooth but for its creases."""
        mesh = self._add_mesh(points, [], faces, colour, roughness=0.55).data
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        if hasattr(mesh, "use_auto_smooth"):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, CREASE
        else:  # from Blender 4.1 on
            mesh.set_sharp_from_angle(angle=CREASE)

    def add_wires(self, points: np.ndarray, edges: np.ndarray, colour: tuple, width: float) -> None:
        """Edges as square rods."""
        if not len(edges):
            return
        begin, end = points[edges[:, 0]], points[edges[:, 1]]
        along = unit(end - begin)
        helper = np.where(np.abs(along[:, 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
        side = unit(np.cross(along, helper))
        up = np.cross(along, side)
        ring = [width * (math.cos(a) * side + math.sin(a) * up) for a in np.arange(6) * math.pi / 3]
        rods = np.stack([p + offset for p in (begin, end) for offset in ring], axis=1)  # (k, 12, 3)
        faces = np.array([(i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6)])
        all_faces = (faces[None] + 12 * np.arange(len(edges))[:, None, None]).reshape(-1, 4)
        obj = self._add_mesh(rods.reshape(-1, 3), [], all_faces, colour, roughness=1.0)
        obj.visible_shadow = False

    def add_balls(self, centres: np.ndarray, colour: tuple, radius: float) -> None:
        if not len(centres):
            return
        rings, spokes = 8, 14
        angles = [(math.pi * (i + 0.5) / rings, 2 * math.pi * j / spokes) for i in range(rings) for j in range(spokes)]
        ball = np.array([(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)) for t, p in angles])
        faces = [
            (i * spokes + j, (i + 1) * spokes + j, (i + 1) * spokes + (j + 1) % spokes, i * spokes + (j + 1) % spokes)
            for i in range(rings - 1)
            for j in range(spokes)
        ]
        caps = [tuple(range(spokes)), tuple(range(rings * spokes - 1, (rings - 1) * spokes - 1, -1))]
        points = (centres[:, None] + radius * ball[None]).reshape(-1, 3)
        count = len(ball)
        all_faces = [tuple(v + n * count for v in face) for n in range(len(centres)) for face in faces + caps]
        obj = self._add_mesh(points, [], all_faces, colour, roughness=0.35)
        obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))

    def render(self, path: Path) -> Path:
        started = time.monotonic()
        self._scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True, scene=self._scene.name)
        print(f"{path} ({time.monotonic() - started:.0f} s)", flush=True)
        return path

    def _add_mesh(self, points, edges, faces, colour: tuple, roughness: float) -> bpy.types.Object:
        mesh = bpy.data.meshes.new("Demo")
        mesh.from_pydata(np.asarray(points).tolist(), edges, [tuple(map(int, face)) for face in faces])
        material = bpy.data.materials.new("Demo")
        material.use_nodes = True
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (*colour, 1.0)
        shader.inputs["Roughness"].default_value = roughness
        mesh.materials.append(material)
        obj = bpy.data.objects.new("Demo", mesh)
        self._scene.collection.objects.link(obj)
        self._things.append(obj)
        return obj

    def _light_the_background(self) -> None:
        """White behind the object, softer light from all around."""
        nodes, links = self._scene.world.node_tree.nodes, self._scene.world.node_tree.links
        nodes.clear()
        output, mix = nodes.new("ShaderNodeOutputWorld"), nodes.new("ShaderNodeMixShader")
        seen, light = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeBackground")
        seen.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        light.inputs["Color"].default_value = (0.9, 0.95, 1.0, 1.0)
        light.inputs["Strength"].default_value = 0.45
        links.new(nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"], mix.inputs[0])
        links.new(light.outputs[0], mix.inputs[1])
        links.new(seen.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], output.inputs[0])

    def _add_sun(self, rotation: tuple, strength: float) -> None:
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy, sun.data.angle = strength, math.radians(12)
        sun.rotation_euler = rotation
        self._scene.collection.objects.link(sun)

    def _add_camera(self, points: np.ndarray) -> None:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        camera.data.lens = 70
        camera.rotation_euler = Euler((math.radians(64), 0.0, math.radians(32)))
        self._scene.collection.objects.link(camera)
        self._scene.camera = camera
        camera.data.clip_start, camera.data.clip_end = 1e-4 * _extent(points), 1e3 * _extent(points)
        layer = self._scene.view_layers[0]
        layer.update()
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        around = middle + 1.06 * (points - middle)
        fitted = camera.camera_fit_coords(layer.depsgraph, around.ravel().tolist())
        camera.location = Vector(fitted[0])
        layer.update()
        # No empty stripes above and below a flat model.
        heights = [
            world_to_camera_view(self._scene, camera, Vector(point)).y for point in around[:: 1 + len(around) // 5000]
        ]
        render = self._scene.render
        render.use_border = render.use_crop_to_border = True
        render.border_min_y, render.border_max_y = max(0.0, min(heights) - 0.02), min(1.0, max(heights) + 0.02)


def _extent(points: np.ndarray) -> float:
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


main()
