"""What is looked at before and after a run of ``hybrid-quad remesh``."""

from __future__ import annotations

import time

from ..core.errors import Cancelled, InternalError
from ..core.options import RemeshOptions


def check_time(options: RemeshOptions, started: float) -> None:
    """Raises Cancelled where no time is left for the run."""
    if options.time_limit is not None and time.monotonic() - started > options.time_limit:
        raise Cancelled("the time limit passed while the mesh was read", "time_limit")


def check_valid(violations: list[str]) -> None:
    """Raises InternalError where there is any."""
    if violations:
        raise InternalError("the result is no valid quad mesh: " + "; ".join(violations), "validation")
