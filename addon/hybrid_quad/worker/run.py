"""The worker's work: from each request's file to its result's."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from pathlib import Path

from ..core import native
from ..core.errors import Cancelled
from ..core.stage_cache import StageCache
from .bundle import save_fields
from .kinds import load_request
from .messages import Message, done_message, progress_message, stopped_message

_INTERVAL = 0.005  # seconds between two looks


def request_path(folder: Path, number: int) -> Path:
    """The file of a request, by which of the worker's it is."""
    return folder / f"request_{number}.npz"


def result_path(folder: Path, number: int) -> Path:
    """The file of its result."""
    return folder / f"result_{number}.npz"


def stop_path(folder: Path, number: int) -> Path:
    """The file that tells that nobody waits for that result any more."""
    return folder / f"stop_{number}"


def run(folder: str, send: Callable[[Message], None], *, stays: bool) -> None:
    """Waits for a request in a folder, solves it, writes the result there, and tells so.

    Parameters
    ----------
    folder : str
    stays : bool
        Whether to wait for another one then, until the process is ended.
    send : callable(message)
        Receives progress, and that a result is complete, with the request's number as ``run``.

    Raises
    ------
    Exception
        Whatever a run raises.
    """
    native.load()  # before it is needed
    cache = StageCache() if stays else None
    for number in itertools.count() if stays else range(1):
        _solve(Path(folder), number, cache, send)
        _clean_up(Path(folder), number - 1)


def _clean_up(folder: Path, number: int) -> None:
    """Removes what nobody came for."""
    if stop_path(folder, number).exists():
        result_path(folder, number).unlink(missing_ok=True)
        stop_path(folder, number).unlink()


def _solve(folder: Path, number: int, cache: StageCache | None, send: Callable[[Message], None]) -> None:
    def tell(message: Message) -> None:
        send({**message, "run": number})

    path, stop = request_path(folder, number), stop_path(folder, number)
    while not path.exists():
        time.sleep(_INTERVAL)
    request = load_request(path)
    path.unlink()
    try:
        result = request.solve(lambda stage, fraction: tell(progress_message(stage, fraction)), stop.exists, cache)
    except Cancelled:
        if not stop.exists():  # a limit was reached
            raise
        tell(stopped_message())
    else:
        save_fields(result_path(folder, number), result)
        tell(done_message())
