"""Where the program of the running Python is, which inside Blender is not what ``sys.executable`` says."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path


def python_program() -> str:
    """The first of :func:`python_programs` that is there.

    Raises
    ------
    FileNotFoundError
        If none is.
    """
    for path in python_programs():
        if path.is_file():
            return str(path)
    raise FileNotFoundError(2, "no Python program was found for a process of its own", sys.prefix)


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
