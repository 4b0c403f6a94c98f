"""Which mesh files there are, by the ends of their names."""

from __future__ import annotations

import os
from pathlib import Path

from .file_places import MeshFileError, check_place

READABLE = (".obj", ".ply", ".stl", ".off")
WRITABLE = (".obj", ".ply", ".off")


def check_readable(path: str | os.PathLike[str]) -> None:
    """Raises MeshFileError where `path` is named as no file that can be read."""
    if Path(path).suffix.lower() not in READABLE:
        raise MeshFileError(f"{path}: {_unknown_kind(Path(path))}; read are {', '.join(READABLE)}")


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raises MeshFileError where `path` could never be written, so that no run is wasted on it."""
    path = Path(path)
    if path.suffix.lower() not in WRITABLE:
        raise MeshFileError(f"{path}: {_unknown_kind(path)}; written are {', '.join(WRITABLE)}")
    check_place(path)


def _unknown_kind(path: Path) -> str:
    if not path.suffix:
        return "the name has no ending, which would say of what kind the file is"
    return f"files of kind {path.suffix} are not known here"
