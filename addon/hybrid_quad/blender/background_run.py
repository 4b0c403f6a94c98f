"""A run on a thread of its own, so that Blender's window stays alive."""

from __future__ import annotations

import threading

from ..core.remesh import RemeshResult
from .remesh_task import RemeshTask


class BackgroundRun:
    """Solves a task; the thread touches nothing of Blender's.

    Attributes
    ----------
    stage, fraction
        What runs now, and how much of the whole is done.
    """

    def __init__(self, task: RemeshTask) -> None:
        self.task = task
        self.stage = "start"
        self.fraction = 0.0
        self._stop = threading.Event()
        self._result: RemeshResult | None = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._solve, name="hybrid_quad", daemon=True)
        self._thread.start()

    @property
    def is_finished(self) -> bool:
        return not self._thread.is_alive()

    def stop(self) -> None:
        """Asks the run to stop; it does within a second."""
        self._stop.set()

    def wait(self) -> None:
        """Returns when the thread has ended."""
        self._thread.join()

    def result(self) -> RemeshResult:
        """The finished run's result; raises what the run raised."""
        self.wait()
        if self._error is not None:
            raise self._error
        assert self._result is not None
        return self._result

    @property
    def status(self) -> str:
        """For example ``"periodic field, 42 %"``."""
        return f"{self.stage.replace('_', ' ')}, {100 * self.fraction:.0f} %"

    def _solve(self) -> None:
        try:
            self._result = self.task.solve(self._progress, self._stop.is_set)
        except BaseException as error:  # carried over to the main thread
            self._error = error

    def _progress(self, stage: str, fraction: float) -> None:
        self.stage = stage
        self.fraction = fraction
