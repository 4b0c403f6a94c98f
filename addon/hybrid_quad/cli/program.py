"""The process of ``hybrid-quad``: what is to be settled before NumPy is loaded, and the command.

Loads next to nothing itself, nor does what Python loads before it: only in :func:`main` is an interruption answered.
"""

from __future__ import annotations

import os
import sys

from . import exit_codes


def main() -> int:
    """Runs ``hybrid-quad`` in a process of its own and returns its exit status."""
    # NumPy's linear algebra, which hardly anything here uses, would start a thread for every core, and these wait busily. Not in
    # `main` or the package: where others load those, as Blender does, this is not for us to say.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from .main import main as command

        status = command()
    except KeyboardInterrupt:  # before there is a command to answer it
        from .messages import say

        say("cancelled; nothing was written")
        status = exit_codes.CANCELLED
    _finish_streams()
    if sys.argv[1:2] in (["remesh"], ["check"]):
        # At once: all files are closed, to give the memory back piece by piece takes a thirtieth of a short run, and a
        # thread may be left that still reads what is no longer wanted.
        os._exit(status)
    return status


def _finish_streams() -> None:
    """Writes out what is left. A stream that takes nothing then leads nowhere: Python would end with another status."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (AttributeError, ValueError):  # none, or closed
            pass
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
