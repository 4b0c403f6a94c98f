"""The run that goes on in a process of its own, while Blender's window is there for other work."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

import bpy

from ..core.errors import Cancelled, InputError
from ..core.remesh import RemeshResult
from ..core.stage_names import in_words
from ..worker.process import WorkerRun
from ..worker.transfer_request import TransferredData
from .mesh_source import read_source
from .own_mesh import OwnMesh
from .remesh_task import RemeshTask, prepare_in_steps
from .result_making import ResultMaking
from .source_track import SourceTrack
from .steps import Steps
from .task_solving import TaskSolving
from .transfer.layers import carry_the_same

_SILENCE = 20.0  # seconds without news after which the user reads about it
_STEPS = 0.05  # seconds of reading or making a mesh after which no other step is begun before the window answers


class BackgroundRun:
    """A task that a worker solves, and the object that it came from.

    First the task is read, in steps between which the window answers. Then comes the result and then, by another worker, what that
    takes along from the source.

    Attributes
    ----------
    source : SourceTrack
    in_place : bool
        Whether the result was to replace the object's mesh when the run began.
    on_forget : callable()
        Called when :func:`current` does not give the run any more.
    """

    def __init__(self, task: RemeshTask | None, obj: bpy.types.Object, mode: str) -> None:
        began = time.monotonic()
        # Before anything is read: what is edited from now on is noticed.
        self.source = SourceTrack(obj)
        self.in_place: bool = obj.hybrid_quad.result_mode == "REPLACE"
        self._mode = mode
        self.on_forget: Callable[[], object] = lambda: None
        self._task: RemeshTask | None = None
        self._reading: Steps[RemeshTask] | None = None
        self._solving: TaskSolving | None = None
        self._making: ResultMaking | None = None
        self._waits = self._is_dropped = False
        if task is not None:
            self._solve(task)
        elif mode != "OBJECT" or time.monotonic() < began + _STEPS:
            self._read(began + _STEPS)

    @property
    def task(self) -> RemeshTask:
        """Once it is read."""
        assert self._task is not None
        return self._task

    @property
    def is_reading(self) -> bool:
        """Whether the task is not read in full yet."""
        return self._task is None and not self._is_dropped

    @property
    def is_known(self) -> bool:
        """Whether a former run's quads are taken, so that none are made."""
        return self._solving is not None and self._solving.is_known

    @property
    def worker(self) -> WorkerRun[RemeshResult] | WorkerRun[TransferredData] | None:
        """The process that is at work, or was last; None as long as the task is being read."""
        return None if self._solving is None else self._solving.worker

    @property
    def fraction(self) -> float:
        """How much is done, 0 to 1."""
        if self.is_finished:
            return 1.0
        return 0.0 if self._solving is None else self._solving.fraction

    @property
    def is_finished(self) -> bool:
        """Whether nothing goes on any more, for better or worse."""
        return not self.is_reading and (self._solving is None or self._solving.is_finished)

    @property
    def has_result(self) -> bool:
        """Whether all has ended well."""
        return self._solving is not None and self._solving.has_result

    def poll(self) -> bool:
        """Looks how far the run is, without waiting, and does what is next; whether it has ended.

        Raises
        ------
        InputError
            As :func:`.remesh_task.prepare_in_steps`; ``object_gone``.
        OSError
            If a worker cannot be begun.
        """
        if self.is_reading:
            self._read(time.monotonic() + _STEPS)
        elif self._solving is not None:
            self._solving.poll()
        return self.is_finished

    def cancel(self) -> None:
        """Ends what goes on, and begins nothing more; :meth:`result` then raises Cancelled. What has ended stays as it is."""
        self._is_dropped = True
        if self._reading is not None:
            self._reading.close()
        if self._making is not None:
            self._making.cancel()
        if self._solving is not None:
            self._solving.cancel()

    def wait(self) -> None:
        """Returns when the run has ended."""
        while self.is_reading:
            self.poll()
        if self._solving is not None:
            self._solving.wait()

    def build(self, obj: bpy.types.Object) -> bool:
        """Makes the result's mesh for a while, with nothing of the scene changed; whether there is no more to do before it is placed.

        Parts of a mesh, and what is placed out of another mode, are not made before they are placed.
        """
        if self.task.part is not None or obj.mode != "OBJECT":
            return True
        if self._making is None:
            self._making = ResultMaking(self.task, self.result(), self.carried())
        return self._making.go_on(obj, _STEPS)

    def take_built(self) -> OwnMesh | None:
        """What :meth:`build` made, if it is still there; it belongs to the caller from now on."""
        return None if self._making is None else self._making.take()

    @property
    def is_building(self) -> bool:
        """Whether the result's mesh is being made."""
        return self._making is not None

    def _solved(self) -> TaskSolving:
        self.wait()
        if self._solving is None:
            raise Cancelled("cancelled before it began")
        return self._solving

    def _read(self, until: float) -> None:
        """Reads up to a time, but at least one step; begins to solve the task when it is there."""
        if self._reading is None:
            obj = self.find_source()
            # Where the user was faster: in other modes meshes are not what they will be.
            self._waits = obj.mode != "OBJECT" and self._mode == "OBJECT"
            if self._waits:
                return
            self._reading = prepare_in_steps(obj, bpy.context.evaluated_depsgraph_get())
        try:
            next(self._reading)
            while time.monotonic() < until:
                next(self._reading)
        except StopIteration as end:
            self._solve(end.value)
        except BaseException:
            self._is_dropped = True
            raise

    def _solve(self, task: RemeshTask) -> None:
        self._task = task
        self._solving = TaskSolving(task)

    @property
    def status(self) -> str:
        """What it does now, for example ``"Finding edge directions"``."""
        if self.is_finished:
            return "Making the mesh" if self.is_building else "Done: go to Object Mode"
        if self.worker is None:
            return "Go on in Object Mode" if self._waits else "Reading the mesh"
        return in_words(self.worker.stage).capitalize()

    @property
    def silence(self) -> str:
        """How long a worker has told nothing, for example ``"No news for 25 s"``; empty where that is nothing special."""
        if self.worker is None or self.is_finished or self.worker.silent_seconds < _SILENCE:
            return ""
        return f"No news for {self.worker.silent_seconds:.0f} s"

    def result(self) -> RemeshResult:
        """The run's result; waits for the whole run, and raises what that raised, see :meth:`.process.WorkerRun.result`."""
        return self._solved().result()

    def carried(self) -> TransferredData:
        """What the result takes along, as :meth:`result`."""
        return self._solved().carried()

    def find_source(self) -> bpy.types.Object:
        """The object that the result is for.

        Raises
        ------
        InputError
            ``object_gone``.
        """
        obj = self.source.find()
        if obj is None:
            raise InputError("object_gone", f'"{self.source.name}" was deleted during the run; its result is dropped')
        return obj

    def can_be_placed(self, context: bpy.types.Context) -> bool:
        """Whether Blender is in a mode in which the result can go to its place."""
        if context.mode == "OBJECT":
            return True
        can_be_left = context.mode == self._mode == "SCULPT" or (
            self.task.part is not None and context.mode == "EDIT_MESH"
        )
        return can_be_left and context.object == self.source.find()

    def has_changed_source(self, obj: bpy.types.Object) -> bool:
        """Whether the source, in Object Mode, is another than when the run began, or carries something else."""
        if self.source.has_changed(obj):
            return True
        layers = self.task.source.layers
        if not self.source.was_touched or layers is None:
            return False
        try:
            again = read_source(obj, bpy.context.evaluated_depsgraph_get(), kinds=layers.kinds)
        except InputError:
            return True
        return again.layers is None or not carry_the_same(layers, again.layers)

    def require_same_mesh(self, obj: bpy.types.Object) -> None:
        """Raises InputError ``mesh_changed`` where a part's mesh is not the one any more that it is a part of."""
        if self.source.has_changed_mesh(obj):
            raise InputError(
                "mesh_changed",
                f'"{obj.name}" was edited during the run, so its faces are not those that were remeshed; the result is dropped',
            )


