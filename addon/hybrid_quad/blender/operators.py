"""The operators ``object.hybrid_quad_remesh`` and ``object.hybrid_quad_cancel``."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Collection
from typing import Any

import bpy

from ..cli.messages import describe_elements, what_became_of
from ..core import defect_names, native
from ..core.errors import Cancelled, InputError, InternalError
from ..core.remesh import RemeshResult
from ..core.stage_names import StageWatch, while_in
from ..worker.death import WorkerDied
from ..worker.stage_errors import told_with_stage
from ..worker.transfer_request import STAGE, TransferredData
from . import background_run
from .background_run import BackgroundRun
from .modes import out_of, out_of_for_change
from .own_mesh import OwnMesh
from .remesh_task import RemeshTask, prepare_task
from .result_mesh import Placement, place_result
from .run_display import RunDisplay

_TIMER_SECONDS = 0.1

# Of ``bpy.types.Object.mode``: where the whole mesh can be remeshed, and where a part of it.
WHOLE_MODES = ("OBJECT", "SCULPT")
PART_MODES = (*WHOLE_MODES, "EDIT")

CONVERTIBLE_TYPES = ("CURVE", "SURFACE", "FONT", "META")


class ActiveMeshOperator(bpy.types.Operator):
    """Works on the active object where that is a mesh, in Object Mode."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = problem_of(context)
        if problem:
            cls.poll_message_set(problem)
        return not problem


class RemeshOperator(ActiveMeshOperator):
    """Remeshes objects, at once or by worker processes."""

    def _now(self, context: bpy.types.Context, obj: bpy.types.Object) -> set[str]:
        """A whole run."""
        watch = StageWatch()
        try:
            # Sculpt Mode keeps changes to itself that the depsgraph does not know yet.
            with out_of(obj, "SCULPT"):
                task = prepare_task(obj, context.evaluated_depsgraph_get())
            result = task.solve(progress=watch)
            watch.stage = STAGE
            with out_of_for_change(obj):
                return self._finish(context, obj, task, result, Placement.of_settings(obj))
        except Exception as error:
            return self._fail(told_with_stage(error, watch.stage))

    def _begin(self, context: bpy.types.Context, obj: bpy.types.Object) -> set[str]:
        """Leaves a run to worker processes; the operator is then modal. Quads that are known already are not made again."""
        try:
            mode = context.mode
            with out_of(obj, "SCULPT"):
                self._run = background_run.start(None, obj, mode)
        except Exception as error:
            return self._fail(error)
        self._is_known_told = False
        self._display = RunDisplay(self._run)
        self._run.on_forget = self._end_modal
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Every event goes on to Blender. What another operator or a text field is busy with does not even come here."""
        if background_run.current() is not self._run:  # it was ended from outside
            return {"CANCELLED", "PASS_THROUGH"}
        if is_escape(context, event) and not self._run.is_finished:
            _drop(self, self._run)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        built = None
        try:
            if not self._run.poll() or (self._run.has_result and not self._run.can_be_placed(context)):
                self._show(context)
                return {"PASS_THROUGH"}
            obj = self._run.find_source()
            if self._run.has_result and not self._run.build(obj):
                self._show(context)
                return {"PASS_THROUGH"}
            built = self._run.take_built()
            background_run.forget()
            result, carried = self._run.result(), self._run.carried()
            with out_of_for_change(obj):
                placement = self._placement(context, obj)
                return self._finish(context, obj, self._run.task, result, placement, carried, built)
        except Exception as error:
            background_run.forget()
            if built is not None:
                built.remove()
            return self._fail(error)

    def cancel(self, _context: bpy.types.Context) -> None:
        """Blender ends the operator by itself: another file is loaded, or the window closes."""
        if background_run.current() is self._run:
            background_run.forget()

    def _end_modal(self) -> None:
        bpy.context.window_manager.event_timer_remove(self._timer)
        self._display.clear()

    def _show(self, context: bpy.types.Context) -> None:
        """Tells the user how far it is."""
        self._display.update(context)
        if self._run.is_known and not self._is_known_told:
            self._is_known_told = True
            self.report({"INFO"}, "Nothing that quads depend on has changed since they were made: here they are again")

    def _placement(self, context: bpy.types.Context, obj: bpy.types.Object) -> Placement:
        """Where the result goes, with regard to what the user did meanwhile."""
        if self._run.task.part is not None:
            self._run.require_same_mesh(obj)
            return Placement(self._run.in_place, takes_selection=context.view_layer.objects.active == obj)
        is_changed = obj.mode != "OBJECT" or self._run.has_changed_source(obj)
        if is_changed:
            self.report(
                {"WARNING"},
                f'"{obj.name}" was changed during the run. The result is a new object that shows it as it was when the run '
                "began, and nothing is hidden or replaced",
            )
        return Placement(
            in_place=self._run.in_place and not is_changed,
            hides_source=not is_changed,
            takes_selection=not is_changed and context.view_layer.objects.active == obj,
        )

    def _finish(
        self,
        context: bpy.types.Context,
        obj: bpy.types.Object,
        task: RemeshTask,
        result: RemeshResult,
        placement: Placement,
        carried: TransferredData | None = None,
        built: OwnMesh | None = None,
    ) -> set[str]:
        target = place_result(context, obj, task, result, placement, carried, built)
        self._target = target.name
        for defect in result.report["defects"]:
            self.report({"INFO"}, f"{what_became_of(defect).capitalize()}: {describe_found(defect)}")
        for warning in result.report["warnings"]:
            self.report({"WARNING"}, warning)
        irregular = result.report["irregular_vertices"]
        self.report({"INFO"}, f'"{target.name}": {len(result.quads)} quads, {irregular} irregular vertices')
        return {"FINISHED"}

    def _fail(self, error: Exception) -> set[str]:
        self.report({"ERROR"}, message_of(error))
        return {"CANCELLED"}


class OBJECT_OT_hybrid_quad_remesh(RemeshOperator):
    """Rebuild the surface of the active object from quads that follow its sharp edges and its shape"""

    bl_idname = "object.hybrid_quad_remesh"
    bl_label = "Remesh to Quads"
    # Not REGISTER: repeating it from the list of operators would run it with the window frozen.
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.object
        is_part = obj is not None and obj.type == "MESH" and obj.hybrid_quad.part.region != "WHOLE"
        problem = why_not_now() or problem_of(context, PART_MODES if is_part else WHOLE_MODES)
        if problem:
            cls.poll_message_set(problem)
        return not problem

    def execute(self, context: bpy.types.Context) -> set[str]:
        """The whole run at once: for scripts and Blender without a window."""
        return self._now(context, context.object)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Leaves the run to a worker process; the user goes on working."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        state = self._begin(context, context.object)
        if "RUNNING_MODAL" in state:
            context.window_manager.modal_handler_add(self)
        return state


class OBJECT_OT_hybrid_quad_cancel(bpy.types.Operator):
    """Stop remeshing; nothing is changed"""

    bl_idname = "object.hybrid_quad_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if background_run.current() is None:
            cls.poll_message_set("Nothing is being remeshed")
            return False
        return True

    def execute(self, _context: bpy.types.Context) -> set[str]:
        run = background_run.current()
        assert run is not None
        _drop(self, run)
        return {"FINISHED"}


def _drop(operator: bpy.types.Operator, run: BackgroundRun) -> None:
    """Ends the run as the user wants it: no error."""
    background_run.forget()
    operator.report({"INFO"}, f'Remeshing "{run.source.name}" was cancelled; nothing was changed')


def message_of(error: BaseException) -> str:
    """What the user reads about a failed run; what is a bug also goes to the console in full."""
    if isinstance(error, InputError):
        return f"{error}{describe_elements(error)}"
    if isinstance(error, Cancelled):
        return f"Nothing was changed: {error}"
    if isinstance(error, MemoryError):
        return f"Nothing was changed: memory ran out {error}".rstrip()
    if isinstance(error, OSError) and not isinstance(error, ImportError):
        return f"Nothing was changed: the run could not be started or read: {error}"
    if isinstance(error, (ImportError, ValueError)):
        return str(error)
    if isinstance(error, WorkerDied):
        print(f"hybrid_quad: {error}\n{error.log}", file=sys.stderr)  # noqa: T201
        return f"Nothing was changed: {error}"
    traceback.print_exception(type(error), error, error.__traceback__)
    kind = "" if isinstance(error, InternalError) else f"{type(error).__name__}: "
    where = f" {while_in(error.stage)}" if isinstance(error, InternalError) and error.stage else ""
    return f"Internal error{where}, nothing was changed: {kind}{error}. Please report it with the mesh"


def describe_found(defect: dict[str, Any]) -> str:
    """A defect that a run found, in its JSON form, for example ``"2 flipped faces (turned around)"``."""
    return f"{defect_names.in_words(defect['code'], len(defect['elements']))} ({defect['remedy']})"


def draw_menu_entry(self: Any, _context: bpy.types.Context) -> None:
    """Entry of the menu Object."""
    self.layout.separator()
    self.layout.operator(OBJECT_OT_hybrid_quad_remesh.bl_idname)


def draw_remesh_button(self: Any, _context: bpy.types.Context) -> None:
    """Button below those of Blender's own remeshers, in the panel Remesh of the properties of a mesh."""
    self.layout.operator(OBJECT_OT_hybrid_quad_remesh.bl_idname, text="Hybrid Quad Remesh", icon="MOD_REMESH")


