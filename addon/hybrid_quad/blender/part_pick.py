"""The operator ``object.hybrid_quad_pick_face_set``: the face set under the mouse becomes the region to remesh."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import bpy
from bpy_extras import view3d_utils

from .edge_marks import FACE_SET_ATTRIBUTE
from .operators import PART_MODES, problem_of
from .painting.paint_surface import PaintSurface
from .part_source import knows_face_sets

_NO_FACE_SETS = "Add-ons see face sets from Blender 3.5 on; hide the other faces and choose Visible"


class OBJECT_OT_hybrid_quad_pick_face_set(bpy.types.Operator):
    """Click on the mesh to choose the face set there as the region that is remeshed"""

    bl_idname = "object.hybrid_quad_pick_face_set"
    bl_label = "Pick Face Set"
    bl_options = {"UNDO", "INTERNAL"}

    face: bpy.props.IntProperty(
        name="Face", description="Number of a face of the face set", min=0, options={"SKIP_SAVE", "HIDDEN"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = problem_of(context, [mode for mode in PART_MODES if mode != "EDIT"])
        if not problem and not knows_face_sets():
            problem = _NO_FACE_SETS
        if not problem and FACE_SET_ATTRIBUTE not in context.object.data.attributes:
            problem = "This mesh has no face sets: make some in Sculpt Mode"
        if problem:
            cls.poll_message_set(problem)
        return not problem

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Chooses the face set of :attr:`face`."""
        numbers = context.object.data.attributes[FACE_SET_ATTRIBUTE].data
        if self.face >= len(numbers):
            self.report({"ERROR"}, f"There is no face {self.face}")
            return {"CANCELLED"}
        part = context.object.hybrid_quad.part
        part.region, part.face_set = "FACE_SET", numbers[self.face].value
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Waits for a click."""
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set("Click on a face set; Esc or the right button leaves it as it is")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """The view can be turned meanwhile."""
        if event.type in ("ESC", "RIGHTMOUSE") and event.value == "PRESS":
            self._end(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"}
        self._end(context)
        face = _face_under(context, event.mouse_x, event.mouse_y)
        if face is None:
            self.report({"WARNING"}, "There was no face of the active object under the mouse")
            return {"CANCELLED"}
        self.face = face
        return self.execute(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator by itself."""
        self._end(context)

    def _end(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


def _face_under(context: bpy.types.Context, x: int, y: int) -> int | None:
    """The face of the active object's own mesh at a place of the window, in pixels; None where there is none."""
    for area in context.screen.areas:
        region = next((region for region in area.regions if region.type == "WINDOW"), None)
        if area.type != "VIEW_3D" or region is None:
            continue
        place = x - region.x, y - region.y
        if 0 <= place[0] < region.width and 0 <= place[1] < region.height:
            view = area.spaces.active.region_3d
            hit = PaintSurface(context.object, context.evaluated_depsgraph_get()).under(
                view3d_utils.region_2d_to_origin_3d(region, view, place),
                view3d_utils.region_2d_to_vector_3d(region, view, place),
            )
            return None if hit is None or hit[1] is None else int(hit[1].polygon)
    return None


CLASSES = (OBJECT_OT_hybrid_quad_pick_face_set,)
