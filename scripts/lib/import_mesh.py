"""A Blender file with one object from a mesh file (.obj, .ply, .stl, .off).

    blender -b --factory-startup --python-exit-code 1 -P scripts/lib/import_mesh.py -- MESH OUT.blend NAME PACKAGES

PACKAGES: a folder with meshio, which reads .ply and .stl and is not part of Blender.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "addon"))

from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.mesh_io import read_mesh


def main() -> None:
    source, target, name, packages = sys.argv[sys.argv.index("--") + 1 :]
    sys.path.append(packages)  # behind Blender's own, whose numpy is to stay the one that is used
    try:
        vertices, polygons = read_mesh(source)
    except MeshFileError as error:
        sys.exit(f"error: {error}")
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    mesh = bpy.data.meshes.new(name)
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    mesh.from_pydata(vertices.tolist(), [], [face.tolist() for face in faces])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    bpy.ops.wm.save_as_mainfile(filepath=target, compress=True)


main()