_current: BackgroundRun | None = None


def current() -> BackgroundRun | None:
    """The run that goes on, if any: Blender's window serves one at a time."""
    return _current


def start(task: RemeshTask | None, obj: bpy.types.Object, mode: str = "OBJECT") -> BackgroundRun:
    """Begins a run that :func:`current` gives from now on.

    Parameters
    ----------
    task : RemeshTask or None
        None: as the object's settings ask, read in steps. Of a mode other than Object Mode the first step, which is all that looks
        at the object, is done here. What a former run of this session gave for the very same task is not made again.
    mode : str
        ``bpy.types.Context.mode`` in which the user asked for it. One asked for in Sculpt Mode can be placed there.

    Raises
    ------
    InputError
        If the object shows no surface.
    FileNotFoundError
        If no program can run the worker.
    """
    global _current
    assert _current is None
    _current = BackgroundRun(task, obj, mode)
    bpy.app.handlers.depsgraph_update_post.append(_on_change)
    return _current


def forget() -> None:
    """Lets the current run go, if there is one; what is not finished is ended."""
    global _current
    run, _current = _current, None
    if run is None:
        return
    with contextlib.suppress(ValueError):  # loading a file takes it away
        bpy.app.handlers.depsgraph_update_post.remove(_on_change)
    run.cancel()
    run.on_forget()


def _on_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _current is not None:
        _current.source.take_notice(depsgraph)
