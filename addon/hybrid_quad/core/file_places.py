"""Where files are read from and put: what is wrong with a place, and files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

from .held_signals import signals_held


class MeshFileError(Exception):
    """A file cannot be read or written as a mesh; the message names it and says why."""


class UnwritableFileError(MeshFileError):
    """A file cannot be written."""


def name_and_reason(error: OSError) -> str:
    """What the system says, with the file as far as it is known."""
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)


def check_place(path: str | os.PathLike[str]) -> None:
    """Raises UnwritableFileError where no file could be put at `path`."""
    path, folder = Path(path), _place_of(path).parent
    if not folder.is_dir():
        raise UnwritableFileError(f"{path}: the folder {folder} does not exist")
    if path.is_dir():
        raise UnwritableFileError(f"{path}: is a folder")
    if path.exists() and not path.is_file():  # a device, say: it must not be replaced by a file
        raise UnwritableFileError(f"{path}: is no regular file")
    if path.exists() and not os.access(path, os.W_OK):  # a folder's owner could replace it all the same
        raise UnwritableFileError(f"{path}: is write-protected")
    if not os.access(folder, os.W_OK):
        raise UnwritableFileError(f"{path}: the folder {folder} cannot be written to")


def check_apart(path: str | os.PathLike[str] | None, others: Iterable[str | os.PathLike[str] | None]) -> None:
    """Raises UnwritableFileError where `path`, to be written, is one of `others`, which a run reads or writes too."""
    if path is None:
        return
    place = os.path.normcase(os.path.realpath(path))
    if any(place == os.path.normcase(os.path.realpath(other)) for other in others if other):
        raise UnwritableFileError(f"{path}: is named twice, and would be written over")


def require_regular(path: str | os.PathLike[str]) -> None:
    """Raises OSError where `path` is a pipe or a device, from which one might read for ever."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):  # of a folder the system says so itself
        raise OSError(errno.EINVAL, "is no regular file", os.fspath(path))


@contextlib.contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns what goes wrong with a file, or its contents, into a MeshFileError that names it."""
    try:
        require_regular(path)
        yield
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    except (ValueError, IndexError, OverflowError) as error:
        raise MeshFileError(f"{path}: {error}") from error


class FilesTogether:
    """Files that take their places at one go, once everything is in all of them; none does if anything goes wrong before.

    For use as a context, at whose end that is done, in the order in which they were written; no signal comes between.

    Attributes
    ----------
    are_in_place : bool
        Whether it is done; what interrupts a run after that is too late.
    """

    def __init__(self) -> None:
        self.are_in_place = False
        self._ready: list[tuple[str | os.PathLike[str], str, Path]] = []

    def __enter__(self) -> FilesTogether:
        return self

    @contextlib.contextmanager
    def replacing(self, path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
        """As the function of that name, but that the file takes the place of `path` only at the end of all.

        Raises
        ------
        UnwritableFileError
        """
        place = _place_of(path)
        name = ""
        try:
            with signals_held():  # nobody would know of the file
                # Not named after the file, whose name may be as long as names can be.
                handle, name = tempfile.mkstemp(prefix=".hybrid-quad.", suffix=".part", dir=place.parent)
                opened = os.fdopen(handle, "wb")
            with opened as file:
                yield file
                put_on_disk(file)
            os.chmod(name, _permissions(place))
            self._ready.append((path, name, place))
        except BaseException as error:
            if name:
                _remove(name)
            if isinstance(error, OSError):
                raise UnwritableFileError(f"{path}: {error.strerror or error}") from error
            raise

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with signals_held() as came:
            try:
                if kind is None and not came:
                    self._put_in_place()
            finally:
                for _, name, _ in self._ready:
                    _remove(name)

    def _put_in_place(self) -> None:
        while self._ready:
            path, name, place = self._ready[0]
            try:
                os.replace(name, place)
            except OSError as error:
                raise UnwritableFileError(f"{path}: {error.strerror or error}") from error
            del self._ready[0]
        self.are_in_place = True


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """A file that takes the place of `path` once everything is in it, and vanishes if anything goes wrong before.

    A link stays one: what it leads to is replaced. The permissions of a file that is replaced stay.

    Raises
    ------
    UnwritableFileError
    """
    with FilesTogether() as files, files.replacing(path) as file:
        yield file


def _remove(name: str) -> None:
    with signals_held(), contextlib.suppress(OSError):
        os.unlink(name)


def put_on_disk(file: BinaryIO) -> None:
    """Writes out what is still in memory; raises OSError where that cannot be done, as on a full disk."""
    file.flush()
    os.fsync(file.fileno())


def _place_of(path: str | os.PathLike[str]) -> Path:
    """Where the file is that a link leads to, or `path` where it is none."""
    return Path(os.path.realpath(path) if os.path.islink(path) else path)


def _permissions(place: Path) -> int:
    """Those of the file that is there, or else the usual ones."""
    try:
        return place.stat().st_mode & 0o777
    except FileNotFoundError:
        return 0o666 & ~_umask()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")  # Windows' programs put a mark before the text
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
