"""Errors of a run as a person reads them: with what was being done."""

from __future__ import annotations

from ..core.errors import Cancelled
from ..core.stage_names import while_in

_LIMITS = {"time_limit": "the time limit is over", "memory_limit": "the memory limit is reached"}


def told_with_stage(error: Exception, stage: str) -> Exception:
    """An error of a run that says in words in which stage memory ran out or a limit ended it; any other as it is."""
    told: Exception
    if isinstance(error, MemoryError):
        told = MemoryError(while_in(stage))
    elif isinstance(error, Cancelled) and error.code in _LIMITS:
        told = Cancelled(f"{_LIMITS[error.code]} {while_in(stage)}", error.code)
    else:
        return error
    told.__cause__ = error
    return told
