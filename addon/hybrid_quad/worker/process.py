"""A run in a process of its own, seen from outside.

No thread waits for it: Blender's Python is not made for threads that outlive a script. Whoever wants to know how far the
run is asks; the worker writes what it has to say into a file, so that it never waits for anybody either.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, BinaryIO, Generic, TypeVar

from ..core.errors import Cancelled
from ..core.stage_names import while_in
from .bundle import load_fields
from .death import WorkerDied
from .idleness import Idleness
from .interpreter import worker_command
from .kinds import Request
from .messages import Message, decode, error_of
from .run import request_path, result_path, stop_path
from .stage_errors import told_with_stage

Result = TypeVar("Result")

PACKAGE = Path(__file__).resolve().parents[1]

_ORDER = "order.json"
_MESSAGES = "messages.jsonl"
_LOG = "log.txt"

_GRACE = 5.0  # seconds past its time limit after which a run that should have ended itself is ended
_LEAVING = 1.0  # seconds that a killed process gets to be gone
_INTERVAL = 0.01  # seconds between two looks while somebody waits
_LOG_SHOWN = 4000  # characters
_HANGS = 60.0  # seconds without news and without any use of a processor after which a run is ended


class WorkerSeat:
    """A worker process that waits for a request, or for one after the other: everything that it needs is loaded.

    Attributes
    ----------
    stays : bool
        Whether it waits for another request after one.
    requests : int
        How many it was given.
    """

    def __init__(
        self, *, stays: bool = False, temporary_folder: str | None = None, command: Sequence[str] | None = None
    ) -> None:
        """Starts the process.

        Parameters
        ----------
        stays : bool
            Whether it is to answer one request after the other, and so to know what they have in common.
        temporary_folder : str, optional
            Where the run's own folder is made, which is private and removed with the run; by default the system's.
        command : sequence of str, optional
            Program and arguments, by default :func:`.interpreter.worker_command`. The order's file is added.

        Raises
        ------
        OSError
            If files cannot be written or the program cannot be started.
        """
        self.stays = stays
        self.requests = 0
        self.folder = Path(tempfile.mkdtemp(prefix="hybrid_quad_", dir=temporary_folder))
        try:
            self.messages: BinaryIO = _created(self.folder / _MESSAGES)
            self.process = _start(worker_command() if command is None else command, self.folder, stays)
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise

    def is_there(self) -> bool:
        """Whether the process runs."""
        return self.process.poll() is None

    def hand_over(self, request: Request[Any]) -> int:
        """Gives the process its next request; its number.

        Raises
        ------
        OSError
            If it cannot be written; the process is then gone.
        """
        try:
            part = self.folder / "part.npz"
            request.save(part)
            part.replace(request_path(self.folder, self.requests))
        except BaseException:
            self.leave()
            raise
        self.requests += 1
        return self.requests - 1

    def leave(self) -> None:
        """Makes sure that the process is gone, and its files with it."""
        self.process.kill()
        if self.process.stdin is not None:
            self.process.stdin.close()
        # One that the system holds back dies later, and is asked for when the next one is started.
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(_LEAVING)
        self.messages.close()
        shutil.rmtree(self.folder, ignore_errors=True)


class WorkerRun(Generic[Result]):
    """Solves a request in another process.

    Attributes
    ----------
    stage : str
        What ran when :meth:`poll` looked last.
    fraction : float
        How much of the whole was done then, 0 to 1.
    is_finished : bool
        Whether there was a result or an error then.
    seat : WorkerSeat
        The process. One that stays waits for another request after a run that did not fail.
    """

    def __init__(
        self,
        request: Request[Result],
        *,
        temporary_folder: str | None = None,
        command: Sequence[str] | None = None,
        seat: WorkerSeat | None = None,
        first_stage: str = "start",
    ) -> None:
        """Starts the process and writes the request.

        Parameters
        ----------
        request : Request
        temporary_folder, command : optional
            See :class:`WorkerSeat`.
        seat : WorkerSeat, optional
            A process that waits already. It belongs to this run from now on; one that stays, until the run has ended.
        first_stage : str
            What the run is said to do until it says so itself.

        Raises
        ------
        OSError
            If files cannot be written or the program cannot be started.
        """
        self.stage = first_stage
        self.fraction = 0.0
        self.is_finished = False
        self._error: Exception | None = None
        self._result: Result | None = None
        self._result_type = request.result_type
        self._limit = request.time_limit
        self._began = self._news = time.monotonic()
        self.seat = seat or WorkerSeat(temporary_folder=temporary_folder, command=command)
        self._process, self._messages, self._folder = self.seat.process, self.seat.messages, self.seat.folder
        self._number = self.seat.hand_over(request)
        self._idleness = Idleness(self._process.pid)

    @property
    def has_result(self) -> bool:
        """Whether the run has ended well."""
        return self._result is not None

    @property
    def silent_seconds(self) -> float:
        """How long ago the worker last told how far it is."""
        return time.monotonic() - self._news

    @property
    def process_id(self) -> int:
        """Of the worker."""
        return self._process.pid

    def poll(self) -> bool:
        """Looks how far the run is, without waiting; whether it has ended."""
        if self.is_finished:
            return True
        # First, so that what a process said before it ended is read.
        has_ended = self._process.poll() is not None
        last = self._read_messages()
        if last is not None:
            self._take(last)
        elif has_ended:
            self._end(WorkerDied(self.stage, self._process.returncode, self._end_of_log()))
        elif self._limit is not None and time.monotonic() - self._began > self._limit + _GRACE:
            text = f"the time limit of {self._limit:g} s is over, and the run did not answer any more "
            self._end(Cancelled(text + while_in(self.stage), "time_limit"))
        elif self._idleness.seconds() > _HANGS:
            cause = f"it hung: for {_HANGS:.0f} s it told nothing and used no processor"
            self._end(WorkerDied(self.stage, 0, self._end_of_log(), cause))
        return self.is_finished

    def cancel(self) -> None:
        """Kills the worker, whatever it does; :meth:`result` then raises Cancelled.

        A run that has ended before stays as it is.
        """
        if not self.is_finished:
            self._end(Cancelled(f"cancelled {while_in(self.stage)}"))

    def abandon(self) -> None:
        """Like :meth:`cancel`, but a worker that stays is not killed: it stops within a moment and waits for another request."""
        if not self.seat.stays:
            self.cancel()
        elif not self.is_finished:
            stop_path(self._folder, self._number).touch()
            self._error, self.is_finished = Cancelled(f"cancelled {while_in(self.stage)}"), True

    def wait(self, timeout: float | None = None) -> bool:
        """Returns when the run has ended, or after some seconds; whether it has."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.poll() and (deadline is None or time.monotonic() < deadline):
            time.sleep(_INTERVAL)
        return self.is_finished

    def result(self) -> Result:
        """The run's result; waits for it.

        Raises
        ------
        InputError, InternalError, ValueError, ImportError, MemoryError, OSError
            What the run raised.
        Cancelled
            After :meth:`cancel`, or at a limit of time or memory.
        WorkerDied
            If the process ended by itself.
        """
        self.wait()
        if self._error is not None:
            raise self._error
        assert self._result is not None
        return self._result

    def _read_messages(self) -> Message | None:
        """Takes notice of progress; the worker's last word, if it has been said."""
        while True:
            place = self._messages.tell()
            line = self._messages.readline()
            if not line.endswith(b"\n"):  # still being written
                self._messages.seek(place)
                return None
            message = decode(line)
            # An earlier run that was abandoned may still say something.
            if message is None or message.get("run", self._number) != self._number:
                continue
            if message["event"] != "progress":
                return message
            self._news = time.monotonic()
            self._idleness.reset()
            self.stage, self.fraction = str(message["stage"]) or self.stage, float(message["fraction"])

    def _take(self, last: Message) -> None:
        """Ends the run with what its last word announces."""
        if last["event"] == "error":
            self._end(told_with_stage(error_of(last), self.stage))
            return
        try:
            path = result_path(self._folder, self._number)
            self._result = self._result_type(**load_fields(path))
            path.unlink()
        except Exception as error:  # for example a disk that is full
            self._end(error)
        else:
            self._end(None)

    def _end(self, error: Exception | None) -> None:
        """Makes sure that the process is gone, and its files with it, unless it is to be kept."""
        self._error = error
        self.is_finished = True
        if error is not None or not self.seat.stays:
            self.seat.leave()

    def _end_of_log(self) -> str:
        return (self._folder / _LOG).read_text(errors="replace")[-_LOG_SHOWN:]


def _created(path: Path) -> BinaryIO:
    """An empty file, open for reading."""
    path.touch()
    return path.open("rb")


def _start(command: Sequence[str], folder: Path, stays: bool) -> subprocess.Popen[bytes]:
    order = {
        "folder": str(folder),
        "stays": stays,
        "messages": str(folder / _MESSAGES),
        "package": str(PACKAGE),
        "sys_path": [os.path.abspath(path) for path in sys.path],
        "python": sys.implementation.cache_tag,
    }
    (folder / _ORDER).write_text(json.dumps(order))
    with (folder / _LOG).open("wb") as log:
        # Nothing is ever written to the input: that it is closed tells the worker that nobody is there any more.
        return subprocess.Popen(
            [*command, str(folder / _ORDER)],
            stdin=subprocess.PIPE,
            stdout=log,
            stderr=log,
            creationflags=_creation_flags(),
        )


def _creation_flags() -> int:
    """On Windows: no console window, and other programs first."""
    names = ("CREATE_NO_WINDOW", "BELOW_NORMAL_PRIORITY_CLASS")
    return sum(int(getattr(subprocess, name, 0)) for name in names)
