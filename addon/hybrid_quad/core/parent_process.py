"""A worker process that does not outlive whoever started it."""

from __future__ import annotations

import os
import sys
import threading

LEFT_ALONE = 4  # the exit status of a run that was stopped from outside


def end_with_stdin() -> None:
    """Ends this process as soon as its standard input is closed.

    Whoever starts it holds the other end of a pipe and never writes to it. However that process ends, by SIGKILL too, the
    system closes the pipe. Needs no signal or call of one system, so it works wherever Python does; and the thread that
    waits runs during a solve, which holds no lock of the interpreter.
    """

    def wait() -> None:
        try:
            while os.read(stream, 4096):
                pass
        finally:
            os._exit(LEFT_ALONE)

    stream = sys.stdin.fileno()
    threading.Thread(target=wait, name="end with stdin", daemon=True).start()
