"""Makes the picture of docs/transfer.md: a model with a grid on its UV map, its quads, and both in a pose.

blender -b --factory-startup --python-exit-code 1 -P docs/pictures/transfer.py -- [OUT.png]
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from stage import LINES, Stage, save_side_by_side  # noqa: E402

import hybrid_quad  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402

SIZE, SAMPLES, QUADS = 450, 24, 2000


def main() -> None:
    hybrid_quad.register()
    source = _add_spot()
    rig = _add_rig(source)
    source.hybrid_quad.quads = QUADS
    source.hybrid_quad.use_uv_borders = True
    bpy.ops.object.hybrid_quad_remesh()
    result = bpy.context.object
    source.hide_set(False)
    stage = Stage(_seen(source)[0], SIZE, SAMPLES, (75.0, 60.0))
    folder, paths = Path(tempfile.mkdtemp()), []
    for turn in (0.0, -0.7):
        rig.pose.bones["Head"].rotation_mode = "XYZ"
        rig.pose.bones["Head"].rotation_euler = (0.0, turn, 0.0)
        bpy.context.view_layer.update()
        for obj in (source, result):
            stage.clear()
            points, edges = _seen(obj)
            stage.add_object(_picture_of(obj))
            if obj == result:
                stage.add_wires(points, edges, LINES, 0.0012)
            paths.append(stage.render(folder / f"{len(paths)}.png"))
    out = Path(sys.argv[-1]) if "--" in sys.argv else ROOT / "docs" / "images" / "transfer.png"
    save_side_by_side(paths, out)
    hybrid_quad.unregister()


def _add_spot() -> bpy.types.Object:
    """The cow, standing, unwrapped, with a colored grid."""
    points, polygons = read_mesh(ROOT / "tests" / "data" / "meshes" / "c3d_spot_triangulated.obj")
    points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)  # upright
    mesh = bpy.data.meshes.new("Spot")
    mesh.from_pydata(points.tolist(), [], polygons.vertices.reshape(-1, 3).tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    obj = bpy.data.objects.new("Spot", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=1.15, island_margin=0.01)
    bpy.ops.object.mode_set(mode="OBJECT")
    image = bpy.data.images.new("Grid", 1024, 1024)
    image.generated_type = "COLOR_GRID"
    material = bpy.data.materials.new("Grid")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    mesh.materials.append(material)
    return obj


def _add_rig(obj: bpy.types.Object) -> bpy.types.Object:
    """A body that stays, and a head that turns."""
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, head, tail in (("Body", (0, -0.7, 0), (0, 0, 0)), ("Head", (0, 0.1, 0.2), (0, 0.2, 0.9))):
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
    bpy.ops.object.mode_set(mode="OBJECT")
    points = np.array([tuple(vertex.co) for vertex in obj.data.vertices])
    share = np.clip((points[:, 1] + points[:, 2] - 0.3) / 0.4, 0, 1)
    for name, weights in (("Head", share), ("Body", 1 - share)):
        group = obj.vertex_groups.new(name=name)
        for index in np.flatnonzero(weights).tolist():
            group.add([index], float(weights[index]), "REPLACE")
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    bpy.context.view_layer.objects.active = obj
    return rig


def _seen(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and edges of an object in its pose."""
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return (
        np.array([tuple(vertex.co) for vertex in mesh.vertices]),
        np.array([tuple(edge.vertices) for edge in mesh.edges]),
    )


def _picture_of(obj: bpy.types.Object) -> bpy.types.Object:
    """A copy of an object in its pose, which has no rig any more."""
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    return bpy.data.objects.new("Picture", mesh)


main()
