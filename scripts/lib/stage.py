"""A scene to draw surfaces, lines and balls in, and to take pictures of. Runs in Blender.

Importing it lets Python find the add-on: in addon/, or in the folder named by HQ_ADDON_PARENT.
"""

from __future__ import annotations

import math
import os
import struct
import sys
import time
import zlib
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Vector

sys.path.insert(0, os.environ.get("HQ_ADDON_PARENT", str(Path(__file__).resolve().parents[2] / "addon")))

SURFACE = (0.36, 0.50, 0.66)
INPUT = (0.56, 0.54, 0.50)
LINES = (0.03, 0.04, 0.06)
FEATURES = (0.80, 0.10, 0.08)
FEWER = (0.95, 0.42, 0.05)  # vertices with three quads
MORE = (0.05, 0.25, 0.85)  # with five and more
CREASE = math.radians(35)  # shaded as an edge from this angle on


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
    """One picture of several, in as few bytes as 32 shades of each primary colour allow."""
    parts = []
    for each in paths:
        image = bpy.data.images.load(str(each))
        width, height = image.size
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        parts.append(pixels.reshape(height, width, 4)[::-1, :, :3])
    tallest = max(part.shape[0] for part in parts)
    padded = [np.pad(part, ((0, tallest - part.shape[0]), (0, 0), (0, 0)), constant_values=1.0) for part in parts]
    shades = np.round(np.concatenate(padded, axis=1) * 31) / 31
    path.write_bytes(_png(np.round(255 * shades).astype(np.uint8)))


def _png(pixels: np.ndarray) -> bytes:
    """A picture of (height, width, 3) bytes."""
    height, width, _ = pixels.shape

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9))
        + chunk(b"IEND", b"")
    )


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
    view : (float, float)
        Degrees that the camera is tilted from looking down, and turned about the vertical.
    """

    def __init__(self, points: np.ndarray, size: int, samples: int, view: tuple[float, float] = (64.0, 32.0)) -> None:
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
        self._add_sun((math.radians(48), 0.0, math.radians(view[1] - 4)), 2.0)
        self._add_camera(points, view)

    def clear(self) -> None:
        for thing in self._things:
            bpy.data.objects.remove(thing)
        self._things.clear()

    def draw_input(
        self,
        points: np.ndarray,
        faces: list,
        edges: np.ndarray,
        marked: np.ndarray | None,
        width: float,
        colours: np.ndarray | None = None,
    ) -> None:
        """A surface alone on the stage, with its edges in thin lines `width` thick and marked ones in red."""
        self.clear()
        self.add_surface(points, faces, INPUT, colours)
        self.add_wires(points, edges, LINES, 0.5 * width)
        if marked is not None:
            self.add_wires(points, marked, FEATURES, 1.2 * width)

    def draw_quads(
        self, points: np.ndarray, quads: np.ndarray, edges: np.ndarray, marked: np.ndarray | None, width: float
    ) -> None:
        """Quads alone on the stage, with lines `width` thick along their edges, marked ones red."""
        self.clear()
        self.add_surface(points, list(quads), SURFACE)
        self.add_wires(points, edges, LINES, width)
        if marked is not None:
            self.add_wires(points, marked, FEATURES, 1.6 * width)

    def add_irregular_vertices(self, points: np.ndarray, quads: np.ndarray, radius: float) -> None:
        """Balls: orange where three quads meet, blue where five or more do."""
        fewer, more = irregular_vertices(len(points), quads)
        self.add_balls(points[fewer], FEWER, radius)
        self.add_balls(points[more], MORE, radius)

    def add_surface(self, points: np.ndarray, faces: list, colour: tuple, colours: np.ndarray | None = None) -> None:
        """Shaded smooth but for its creases; in one colour, or in one for each point."""
        mesh = self._add_mesh(points, [], faces, colour, roughness=0.55).data
        if colours is not None:
            rgba = np.concatenate([colours, np.ones((len(colours), 1))], axis=1).astype(np.float32)
            mesh.color_attributes.new("Demo", "FLOAT_COLOR", "POINT").data.foreach_set("color", rgba.ravel())
            tree = mesh.materials[0].node_tree
            painted = tree.nodes.new("ShaderNodeVertexColor")
            painted.layer_name = "Demo"
            tree.links.new(painted.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
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

    def add_object(self, obj: bpy.types.Object) -> None:
        """An object of one's own, with its materials."""
        self._scene.collection.objects.link(obj)
        self._things.append(obj)

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

    def _add_camera(self, points: np.ndarray, view: tuple[float, float]) -> None:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        camera.data.lens = 70
        camera.rotation_euler = Euler((math.radians(view[0]), 0.0, math.radians(view[1])))
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
