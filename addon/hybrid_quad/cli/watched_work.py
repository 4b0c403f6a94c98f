"""Work that asks nobody whether to go on, such as reading files, ended by limits and signals all the same."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

Result = TypeVar("Result")

_INTERVAL = 0.05  # seconds


def watched(work: Callable[[], Result], check: Callable[[], object]) -> Result:
    """What `work` gives, on a thread of its own, while this one can be interrupted and asks `check` twenty times a second.

    Whatever `check`, a signal's handler or `work` raises is raised. Work that is left goes on unheeded, maybe in compiled code:
    a process should then end by ``os._exit``, which waits for nothing.
    """
    results: list[Result] = []
    errors: list[BaseException] = []
    done = threading.Event()

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:
            errors.append(error)
        finally:
            done.set()

    threading.Thread(target=run, name="watched work", daemon=True).start()
    while not done.wait(_INTERVAL):
        check()
    if errors:
        raise errors.pop()
    return results.pop()
