"""A worker that ended without a last word, and what its exit status says about why."""

from __future__ import annotations

import signal
import sys

from ..core.stage_names import while_in

# Windows ends a process that failed with the number of the exception.
_WINDOWS_CAUSES = {
    0xC0000005: "it crashed: access violation",
    0xC000001D: "it crashed: this processor lacks an instruction",
    0xC00000FD: "it crashed: stack overflow",
    0xC0000017: "memory ran out",
    0xC0000409: "it crashed: stack buffer overrun",
}
# What programs write where an allocation failed, before they end in whatever way.
_NO_MEMORY = ("bad_alloc", "MemoryError", "Cannot allocate memory")
_CAUSES = {
    "SIGKILL": "it was killed, perhaps by the system because memory ran out",
    "SIGTERM": "it was told to end by another program",
    "SIGSEGV": "it crashed: segmentation fault",
    "SIGBUS": "it crashed: bus error",
    "SIGABRT": "it crashed: abort",
    "SIGILL": "it crashed: illegal instruction",
    "SIGFPE": "it crashed: arithmetic error",
}


class WorkerDied(RuntimeError):
    """The process of a run ended before the run did, or was ended as it hung.

    Attributes
    ----------
    stage : str
        What ran last.
    status : int
        Exit status; below zero the number of a signal.
    log : str
        The end of what it wrote to its error stream.
    """

    def __init__(self, stage: str, status: int, log: str = "", cause: str = "") -> None:
        cause = cause or cause_of(status)
        if any(text in log for text in _NO_MEMORY):
            cause = f"memory ran out; {cause}"
        super().__init__(f"the run ended {while_in(stage)}: {cause}")
        self.stage = stage
        self.status = status
        self.log = log


def cause_of(status: int, platform: str = sys.platform) -> str:
    """Why a process ended with a status, in words and with the number.

    Parameters
    ----------
    status : int
        As ``subprocess.Popen.returncode``: below zero a signal.
    platform : str
        As ``sys.platform``.
    """
    if platform == "win32":
        number = status & 0xFFFFFFFF
        return f"{_WINDOWS_CAUSES.get(number, 'its process ended')} (exit status {number:#x})"
    if status >= 0:
        return f"its process ended (exit status {status})"
    try:
        name = signal.Signals(-status).name
    except ValueError:
        return f"its process ended (signal {-status})"
    return f"{_CAUSES.get(name, 'its process ended')} (signal {-status}, {name})"
