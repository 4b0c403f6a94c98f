"""A repaired copy of a mesh: ``object.hybrid_quad_repair``."""

from __future__ import annotations

import bpy
import numpy as np

from ..cli.messages import what_became_of
from ..core import native
from ..core.repair import Repaired, repair
from .mesh_source import MeshSource, read_source
from .operators import ActiveMeshOperator, describe_found, message_of


class OBJECT_OT_hybrid_quad_repair(ActiveMeshOperator):
    """Make a copy of the active object in which all is repaired that remeshing would repair. Its faces are triangles; the object itself stays as it is"""  # noqa: E501

    bl_idname = "object.hybrid_quad_repair"
    bl_label = "Repair a Copy"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not native.is_there():
            cls.poll_message_set("The compiled part is missing: install the zip for this Blender and system")
            return False
        return super().poll(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        try:
            source = read_source(obj, context.evaluated_depsgraph_get())
            found = repair(source.vertices, source.polygons)
            copy = _copy_with(obj, _mesh_of(obj, source, found))
        except Exception as error:
            self.report({"ERROR"}, message_of(error))
            return {"CANCELLED"}
        for defect in found.defects:
            row = defect.as_json()
            became = what_became_of(row).capitalize()
            self.report({"WARNING"} if defect.kept else {"INFO"}, f"{became}: {describe_found(row)}")
        lost = len(source.vertices) - len(np.unique(found.vertex_origins[found.vertex_origins >= 0]))
        self.report(
            {"INFO"}, f'"{copy.name}": {len(found.triangles):,} triangles; {lost:,} vertices are not used any more'
        )
        return {"FINISHED"}


def _mesh_of(obj: bpy.types.Object, source: MeshSource, found: Repaired) -> bpy.types.Mesh:
    """The repaired triangles in object space, with the materials and smoothness of the faces they were."""
    triangles = found.triangles[:, ::-1] if source.is_mirrored else found.triangles
    mesh = bpy.data.meshes.new(f"{obj.data.name} Repaired")
    mesh.from_pydata(source.to_object_space(found.vertices).tolist(), [], triangles.tolist())
    for material in obj.data.materials:
        mesh.materials.append(material)
    own = obj.data.polygons
    if len(own) == len(source.polygons.sizes):  # no modifier made others
        for name, dtype in (("material_index", np.int32), ("use_smooth", np.bool_)):
            values = np.empty(len(own), dtype)
            own.foreach_get(name, values)
            mesh.polygons.foreach_set(name, values[found.face_origins])
    mesh.update()
    return mesh


def _copy_with(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> bpy.types.Object:
    """A copy of the object beside it that has the mesh and no modifiers, active and selected; the object is hidden."""
    copy = obj.copy()
    copy.name = f"{obj.name} Repaired"
    copy.data = mesh
    copy.modifiers.clear()
    copy.hybrid_quad.last_check = copy.hybrid_quad.last_report = ""
    for collection in obj.users_collection:
        collection.objects.link(copy)
    context = bpy.context
    context.view_layer.update()
    if copy.name in context.view_layer.objects:
        for other in context.selected_objects:
            other.select_set(False)
        copy.select_set(True)
        context.view_layer.objects.active = copy
        obj.hide_set(True)
    return copy


CLASSES = (OBJECT_OT_hybrid_quad_repair,)
