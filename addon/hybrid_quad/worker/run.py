"""The worker's work: from the request's file to the result's."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from ..core import native
from .bundle import save_fields
from .kinds import load_request
from .messages import Message, done_message, progress_message

_INTERVAL = 0.005  # seconds between two looks

REQUEST = "request.npz"
RESULT = "result.npz"


def run(folder: str, send: Callable[[Message], None]) -> None:
    """Waits for a request in a folder, solves it, writes the result there, and tells so.

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
    native.load()  # before it is needed
    path = Path(folder, REQUEST)
    while not path.exists():
        time.sleep(_INTERVAL)
    request = load_request(path)
    result = request.solve(progress=lambda stage, fraction: send(progress_message(stage, fraction)))
    save_fields(Path(folder, RESULT), result)
    send(done_message())
