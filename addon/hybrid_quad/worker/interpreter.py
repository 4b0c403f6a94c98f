"""Which program runs the worker: the Python that Blender brings along, or, where that has no program, Blender."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..core.python_programs import python_programs

CHILD = Path(__file__).with_name("child.py")


def worker_command(host: str = "", candidates: Sequence[Path] | None = None) -> list[str]:
    """Program and arguments of a worker.

    Parameters
    ----------
    host : str
        Path of the program that this Python is built into, Blender's ``bpy.app.binary_path``; empty where Python is the
        program.
    candidates : sequence of Path, optional
        Where to look for a Python, the best first; by default those that belong to the running one.

    Raises
    ------
    FileNotFoundError
        If there is neither a Python nor a host.
    """
    for path in python_programs() if candidates is None else candidates:
        if path.is_file() and path != Path(host):
            # Isolated: neither the environment nor the user's own packages can break it.
            return [str(path), "-I", str(CHILD)]
    if host:
        return [
            host,
            "--background",
            "--factory-startup",
            "-noaudio",
            "--python-exit-code",
            "1",
            "--python",
            str(CHILD),
            "--",
        ]
    raise FileNotFoundError("no Python program was found that could do the work in a process of its own")
