"""QuadriFlow in Blender: blender -b --factory-startup -P quadriflow.py -- IN.obj QUADS OUT.obj [sharp].

Prints the wall and processor seconds of the operator alone, without Blender's start, reading and writing.
"""

from __future__ import annotations

import json
import sys
import time

import bpy


def main() -> None:
    """Remeshes one mesh."""
    source, quads, target, *flags = sys.argv[sys.argv.index("--") + 1 :]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=source)
    bpy.context.view_layer.objects.active = bpy.context.selected_objects[0]
    wall, cpu = time.perf_counter(), time.process_time()
    bpy.ops.object.quadriflow_remesh(
        mode="FACES", target_faces=int(quads), use_mesh_symmetry=False, use_preserve_sharp="sharp" in flags
    )
    print(json.dumps({"call_seconds": time.perf_counter() - wall, "call_cpu_seconds": time.process_time() - cpu}))
    bpy.ops.wm.obj_export(filepath=target, export_materials=False)


main()
