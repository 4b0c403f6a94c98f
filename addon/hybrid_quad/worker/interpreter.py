"""Which program runs the worker: the Python that Blender brings along, or, where that has no program, Blender."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

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


def python_programs() -> Iterator[Path]:
    """Where the running Python's own program should be.

    In the folder of its library first: Blender's ``sys.executable`` may be another Python that happens to stand in the
    PATH, where a distribution built Blender with the system's. Blender for Windows and macOS has the same layout,
    ``python/bin``, as for Linux; a virtual environment on Windows has ``Scripts``.
    """
    prefix, version = Path(sys.prefix), f"python{sys.version_info.major}.{sys.version_info.minor}"
    if sys.platform == "win32":
        yield from (prefix / "bin" / "python.exe", prefix / "Scripts" / "python.exe", prefix / "python.exe")
    else:
        yield from (prefix / "bin" / version, prefix / "bin" / "python3")
    if sys.executable and Path(sys.executable).name.startswith("python"):
        yield Path(sys.executable)
