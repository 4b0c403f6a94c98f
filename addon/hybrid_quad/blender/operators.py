"""The operator ``object.hybrid_quad_remesh``."""

from __future__ import annotations

import traceback
from typing import Any

import bpy

from ..cli.messages import describe_defect, describe_elements
from ..core.errors import Cancelled, InputError, InternalError
from ..core.remesh import RemeshResult
from .background_run import BackgroundRun
from .remesh_task import RemeshTask, prepare_task
from .result_mesh import place_result

_TIMER_SECONDS = 0.1
# What the user may do while a run goes on: look around. Anything else could change the scene under it.
_HARMLESS_EVENTS = frozenset(
    (
        "MOUSEMOVE",
        "INBETWEEN_MOUSEMOVE",
        "MIDDLEMOUSE",
        "WHEELUPMOUSE",
        "WHEELDOWNMOUSE",
        "TRACKPADPAN",
        "TRACKPADZOOM",
        "NDOF_MOTION",
    )
)


class ActiveMeshOperator(bpy.types.Operator):
    """Works on the active object where that is a mesh, in Object Mode, while no run goes on."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = problem_of(context)
        if problem:
            cls.poll_message_set(problem)
        return not problem


class OBJECT_OT_hybrid_quad_remesh(ActiveMeshOperator):
    """Rebuild the surface of the active object from quads that follow its sharp edges and its shape"""

    bl_idname = "object.hybrid_quad_remesh"
    bl_label = "Remesh to Quads"
    bl_options = {"REGISTER", "UNDO"}

    # The run that goes on in the background, if any: Blender's window serves one at a time.
    current_run: BackgroundRun | None = None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """The whole run at once: for scripts and Blender without a window."""
        obj = context.object
        try:
            task = prepare_task(obj, context.evaluated_depsgraph_get())
            return self._finish(context, obj, task, task.solve())
        except Exception as error:
            return self._fail(error)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            task = prepare_task(context.object, context.evaluated_depsgraph_get())
        except Exception as error:
            return self._fail(error)
        self._object_name = context.object.name
        OBJECT_OT_hybrid_quad_remesh.current_run = BackgroundRun(task)
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        run = OBJECT_OT_hybrid_quad_remesh.current_run
        if run is None:  # the add-on was disabled meanwhile
            self._end_modal(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            run.stop()
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if event.type in _HARMLESS_EVENTS else {"RUNNING_MODAL"}
        if not run.is_finished:
            context.window_manager.progress_update(100 * run.fraction)
            context.workspace.status_text_set(f"Hybrid Quad: {run.status}    Esc: cancel")
            _redraw_views(context)
            return {"RUNNING_MODAL"}
        self._end_modal(context)
        obj = bpy.data.objects.get(self._object_name)
        try:
            if obj is None:
                raise InputError("object_gone", f'"{self._object_name}" was deleted or renamed during the run')
            return self._finish(context, obj, run.task, run.result())
        except Exception as error:
            return self._fail(error)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator by itself: another file is loaded, or the window closes."""
        stop_background_run()
        self._end_modal(context)

    def _end_modal(self, context: bpy.types.Context) -> None:
        OBJECT_OT_hybrid_quad_remesh.current_run = None
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        _redraw_views(context)

    def _finish(
        self, context: bpy.types.Context, obj: bpy.types.Object, task: RemeshTask, result: RemeshResult
    ) -> set[str]:
        target = place_result(context, obj, task, result)
        for defect in result.report["defects"]:
            self.report({"INFO"}, f"Repaired {describe_defect(defect)}")
        for warning in result.report["warnings"]:
            self.report({"WARNING"}, warning)
        irregular = result.report["irregular_vertices"]
        self.report({"INFO"}, f'"{target.name}": {len(result.quads)} quads, {irregular} irregular vertices')
        return {"FINISHED"}

    def _fail(self, error: Exception) -> set[str]:
        self.report({"ERROR"}, message_of(error))
        return {"CANCELLED"}


def message_of(error: BaseException) -> str:
    """What the user reads about a failed run; what is a bug also goes to the console in full."""
    if isinstance(error, InputError):
        return f"{error}{describe_elements(error)}"
    if isinstance(error, Cancelled):
        return f"Nothing was changed: {error}"
    if isinstance(error, (ImportError, ValueError)):
        return str(error)
    traceback.print_exception(type(error), error, error.__traceback__)
    kind = "" if isinstance(error, InternalError) else f"{type(error).__name__}: "
    return f"Internal error, nothing was changed: {kind}{error}. Please report it with the mesh"


def stop_background_run() -> None:
    """Ends the run in the background, if there is one, and waits until it has."""
    run = OBJECT_OT_hybrid_quad_remesh.current_run
    if run is not None:
        run.stop()
        run.wait()
        OBJECT_OT_hybrid_quad_remesh.current_run = None


def draw_menu_entry(self: Any, _context: bpy.types.Context) -> None:
    """Entry of the menu Object."""
    self.layout.separator()
    self.layout.operator(OBJECT_OT_hybrid_quad_remesh.bl_idname)


def problem_of(context: bpy.types.Context) -> str:
    """Why the active object cannot be worked on now; empty where it can."""
    obj = context.object
    if OBJECT_OT_hybrid_quad_remesh.current_run is not None:
        return "A run is going on already"
    if obj is None or obj.type != "MESH":
        return "Select a mesh object first"
    if obj.mode != "OBJECT":
        return "Switch to Object Mode first"
    if obj.library is not None:
        return "This object is linked from another file; make it local first"
    return ""


def _redraw_views(context: bpy.types.Context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


CLASSES = (OBJECT_OT_hybrid_quad_remesh,)
