"""What is looked at before and after a run of ``hybrid-quad remesh``."""

from __future__ import annotations

import time

from ..core import native
from ..core.errors import Cancelled, InternalError
from ..core.options import RemeshOptions


class RunLimits:
    """The limits of a run, for what it does itself before it calls the compiled part, which heeds them from then on."""

    def __init__(self, options: RemeshOptions, started: float) -> None:
        self._options, self._started = options, started

    def check_time(self, stage: str) -> None:
        """Raises Cancelled where no time is left for the run; `stage` is what it does now."""
        limit = self._options.time_limit
        if limit is not None and time.monotonic() - self._started > limit:
            raise Cancelled(f"cancelled during {stage} (the time limit passed)", "time_limit")

    def check(self, stage: str) -> None:
        """Raises Cancelled where no time is left, or the process has grown beyond the memory limit."""
        self.check_time(stage)
        limit = self._options.memory_limit
        if limit is not None and native.load().resident_memory_mb() > limit:
            raise Cancelled(f"cancelled during {stage} (the memory limit is reached)", "memory_limit")


def check_valid(violations: list[str]) -> None:
    """Raises InternalError where there is any."""
    if violations:
        raise InternalError("the result is no valid quad mesh: " + "; ".join(violations), "validation")
