"""The operator ``object.hybrid_quad_remesh_selected``: every selected mesh object, each by its own settings."""

from __future__ import annotations

from typing import Any

import bpy

from . import background_run
from .operators import RemeshOperator, is_escape, object_problem, why_not_now


class OBJECT_OT_hybrid_quad_remesh_selected(RemeshOperator):
    """Remesh all selected mesh objects one after the other, each with its own settings"""

    bl_idname = "object.hybrid_quad_remesh_selected"
    bl_label = "Remesh Selected Objects"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = why_not_now()
        if not problem and context.mode != "OBJECT":
            problem = "Switch to Object Mode first"
        if not problem and not _selected_meshes(context):
            problem = "Select mesh objects first"
        if problem:
            cls.poll_message_set(problem)
        return not problem

    def execute(self, context: bpy.types.Context) -> set[str]:
        """All runs at once. What fails is reported, and stops none of the others."""
        self._start(context)
        while self._left:
            obj = self._take()
            if obj is not None and self._now(context, obj) == {"FINISHED"}:
                self._done.append(self._target)
        return self._end(context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Leaves the runs to worker processes, one at a time."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._start(context)
        state = self._next(context)
        if "RUNNING_MODAL" in state:
            context.window_manager.modal_handler_add(self)
        return state

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """As of one run; then comes the next. Who cancels one, cancels those after it."""
        is_ended = background_run.current() is not self._run or is_escape(context, event)
        state = super().modal(context, event)
        if not state & {"FINISHED", "CANCELLED"}:
            return state
        if "FINISHED" in state:
            self._done.append(self._target)
        elif is_ended:
            self._left = []
        return self._next(context)

    def _start(self, context: bpy.types.Context) -> None:
        self._left = [obj.name for obj in _selected_meshes(context)]
        self._done: list[str] = []

    def _take(self) -> bpy.types.Object | None:
        """The next object, if it is still there and can be remeshed."""
        name = self._left.pop(0)
        obj = bpy.data.objects.get(name)
        problem = object_problem(obj)
        if obj is not None and problem:
            self.report({"ERROR"}, f'"{name}" is left out: {problem}')
        return None if problem else obj

    def _next(self, context: bpy.types.Context) -> set[str]:
        while self._left:
            obj = self._take()
            state = set() if obj is None else self._begin(context, obj)
            if "RUNNING_MODAL" in state:
                return state
        return self._end(context)

    def _end(self, context: bpy.types.Context) -> set[str]:
        """Selects all results."""
        for name in self._done:
            if name in context.view_layer.objects:
                context.view_layer.objects[name].select_set(True)
        return {"FINISHED"} if self._done else {"CANCELLED"}


def _selected_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    return sorted((obj for obj in context.selected_objects if obj.type == "MESH"), key=lambda obj: obj.name)


def draw_menu_entry(self: Any, _context: bpy.types.Context) -> None:
    """Entry of the menu Object, below that for the active object."""
    self.layout.operator(OBJECT_OT_hybrid_quad_remesh_selected.bl_idname)


CLASSES = (OBJECT_OT_hybrid_quad_remesh_selected,)