def problem_of(context: bpy.types.Context, modes: Collection[str] = ("OBJECT",)) -> str:
    """Why the active object cannot be worked on now; empty where it can, if it is in one of some modes."""
    return object_problem(context.object, modes)


def object_problem(obj: bpy.types.Object | None, modes: Collection[str] = ("OBJECT",)) -> str:
    """:func:`problem_of`, of any object."""
    if obj is not None and obj.type in CONVERTIBLE_TYPES:
        return "Make a mesh of this object first: Object > Convert > Mesh"
    if obj is None or obj.type != "MESH":
        return "Select a mesh object first"
    if obj.mode not in modes:
        return f"Switch to {' or '.join(f'{mode.title()} Mode' for mode in modes)} first"
    if obj.mode == "SCULPT" and obj.use_dynamic_topology_sculpting:
        return "Switch Dyntopo off first"
    if obj.library is not None:
        return "This object is linked from another file; make it local first"
    return ""


def why_not_now() -> str:
    """Why nothing can be remeshed now, whatever the object; empty where something can."""
    run = background_run.current()
    if run is not None:
        return f'"{run.source.name}" is being remeshed: wait for it, or cancel it'
    return "" if native.is_there() else "The compiled part is missing: install the zip for this Blender and system"


def is_escape(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Whether Esc is pressed over a 3D view, where it means nothing else.

    Playback of an animation has the older claim.
    """
    if event.type != "ESC" or event.value != "PRESS" or event.shift or event.ctrl or event.alt or event.oskey:
        return False
    if context.screen.is_animation_playing:
        return False
    return any(
        area.type == "VIEW_3D"
        and area.x <= event.mouse_x < area.x + area.width
        and area.y <= event.mouse_y < area.y + area.height
        for area in context.screen.areas
    )


CLASSES = (OBJECT_OT_hybrid_quad_remesh, OBJECT_OT_hybrid_quad_cancel)
