"""The worker's work: from the request's file to the result's."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .bundle import save_fields
from .kinds import load_request
from .messages import Message, done_message, progress_message

REQUEST = "request.npz"
RESULT = "result.npz"


def run(folder: str, send: Callable[[Message], None]) -> None:
    """Solves the request in a folder, writes the result there, and tells so.

    Parameters
    ----------
    folder : str
    send : callable(message)
        Receives progress, and that the result is complete.

    Raises
    ------
    Exception
        Whatever the run raises.
    """
    request = load_request(Path(folder, REQUEST))
    result = request.solve(progress=lambda stage, fraction: send(progress_message(stage, fraction)))
    save_fields(Path(folder, RESULT), result)
    send(done_message())
