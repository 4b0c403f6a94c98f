"""The process of ``hybrid-quad``: what is to be settled before NumPy is loaded, and the command."""

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

        return command()
    except KeyboardInterrupt:  # before there is a command to answer it
        print("hybrid-quad: cancelled; nothing was written", file=sys.stderr)
        return exit_codes.CANCELLED
