"""One process at a time for an asset, whatever becomes of it."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows: only one batch at a time may use an output folder there
    fcntl = None  # type: ignore[assignment]

_PAUSE = 0.05  # seconds between two looks at a lock that is taken


@contextlib.contextmanager
def asset_lock(path: Path, give_up: Callable[[], bool]) -> Iterator[int | None]:
    """Holds the lock file `path`; gives its descriptor, or None where `give_up` became true before it was free.

    A process that inherits the descriptor holds the lock as well. So after a batch was killed, the next one waits until
    the worker processes of the first are gone too. The system frees the lock of a process that dies. On Windows there is no lock,
    and -1 is given.
    """
    if fcntl is None:
        yield -1
        return
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    try:
        yield descriptor if _wait_for(descriptor, give_up) else None
    finally:
        os.close(descriptor)


def _wait_for(descriptor: int, give_up: Callable[[], bool]) -> bool:
    while True:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if give_up():
                return False
            time.sleep(_PAUSE)
