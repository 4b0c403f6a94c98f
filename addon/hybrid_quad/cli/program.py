"""The process of ``hybrid-quad``: what is to be settled before NumPy is loaded, and the command."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import NoReturn

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
        print("hybrid-quad: cancelled; nothing was written", file=sys.stderr)
        status = exit_codes.CANCELLED
    if sys.argv[1:2] == ["remesh"]:
        _end(status)
    return status


def _end(status: int) -> NoReturn:
    """Ends the process at once: all files are closed, and to give the memory back piece by piece takes a thirtieth of a short run."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # closed, or none
            stream.flush()
    os._exit(status)
