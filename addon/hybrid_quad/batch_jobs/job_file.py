"""Job files: a CSV or JSON list of inputs with settings of their own; JSON also one object a line."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TextIO

from ..core.file_places import replacing
from .asset import Asset
from .settings import unknown_names

LINES = ".jsonl"  # of which a part is read without the rest
JOB_SUFFIXES = (".csv", ".json", LINES)
_NOT_SETTINGS = ("input", "name", "object")


class JobFileError(Exception):
    """A list of jobs that cannot be used at all; the message names it and says why."""


class Row(NamedTuple):
    """An input with its settings as they are in the file, ``""`` where nothing is said."""

    input: str
    name: str
    object: str
    settings: dict[str, Any]


def read_job_file(path: Path) -> list[Row]:
    """Rows of a CSV file with a header, of a JSON list of objects, or of a file with a JSON object a line.

    Raises
    ------
    JobFileError
        If the file cannot be read, a row has no input, or a column is no setting.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise JobFileError(f"{path}: cannot be read: {error}") from error
    read = {".csv": _rows_of_csv, LINES: _rows_of_lines}.get(path.suffix.lower(), _rows_of_json)
    return [_row(path, number, row) for number, row in read(path, text)]


def read_some_lines(path: Path, ranges: Sequence[tuple[int, int]]) -> list[Row]:
    """Rows of a `LINES` file whose numbers, from 0, are in some ranges with both ends; the others are not looked at.

    Raises
    ------
    JobFileError
        As :func:`read_job_file` does.
    """
    try:
        with path.open(encoding="utf-8-sig") as file:
            chosen = [line for number, line in _numbered(file) if any(a <= number <= b for a, b in ranges)]
    except (OSError, UnicodeDecodeError) as error:
        raise JobFileError(f"{path}: cannot be read: {error}") from error
    return [_row(path, where, row) for where, row in _rows_of_lines(path, "\n".join(chosen))]


def write_job_file(path: Path, assets: Iterable[Asset]) -> None:
    """Writes assets as a JSON job file with absolute paths, so that every machine takes the same ones in the same order.

    One object a line where the name ends in `LINES`.

    Raises
    ------
    MeshFileError
        If it cannot be written.
    """
    rows = (_as_row(asset) for asset in assets)
    with replacing(path) as file:
        if path.suffix.lower() == LINES:
            file.writelines((json.dumps(row) + "\n").encode() for row in rows)
        else:
            file.write((json.dumps(list(rows), indent=1) + "\n").encode())


def _as_row(asset: Asset) -> dict[str, Any]:
    named = {"input": asset.source, "name": asset.name, "object": asset.object_name}
    return {key: value for key, value in {**named, **asset.settings}.items() if value != ""}


def _rows_of_csv(path: Path, text: str) -> list[tuple[str, dict[str, Any]]]:
    reader = csv.DictReader(io.StringIO(text, newline=""), skipinitialspace=True, restkey="")
    return [(f"line {reader.line_num}", {(key or "").strip(): value for key, value in row.items()}) for row in reader]


def _rows_of_json(path: Path, text: str) -> list[tuple[str, dict[str, Any]]]:
    try:
        rows = json.loads(text)
    except ValueError as error:
        raise JobFileError(f"{path}: no JSON: {error}") from error
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise JobFileError(f'{path}: must be a list of objects, as [{{"input": "a.obj", "quads": 500}}]')
    return [(f"entry {number}", row) for number, row in enumerate(rows)]


def _rows_of_lines(path: Path, text: str) -> list[tuple[str, dict[str, Any]]]:
    rows = []
    for number, line in _numbered(io.StringIO(text)):
        try:
            row = json.loads(line)
        except ValueError as error:
            raise JobFileError(f"{path}: no JSON object in a line: {line.strip()[:100]!r}: {error}") from error
        if not isinstance(row, dict):
            raise JobFileError(f"{path}: no JSON object in a line: {line.strip()[:100]!r}")
        rows.append((f"entry {number}", row))
    return rows


def _numbered(file: TextIO) -> Iterator[tuple[int, str]]:
    """Lines that are not empty, and their numbers from 0."""
    return enumerate(line for line in file if not line.isspace())


def _row(path: Path, where: str, row: dict[str, Any]) -> Row:
    settings = {key: value for key, value in row.items() if key not in _NOT_SETTINGS}
    unknown = unknown_names(settings)
    if unknown:
        raise JobFileError(f"{path}: {where}: no such setting: {_listed(unknown)}")
    texts = [row.get(key) or "" for key in _NOT_SETTINGS]
    if not all(isinstance(text, str) for text in texts):
        raise JobFileError(f"{path}: {where}: input, name and object must be texts")
    if not texts[0].strip():
        raise JobFileError(f"{path}: {where}: has no input")
    source, name, object_name = (text.strip() for text in texts)
    return Row(source, name, object_name, settings)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(repr(name) for name in names)
