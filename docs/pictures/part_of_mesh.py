"""Makes the picture of docs/part-of-a-mesh.md: a model with the faces of its head chosen, and the quads in their place.

blender -b --factory-startup --python-exit-code 1 -P docs/pictures/part_of_mesh.py -- [OUT.png]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from stage import INPUT, LINES, SURFACE, Stage, save_side_by_side  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402

SIZE, SAMPLES, QUADS = 620, 24, 900


def main() -> None:
    hybrid_quad.register()
    obj = _add_spot()
    chosen = _is_of_head(obj)
    obj.data.attributes.new("Head", "BOOLEAN", "FACE").data.foreach_set("value", chosen)
    settings = obj.hybrid_quad
    settings.part.region, settings.part.attribute, settings.part.odd_border = "ATTRIBUTE", "Head", "GROW"
    settings.part.use_border_length, settings.quads = False, QUADS
    bpy.ops.object.hybrid_quad_remesh()
    result = bpy.context.object
    points = np.array([tuple(vertex.co) for vertex in obj.data.vertices])
    stage, folder = (
        Stage(points[(points[:, 1] > 0.0) & (points[:, 2] > 0.1)], SIZE, SAMPLES, (78.0, 60.0)),
        Path(tempfile.mkdtemp()),
    )
    paths = []
    for each, is_part in ((obj, chosen), (result, _are_new(result))):
        stage.clear()
        _draw(stage, each.data, is_part)
        paths.append(stage.render(folder / f"{len(paths)}.png"))
    out = Path(sys.argv[-1]) if "--" in sys.argv else ROOT / "docs" / "images" / "part_of_mesh.png"
    save_side_by_side(paths, out)
    print(f"{int(chosen.sum())} triangles, {int(_are_new(result).sum())} quads")
    hybrid_quad.unregister()


def _add_spot() -> bpy.types.Object:
    points, polygons = read_mesh(ROOT / "tests" / "data" / "meshes" / "c3d_spot_triangulated.obj")
    points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)  # upright
    mesh = bpy.data.meshes.new("Spot")
    mesh.from_pydata(points.tolist(), [], polygons.vertices.reshape(-1, 3).tolist())
    obj = bpy.data.objects.new("Spot", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj


def _is_of_head(obj: bpy.types.Object) -> np.ndarray:
    middles = np.array([tuple(polygon.center) for polygon in obj.data.polygons])
    return middles @ np.array([0.0, 0.9, 0.44]) > 0.42


def _are_new(result: bpy.types.Object) -> np.ndarray:
    return np.array([polygon.loop_total == 4 for polygon in result.data.polygons])


def _draw(stage: Stage, mesh: bpy.types.Mesh, is_part: np.ndarray) -> None:
    points = np.array([tuple(vertex.co) for vertex in mesh.vertices])
    faces = [tuple(polygon.vertices) for polygon in mesh.polygons]
    for chosen, colour in ((True, SURFACE), (False, INPUT)):
        own = [face for face, is_of_part in zip(faces, is_part, strict=True) if is_of_part == chosen]
        stage.add_surface(points, own, colour)
    edges = np.array([tuple(edge.vertices) for edge in mesh.edges])
    stage.add_wires(points, edges, LINES, 0.0014)


main()
