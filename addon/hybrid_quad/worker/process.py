"""A run in a process of its own, seen from outside."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from ..core.errors import Cancelled
from ..core.remesh import RemeshResult
from .bundle import load_fields
from .death import WorkerDied
from .interpreter import worker_command
from .messages import Message, decode, error_of
from .request import RemeshRequest
from .run import REQUEST, RESULT

PACKAGE = Path(__file__).resolve().parents[1]

_GRACE = 5.0  # seconds past its time limit after which a run that should have ended itself is ended
_LEAVING = 5.0  # seconds that a killed process gets to be gone
_LOG = "log.txt"
_LOG_SHOWN = 4000  # characters
_FIRST_STAGE = "start"


class WorkerRun:
    """Solves a request in another process; a thread waits for it.

    Nothing here blocks but :meth:`wait` and :meth:`result`: the request is written, and the result read, by the thread.

    Attributes
    ----------
    stage : str
        What runs now.
    fraction : float
        How much of the whole is done, 0 to 1.
    """

    def __init__(
        self, request: RemeshRequest, *, temporary_folder: str | None = None, command: Sequence[str] | None = None
    ) -> None:
        """Starts the process.

        Parameters
        ----------
        request : RemeshRequest
        temporary_folder : str, optional
            Where the run's own folder is made, which is private and removed with the run; by default the system's.
        command : sequence of str, optional
            Program and arguments, by default :func:`.interpreter.worker_command`.
        """
        self.stage = _FIRST_STAGE
        self.fraction = 0.0
        self._request = request
        self._temporary_folder = temporary_folder
        self._command = list(worker_command() if command is None else command)
        self._news = time.monotonic()
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._stopped: Cancelled | None = None
        self._result: RemeshResult | None = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="hybrid_quad worker", daemon=True)
        self._thread.start()

    @property
    def is_finished(self) -> bool:
        """Whether there is a result or an error."""
        return not self._thread.is_alive()

    @property
    def has_result(self) -> bool:
        """Whether the run has ended well."""
        return self.is_finished and self._stopped is None and self._error is None

    @property
    def silent_seconds(self) -> float:
        """How long ago the worker last told how far it is."""
        return time.monotonic() - self._news

    @property
    def process_id(self) -> int | None:
        """Of the worker, once it is started."""
        return None if self._process is None else self._process.pid

    def cancel(self) -> None:
        """Kills the worker, whatever it does, and does not wait; :meth:`result` then raises Cancelled.

        A run that has ended before stays as it is.
        """
        self._stop(Cancelled(f"cancelled during {self._stage_in_words}"))

    def wait(self, timeout: float | None = None) -> bool:
        """Returns when the run has ended, or after some seconds; whether it has."""
        self._thread.join(timeout)
        return self.is_finished

    def result(self) -> RemeshResult:
        """The finished run's result.

        Raises
        ------
        InputError, InternalError, ValueError, ImportError, MemoryError
            What the run raised.
        Cancelled
            After :meth:`cancel`, or at a limit of time or memory.
        WorkerDied
            If the process ended by itself.
        OSError
            If it could not be started, or handed its data.
        """
        self.wait()
        if self._stopped is not None:
            raise self._stopped
        if self._error is not None:
            raise self._error
        assert self._result is not None
        return self._result

    @property
    def _stage_in_words(self) -> str:
        return self.stage.replace("_", " ")

    def _stop(self, reason: Cancelled) -> None:
        with self._lock:
            if self._stopped is None and self._result is None and self._error is None:
                self._stopped = reason
            if self._process is not None:
                self._process.kill()

    def _run(self) -> None:
        try:
            with tempfile.TemporaryDirectory(
                prefix="hybrid_quad_", dir=self._temporary_folder, ignore_cleanup_errors=True
            ) as folder:
                self._result = self._solve(Path(folder))
        except BaseException as error:  # carried over to the thread that asks
            self._error = error

    def _solve(self, folder: Path) -> RemeshResult:
        self._request.save(folder / REQUEST)
        with (folder / _LOG).open("wb") as log:
            process = self._start(log)
        limit = self._request.options.time_limit
        timer = threading.Timer(limit + _GRACE, self._give_up, [limit]) if limit else None
        if timer is not None:
            timer.daemon = True
            timer.start()
        try:
            last = self._converse(process, folder)
            if last is None:
                raise WorkerDied(self.stage, _status_of(process), _end_of_log(folder))
            if last["event"] == "error":
                error = error_of(last)
                if isinstance(error, MemoryError):
                    raise MemoryError(f"during {self._stage_in_words}") from error
                raise error
            return RemeshResult(**load_fields(folder / RESULT))
        finally:
            if timer is not None:
                timer.cancel()
            _dispose(process)

    def _start(self, log: IO[bytes]) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._stopped is not None:
                raise self._stopped
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                creationflags=_creation_flags(),
            )
            return self._process

    def _converse(self, process: subprocess.Popen[bytes], folder: Path) -> Message | None:
        """Gives the order and listens; the worker's last word, or None if it ended without one."""
        assert process.stdin is not None and process.stdout is not None
        order = {
            "folder": str(folder),
            "package": str(PACKAGE),
            "sys_path": [os.path.abspath(path) for path in sys.path],
            "python": sys.implementation.cache_tag,
        }
        try:
            process.stdin.write(json.dumps(order).encode() + b"\n")
            process.stdin.flush()
        except OSError:  # it is dead already; the exit status tells more
            return None
        for line in process.stdout:
            message = decode(line)
            if message is None:
                continue
            if message["event"] != "progress":
                return message
            self._news = time.monotonic()
            self.stage, self.fraction = str(message["stage"]), float(message["fraction"])
        return None

    def _give_up(self, limit: float) -> None:
        text = (
            f"the time limit of {limit:g} s is over, and the run did not answer any more during {self._stage_in_words}"
        )
        self._stop(Cancelled(text, "time_limit"))


def _status_of(process: subprocess.Popen[bytes]) -> int:
    """Exit status of a process that has closed its output; what does not end then is killed."""
    try:
        return process.wait(_LEAVING)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def _dispose(process: subprocess.Popen[bytes]) -> None:
    """Makes sure that a process is gone and its pipes are closed."""
    process.kill()
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with contextlib.suppress(OSError):  # what could not be written any more
                pipe.close()
    process.wait()


def _end_of_log(folder: Path) -> str:
    return (folder / _LOG).read_text(errors="replace")[-_LOG_SHOWN:]


def _creation_flags() -> int:
    """On Windows: no console window, and other programs first."""
    names = ("CREATE_NO_WINDOW", "BELOW_NORMAL_PRIORITY_CLASS")
    return sum(int(getattr(subprocess, name, 0)) for name in names)
