"""The run that goes on in a process of its own, while Blender's window is there for other work."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from ..core.errors import InputError
from ..core.remesh import RemeshResult
from ..worker.interpreter import worker_command
from ..worker.known_results import KnownResults
from ..worker.process import WorkerRun
from .remesh_task import RemeshTask
from .source_track import SourceTrack

_SILENCE = 20.0  # seconds without news after which the user reads about it


class BackgroundRun:
    """A task that a worker solves, and the object that it came from.

    Attributes
    ----------
    task : RemeshTask
    source : SourceTrack
    in_place : bool
        Whether the result was to replace the object's mesh when the run began.
    on_forget : callable()
        Called when :func:`current` does not give the run any more.
    """

    def __init__(self, task: RemeshTask, obj: bpy.types.Object, mode: str) -> None:
        self.task = task
        self.source = SourceTrack(obj)
        self.in_place: bool = obj.hybrid_quad.result_mode == "REPLACE"
        self._mode = mode
        self.on_forget: Callable[[], object] = lambda: None
        self._request = task.request()
        self.worker = WorkerRun(
            self._request,
            temporary_folder=bpy.app.tempdir or None,
            command=worker_command(host=bpy.app.binary_path),
        )

    @property
    def fraction(self) -> float:
        """How much is done, 0 to 1."""
        return 1.0 if self.is_finished else self.worker.fraction

    @property
    def is_finished(self) -> bool:
        return self.worker.is_finished

    @property
    def has_result(self) -> bool:
        return self.worker.has_result

    @property
    def status(self) -> str:
        """What it does now, for example ``"Periodic field"``."""
        if self.is_finished:
            return "Done: go to Object Mode"
        silence = self.worker.silent_seconds
        text = self.worker.stage.replace("_", " ").capitalize()
        return f"{text}, no news for {silence:.0f} s" if silence > _SILENCE else text

    def result(self) -> RemeshResult:
        """The finished run's result; raises what the run raised, see :meth:`.process.WorkerRun.result`."""
        result = self.worker.result()
        _known.keep(self._request, result)
        return result

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

    def require_same_mesh(self, obj: bpy.types.Object) -> None:
        """Raises InputError ``mesh_changed`` where a part's mesh is not the one any more that it is a part of."""
        if self.source.has_changed_mesh(obj):
            raise InputError(
                "mesh_changed",
                f'"{obj.name}" was edited during the run, so its faces are not those that were remeshed; the result is dropped',
            )


_current: BackgroundRun | None = None
_known = KnownResults()


def current() -> BackgroundRun | None:
    """The run that goes on, if any: Blender's window serves one at a time."""
    return _current


def known_result(task: RemeshTask) -> RemeshResult | None:
    """What a former run of this session gave for the very same task; None where there was none."""
    return _known.find(task.request())


def forget_results() -> None:
    """Lets go of what :func:`known_result` finds."""
    _known.clear()


def start(task: RemeshTask, obj: bpy.types.Object, mode: str = "OBJECT") -> BackgroundRun:
    """Begins a run that :func:`current` gives from now on.

    Parameters
    ----------
    mode : str
        ``bpy.types.Context.mode`` in which the user asked for it. One asked for in Sculpt Mode can be placed there.

    Raises
    ------
    FileNotFoundError
        If no program can run the worker.
    """
    global _current
    assert _current is None
    _current = BackgroundRun(task, obj, mode)
    return _current


def forget() -> None:
    """Lets the current run go, if there is one; what is not finished is ended."""
    global _current
    run, _current = _current, None
    if run is None:
        return
    run.worker.cancel()
    run.on_forget()
