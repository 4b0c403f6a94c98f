"""Keeps what is drawn over the active object up to date: a worker process does the work, and a timer looks at it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

import bpy

from ...core.stage_names import in_words
from ...worker.interpreter import worker_command
from ...worker.kinds import Request
from ...worker.process import WorkerRun, WorkerSeat
from ..operators import message_of
from ..source_track import identity

_CALM = 0.1  # seconds without a change after which it is worth while to start
# Where the mesh that an object shows can be read.
_MODES = {"OBJECT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT"}

Result = TypeVar("Result")


class Session(Generic[Result]):
    """What is known of the active object, and the worker that is at it.

    Attributes
    ----------
    error : str
        Why there is nothing to show; empty otherwise.
    result : object or None
        Of the latest run that ended well.
    """

    def __init__(
        self,
        requests: Callable[[bpy.types.Object, bpy.types.Depsgraph], Sequence[Request[Result]]],
        signature: Callable[[bpy.types.Object], Any],
        accept: Callable[[bpy.types.Object, Result], None],
        *,
        keeps_worker: bool = False,
    ) -> None:
        """A session that shows nothing yet.

        Parameters
        ----------
        requests : callable(object, depsgraph)
            What a worker is asked about an object, one after the other: each result replaces the former.
        signature : callable(object)
            Changes where the settings that the requests depend on do.
        accept : callable(object, result)
            Receives every result.
        keeps_worker : bool
            Whether one worker answers one request after the other, so that it knows what they have in common: for requests that
            stop within a moment when they are asked to.
        """
        self._requests, self._signature, self._accept = requests, signature, accept
        self._keeps_worker = keeps_worker
        self.error = ""
        self.result: Result | None = None
        self._object: int | None = None
        self._seen: Any = None
        self._changed_at: float | None = None
        self._worker: WorkerRun[Result] | None = None
        self._waiting: list[Request[Result]] = []
        self._seat: WorkerSeat | None = None  # waits for the next change

    @property
    def is_busy(self) -> bool:
        """Whether a worker runs, or a change waits for one."""
        return self._worker is not None or self._changed_at is not None

    @property
    def status(self) -> str:
        """What goes on, for example ``"Finding edge directions"``; empty where nothing does."""
        if self._worker is None:
            return "Waiting" if self._changed_at is not None else ""
        return in_words(self._worker.stage).capitalize()

    def target(self) -> bpy.types.Object | None:
        """The object that the result belongs to, if it is still there."""
        if self.result is None:
            return None
        obj = bpy.context.view_layer.objects.active
        return obj if obj is not None and identity(obj) == self._object else None

    def mark_changed(self) -> None:
        """Has everything computed anew when nothing has changed for a moment."""
        self._changed_at = time.monotonic()

    def step(self, *, at_once: bool = False) -> None:
        """Looks for changes and results, and starts what is due.

        Parameters
        ----------
        at_once : bool
            Start even where something has just changed.
        """
        obj = bpy.context.view_layer.objects.active
        if obj is None or obj.type != "MESH":
            self.clear()
            return
        if identity(obj) != self._object:
            self._forget()
            self._object = identity(obj)
            self.mark_changed()
        signature = self._signature(obj)
        if signature != self._seen:
            self._seen = signature
            # The panel has had Blender tell of the object before, and the window may have been drawn since: that time counts.
            if self._changed_at is None:
                self.mark_changed()
        is_calm = self._changed_at is not None and (at_once or time.monotonic() - self._changed_at > _CALM)
        if is_calm and obj.mode in _MODES:
            self._begin(obj)
        else:
            self._look(obj)

    def clear(self) -> None:
        """Ends every process and forgets all."""
        self._forget()
        seat, self._seat = self._seat, None
        if seat is not None:
            seat.leave()

    def _forget(self) -> None:
        self._stop()
        self.error, self.result, self._object, self._seen, self._changed_at = "", None, None, None, None

    def _begin(self, obj: bpy.types.Object) -> None:
        self._stop()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        self._changed_at = None  # only now: what was evaluated at last told of itself
        try:
            self._waiting = list(self._requests(obj, depsgraph))
            self._start_next()
        except Exception as error:
            self._fail(error)

    def _start_next(self) -> None:
        seat, self._seat = self._seat, None
        if seat is not None and not seat.is_there():  # the system may have ended it
            seat.leave()
            seat = None
        self._worker = WorkerRun(self._waiting.pop(0), seat=seat or self._new_seat())

    def _look(self, obj: bpy.types.Object) -> None:
        if self._worker is None or not self._worker.poll():
            return
        worker, self._worker = self._worker, None
        try:
            self.result = worker.result()
            self.error = ""
            self._keep(worker.seat)
            self._accept(obj, self.result)
            if self._waiting:
                self._start_next()
            else:
                self._seat = self._seat or self._new_seat()
        except Exception as error:
            self._fail(error)

    def _fail(self, error: Exception) -> None:
        self._waiting.clear()
        self.result = None
        self.error = message_of(error).replace("Nothing was changed: ", "")

    def _stop(self) -> None:
        worker, self._worker = self._worker, None
        self._waiting.clear()
        if worker is not None:
            worker.abandon()
            self._keep(worker.seat)

    def _keep(self, seat: WorkerSeat) -> None:
        """Has the next request answered by a worker that stays."""
        if seat.stays:
            self._seat = seat

    def _new_seat(self) -> WorkerSeat:
        command = worker_command(host=bpy.app.binary_path)
        return WorkerSeat(stays=self._keeps_worker, temporary_folder=bpy.app.tempdir or None, command=command)
