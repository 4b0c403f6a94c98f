"""A process for one run: with limits that it cannot get past, and an end when its parent ends."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..core import native

if sys.platform == "linux":
    import resource

_PAUSE = 0.2  # seconds between two looks at whether to stop
_PATIENCE = 5.0  # seconds that a process gets to end by itself
_GRACE = 10.0  # seconds past its time limit, and half of that again, before it is killed
_MESSAGES_KEPT = 4000  # characters

PACKAGE_PARENT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Outcome:
    """How a process ended.

    Attributes
    ----------
    exit_status : int
        Negative: the signal that ended it.
    stopped : str
        Why it was ended from here: ``"cancelled"``, ``"time_limit"``, or ``""`` if it ended by itself.
    messages : str
        The end of what it wrote to its standard output and error.
    seconds : float
        How long it ran.
    """

    exit_status: int
    stopped: str
    messages: str
    seconds: float


def run_process(
    command: Sequence[str],
    log: Path,
    stop: Callable[[], bool],
    *,
    time_limit: float = 0.0,
    memory_limit: float = 0.0,
    inherited: Sequence[int] = (),
) -> Outcome:
    """Runs a command that itself heeds `time_limit` and `memory_limit`, and makes sure of both.

    Parameters
    ----------
    command : sequence of str
        It gets a standard input that ends when this process does.
    log : Path
        Receives what it writes.
    stop : callable() -> bool
        Polled; a true answer ends the process.
    time_limit : float
        Seconds after which it should have ended; it is killed when half as much again and ten seconds have passed.
    memory_limit : float
        MB of 2**20 bytes. It gets no more memory than a quarter above, and 256 MB that interpreters need for themselves
        (Linux only).
    inherited : sequence of int
        File descriptors that it gets.

    Raises
    ------
    OSError
        If it cannot be started.
    """
    started = time.monotonic()
    deadline = started + 1.5 * time_limit + _GRACE if time_limit else float("inf")
    with log.open("wb") as file:
        process = subprocess.Popen(
            list(command),
            stdin=subprocess.PIPE,
            stdout=file,
            stderr=subprocess.STDOUT,
            env=_environment(),
            pass_fds=tuple(inherited) if os.name == "posix" else (),
        )
    stopped = ""
    try:
        if memory_limit and sys.platform == "linux":
            most = int((1.25 * memory_limit + 256) * 2**20)
            with contextlib.suppress(ProcessLookupError):
                # Not before the program starts, as between fork and exec hardly anything is safe beside threads.
                resource.prlimit(process.pid, resource.RLIMIT_DATA, (most, most))
        while True:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(_PAUSE)
                break
            if time.monotonic() > deadline:
                stopped = "time_limit"
                process.kill()
            elif stop():
                stopped = "cancelled"
                _end(process)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        if process.stdin is not None:
            process.stdin.close()
    return Outcome(process.returncode, stopped, _tail(log), time.monotonic() - started)


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()


def _environment() -> dict[str, str]:
    """That of this process, with the package, and its compiled part, where the worker's Python finds them."""
    paths = [str(PACKAGE_PARENT), *filter(None, [native.folder_of_wheel(), os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def _tail(log: Path) -> str:
    with log.open("rb") as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - _MESSAGES_KEPT))
        return file.read().decode(errors="replace").strip()
