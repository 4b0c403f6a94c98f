"""What worker processes compute of a task: the quads, then what these take along from the source."""

from __future__ import annotations

from typing import Any

import bpy

from ..core.errors import Cancelled
from ..core.remesh import RemeshResult
from ..core.stage_names import in_words
from ..worker.interpreter import worker_command
from ..worker.kinds import Request
from ..worker.known_results import KnownResults, key_of
from ..worker.process import WorkerRun
from ..worker.transfer_request import STAGE, TransferredData
from .remesh_task import RemeshTask

_SOLVED = 0.95  # how much of the whole is done when the quads are there


class TaskSolving:
    """Two workers, one after the other. What a former run of this session gave for the very same is not computed again.

    Attributes
    ----------
    is_known : bool
        Whether a former run's quads are taken, so that none are made.
    """

    def __init__(self, task: RemeshTask) -> None:
        """Begins.

        Raises
        ------
        OSError
            If a worker cannot be begun.
        """
        self._task = task
        self._keys: dict[str, bytes] = {}  # of the requests to worker processes, by kind
        self._quads: WorkerRun[RemeshResult] | None = None
        self._result: RemeshResult | None = None
        self._transfer: WorkerRun[TransferredData] | None = None
        self._carried: TransferredData | None = None
        self._is_dropped = False
        request = task.request()
        self._keys["remesh"] = key_of(request)
        known = _known_quads.find(self._keys["remesh"])
        self.is_known = known is not None
        if known is None:
            self._quads = _worker(request, "start")
        else:
            self._result = known
            self._begin_transfer(known)

    @property
    def worker(self) -> WorkerRun[RemeshResult] | WorkerRun[TransferredData] | None:
        """The process that is at work, or was last; None where all was known."""
        return self._transfer or self._quads

    @property
    def fraction(self) -> float:
        """How much is done, 0 to 1."""
        if self.is_finished:
            return 1.0
        if self._transfer is None:
            return 0.0 if self._quads is None else _SOLVED * self._quads.fraction
        return _SOLVED + (1 - _SOLVED) * self._transfer.fraction

    @property
    def is_finished(self) -> bool:
        """Whether nothing goes on any more, for better or worse."""
        if self._is_between:
            return False
        return self.worker is None or self.worker.is_finished

    @property
    def has_result(self) -> bool:
        """Whether all has ended well."""
        return self._carried is not None or (self._transfer is not None and self._transfer.has_result)

    def poll(self) -> bool:
        """Looks how far it is, without waiting, and does what is next; whether it has ended.

        Raises
        ------
        OSError
            If a worker cannot be begun.
        """
        if self._is_between:
            self._go_on()
        elif self.worker is not None:
            self.worker.poll()
        return self.is_finished

    def cancel(self) -> None:
        """Ends what goes on, and begins nothing more; :meth:`result` then raises Cancelled. What has ended stays as it is."""
        self._is_dropped = True
        if self.worker is not None:
            self.worker.cancel()

    def wait(self) -> None:
        """Returns when it has ended."""
        while not self.poll():
            if self.worker is not None:
                self.worker.wait()

    def result(self) -> RemeshResult:
        """The quads; waits for the whole, and raises what that raised, see :meth:`.process.WorkerRun.result`."""
        self.carried()
        assert self._result is not None
        return self._result

    def carried(self) -> TransferredData:
        """What the result takes along, as :meth:`result`."""
        self.wait()
        if self._carried is not None:
            return self._carried
        if self._transfer is None:
            if self._quads is not None:
                self._quads.result()  # which raises, but for one that was ended between the two halves
            raise Cancelled(f"cancelled before {in_words(STAGE)}")
        self._carried = self._transfer.result()
        _known_data.keep(self._keys["transfer"], self._carried)
        return self._carried

    @property
    def _is_between(self) -> bool:
        is_solved = self._quads is not None and self._quads.has_result
        return is_solved and self._transfer is None and self._carried is None and not self._is_dropped

    def _go_on(self) -> None:
        """What comes between the quads and what they take along, in two steps."""
        assert self._quads is not None
        if self._result is None:
            self._result = self._quads.result()
            _known_quads.keep(self._keys["remesh"], self._result)
        else:
            self._begin_transfer(self._result)

    def _begin_transfer(self, result: RemeshResult) -> None:
        """A worker computes what the result takes along, unless a former run has done so."""
        request = self._task.transfer_request(result)
        self._keys["transfer"] = key_of(request)
        self._carried = _known_data.find(self._keys["transfer"])
        if self._carried is None:
            self._transfer = _worker(request, STAGE)


def _worker(request: Request[Any], first_stage: str) -> WorkerRun[Any]:
    return WorkerRun(
        request,
        temporary_folder=bpy.app.tempdir or None,
        command=worker_command(host=bpy.app.binary_path),
        first_stage=first_stage,
    )


_known_quads: KnownResults[RemeshResult] = KnownResults()
_known_data: KnownResults[TransferredData] = KnownResults()


def forget_results() -> None:
    """Lets go of the results of former runs."""
    _known_quads.clear()
    _known_data.clear()
