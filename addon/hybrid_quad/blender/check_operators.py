"""What is wrong with a mesh, and where: ``object.hybrid_quad_check`` and ``object.hybrid_quad_select_defect``."""

from __future__ import annotations

import json
from typing import Any

import bmesh
import bpy
import numpy as np

from ..core import defect_names
from ..core.check import Defect, check
from ..core.edge_borders import edge_keys
from .mesh_source import MeshSource, read_source
from .operators import ActiveMeshOperator, message_of

_SELECT_MODES = {"vertex": (True, False, False), "edge": (False, True, False), "face": (False, False, True)}


class _CheckOperator(ActiveMeshOperator):
    """Looks for defects in the active object's mesh as it is now."""

    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            source = read_source(context.object, context.evaluated_depsgraph_get())
            ended = self._act(context.object, source, check(source.vertices, source.polygons, edges=source.edges))
        except Exception as error:
            self.report({"ERROR"}, message_of(error))
            return {"CANCELLED"}
        if context.area is not None:  # from a menu, nothing else has the list drawn anew
            context.area.tag_redraw()
        return ended

    def _act(self, obj: bpy.types.Object, source: MeshSource, defects: list[Defect]) -> set[str]:
        raise NotImplementedError


class OBJECT_OT_hybrid_quad_check(_CheckOperator):
    """List what is wrong with the mesh, and what remeshing would do about it"""

    bl_idname = "object.hybrid_quad_check"
    bl_label = "Check Mesh"

    def _act(self, obj: bpy.types.Object, source: MeshSource, defects: list[Defect]) -> set[str]:
        rows = [{**defect.as_json(), "elements": len(defect)} for defect in defects]
        obj.hybrid_quad.last_check = json.dumps(rows)
        for row in rows:
            self.report({"INFO"} if row["repairable"] else {"WARNING"}, describe_row(row))
        if not rows:
            self.report({"INFO"}, f'Nothing is wrong with "{obj.name}"')
        return {"FINISHED"}


class OBJECT_OT_hybrid_quad_select_defect(_CheckOperator):
    """Select the elements that have this defect, in Edit Mode"""

    bl_idname = "object.hybrid_quad_select_defect"
    bl_label = "Select Defect"

    code: bpy.props.StringProperty(name="Defect", description="Which defect, as the list of defects names it")

    def _act(self, obj: bpy.types.Object, source: MeshSource, defects: list[Defect]) -> set[str]:
        found = next((defect for defect in defects if defect.code == self.code and len(defect)), None)
        if found is None:
            self.report({"WARNING"}, f"There are no {defect_names.in_words(self.code)} (any more)")
            return {"CANCELLED"}
        mesh = obj.data
        if (len(mesh.vertices), len(mesh.polygons)) != (len(source.vertices), len(source.polygons.sizes)):
            self.report({"ERROR"}, "The modifiers make another mesh of this one: apply or disable them first")
            return {"CANCELLED"}
        bpy.context.tool_settings.mesh_select_mode = _SELECT_MODES[found.element_kind]
        bpy.ops.object.mode_set(mode="EDIT")
        _select(mesh, source, found)
        return {"FINISHED"}


def read_check(obj: bpy.types.Object) -> list[dict[str, Any]] | None:
    """The defects that the latest check of an object found, with numbers of elements; None where it had no check."""
    try:
        found = json.loads(obj.hybrid_quad.last_check)
    except ValueError:
        return None
    return found if isinstance(found, list) else None


def describe_row(row: dict[str, Any]) -> str:
    """A line of the list, for example ``"2 flipped faces: repaired"``."""
    fate = "refused" if not row["repairable"] else "left" if row["kept"] else "repaired"
    return f"{defect_names.in_words(row['code'], row['elements'])}: {fate}"


def _select(mesh: bpy.types.Mesh, source: MeshSource, defect: Defect) -> None:
    """Selects a defect's elements, and what belongs to them, in a mesh in Edit Mode; all else not."""
    edit = bmesh.from_edit_mesh(mesh)
    for elements in (edit.verts, edit.edges, edit.faces):
        elements.ensure_lookup_table()
        for element in elements:
            element.select_set(False)
    if defect.element_kind == "face":
        chosen = [edit.faces[face] for face in defect.elements]
    elif defect.element_kind == "edge":
        count = len(source.vertices)
        flags = np.isin(edge_keys(source.edges, count), edge_keys(defect.elements, count))
        chosen = [edit.edges[edge] for edge in np.flatnonzero(flags)]
    else:
        chosen = [edit.verts[vertex] for vertex in defect.elements]
    for element in chosen:
        element.select_set(True)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


CLASSES = (OBJECT_OT_hybrid_quad_check, OBJECT_OT_hybrid_quad_select_defect)
