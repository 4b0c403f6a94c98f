"""Files that a folder, a pattern or a path stands for, and the names of their assets."""

from __future__ import annotations

import glob
from collections.abc import Iterator
from pathlib import Path

from ..core.mesh_formats import READABLE

BLEND = ".blend"
SUFFIXES = (*READABLE, BLEND)


def expand(text: str, base: Path, left_out: Path | None = None) -> list[tuple[Path, str]]:
    """Files of an input, each with the name of its asset: its path below the folder, without the suffix.

    Parameters
    ----------
    text : str
        A folder (taken with all below it), a pattern (``**`` matches folders) or a file.
    base : Path
        Where relative paths begin.
    left_out : Path, optional
        A folder whose files are not taken: that of the results.

    Returns
    -------
    list of (Path, str)
        Absolute paths in the order of their names. Hidden files, and of folders and patterns what is no mesh or Blender
        file, are left out; a file named as such is taken whatever it is.
    """
    path = (base / text).absolute()
    if path.is_dir():
        found, root = _files_below(path), path
    elif glob.has_magic(text) and not path.exists():
        found, root = (Path(each) for each in glob.glob(str(path), recursive=True)), _fixed_part(path)
    else:
        return [(path, path.stem)]
    kept = [
        each
        for each in found
        if each.suffix.lower() in SUFFIXES and each.is_file() and not (left_out and each.is_relative_to(left_out))
    ]
    return [(each, each.relative_to(root).with_suffix("").as_posix()) for each in sorted(kept)]


def _files_below(folder: Path) -> Iterator[Path]:
    for path in folder.rglob("*"):
        if not any(part.startswith(".") for part in path.relative_to(folder).parts):
            yield path


def _fixed_part(pattern: Path) -> Path:
    """The deepest folder above everything that a pattern can match."""
    parts = pattern.parts
    first = next(place for place, part in enumerate(parts) if glob.has_magic(part))
    return Path(*parts[:first])
