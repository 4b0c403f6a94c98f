"""Job files: a CSV or JSON list of inputs with settings of their own."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

from ..core.mesh_io import replacing
from .asset import Asset
from .settings import unknown_names

JOB_SUFFIXES = (".csv", ".json")
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
    """Rows of a CSV file with a header, or of a JSON list of objects.

    Raises
    ------
    JobFileError
        If the file cannot be read, a row has no input, or a column is no setting.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise JobFileError(f"{path}: cannot be read: {error}") from error
    rows = _rows_of_csv(path, text) if path.suffix.lower() == ".csv" else _rows_of_json(path, text)
    return [_row(path, number, row) for number, row in rows]


def write_job_file(path: Path, assets: Iterable[Asset]) -> None:
    """Writes assets as a JSON job file with absolute paths, so that every machine takes the same ones in the same order.

    Raises
    ------
    MeshFileError
        If it cannot be written.
    """
    rows = []
    for asset in assets:
        values = asdict(asset)
        named = {"input": values["source"], "name": values["name"], "object": values["object_name"]}
        rows.append({key: value for key, value in {**named, **values["settings"]}.items() if value != ""})
    with replacing(path) as file:
        file.write((json.dumps(rows, indent=1) + "\n").encode())


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
