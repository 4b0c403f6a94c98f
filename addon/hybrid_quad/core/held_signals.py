"""Steps that no signal may cut in two: one that comes meanwhile acts as soon as they are done, and is never lost."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from types import FrameType

# SIGHUP, of a terminal that is gone, is not there on Windows.
ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextlib.contextmanager
def signals_held() -> Iterator[list[int]]:
    """Signals that end a program wait for the end of the block, which gets a list of those that came.

    They then act as they would have, unless the block has emptied the list. Those that are ignored, or that are handled
    by other than Python, and those of other threads than the main one, are as ever.
    """
    came: list[int] = []

    def keep(number: int, _frame: FrameType | None) -> None:
        came.append(number)

    handlers = {number: signal.getsignal(number) for number in ENDING}
    handlers = {number: handler for number, handler in handlers.items() if handler not in (None, signal.SIG_IGN)}
    held: list[int] = []
    try:
        with contextlib.suppress(ValueError):  # not in the main thread, which alone is interrupted
            for number in handlers:
                signal.signal(number, keep)
                held.append(number)
        yield came
    finally:
        for number in held:
            signal.signal(number, handlers[number])
        for number in came[:1]:  # the others would end what ends already
            signal.raise_signal(number)
