"""Where files are read from and put: what is wrong with a place, and files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import BinaryIO


class MeshFileError(Exception):
    """A file cannot be read or written as a mesh; the message names it and says why."""


def check_place(path: str | os.PathLike[str]) -> None:
    """Raises MeshFileError where no file could be put at `path`."""
    path = Path(path)
    if not path.parent.is_dir():
        raise MeshFileError(f"{path}: the folder {path.parent} does not exist")
    if path.is_dir():
        raise MeshFileError(f"{path}: is a folder")
    if path.exists() and not path.is_file():  # a device, say: it must not be replaced by a file
        raise MeshFileError(f"{path}: is no regular file")
    if not os.access(path.parent, os.W_OK):
        raise MeshFileError(f"{path}: the folder {path.parent} cannot be written to")


def check_apart(path: str | os.PathLike[str] | None, others: Iterable[str | os.PathLike[str] | None]) -> None:
    """Raises MeshFileError where `path`, which is to be written, is one of `others`, which are read or written by the same run."""
    if path is None:
        return
    place = os.path.normcase(os.path.realpath(path))
    if any(place == os.path.normcase(os.path.realpath(other)) for other in others if other):
        raise MeshFileError(f"{path}: is named twice, and would be written over")


@contextlib.contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns what goes wrong with a file, or its contents, into a MeshFileError that names it."""
    try:
        yield
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    except (ValueError, IndexError, OverflowError) as error:
        raise MeshFileError(f"{path}: {error}") from error


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """A file that takes the place of `path` once everything is in it, and vanishes if anything goes wrong before."""
    path = Path(path)
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    try:
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.unlink(name)
        if isinstance(error, OSError):
            raise MeshFileError(f"{path}: {error.strerror or error}") from error
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")  # Windows' programs put a mark before the text
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
