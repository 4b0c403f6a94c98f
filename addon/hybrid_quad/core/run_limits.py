"""Whether a run may go on, for what Python does of it: the compiled part asks by itself."""

from __future__ import annotations

import time
from collections.abc import Callable

from . import native
from .errors import Cancelled
from .options import RemeshOptions


class RunLimits:
    """What ends a run.

    Parameters
    ----------
    options : RemeshOptions
        Have its limits of time and memory.
    cancel : callable() -> bool, optional
        A true answer ends it too.

    The time counts from when this is made.
    """

    def __init__(self, options: RemeshOptions, cancel: Callable[[], bool] | None = None) -> None:
        self._started = time.monotonic()
        self._options, self._cancel = options, cancel

    @property
    def seconds(self) -> float:
        """How long the run has taken."""
        return time.monotonic() - self._started

    def check(self, stage: str) -> None:
        """Asks whether the run may go on; `stage` is what it does now.

        Raises
        ------
        Cancelled
            If the caller wants it to end, no time is left, or the process has grown beyond the memory limit.
        """
        options = self._options
        if self._cancel is not None and self._cancel():
            raise Cancelled(f"cancelled during {stage}")
        if options.time_limit is not None and self.seconds > options.time_limit:
            raise Cancelled(f"cancelled during {stage} (the time limit passed)", "time_limit")
        if options.memory_limit is not None and native.load().resident_memory_mb() > options.memory_limit:
            raise Cancelled(f"cancelled during {stage} (the memory limit is reached)", "memory_limit")
