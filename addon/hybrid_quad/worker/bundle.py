"""Arrays and plain values in one file, by which two processes hand each other their data."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Arrays = dict[str, npt.NDArray[Any]]

_VALUES = "values"  # the one array that holds text


def save_bundle(path: Path, arrays: Mapping[str, npt.NDArray[Any]], values: Mapping[str, Any]) -> None:
    """Writes arrays of numbers, and values that JSON can hold, as an uncompressed ``.npz`` file without pickles.

    Raises
    ------
    TypeError
        If an array holds objects, or a value is nothing for JSON.
    """
    for name, array in arrays.items():
        if name == _VALUES or array.dtype.hasobject:
            raise TypeError(f"{name} cannot be handed over: {array.dtype}")
    text = json.dumps(values, default=_plain)
    members: dict[str, Any] = {_VALUES: np.frombuffer(text.encode(), np.uint8), **arrays}
    np.savez(path, **members)


def load_bundle(path: Path) -> tuple[Arrays, dict[str, Any]]:
    """What :func:`save_bundle` wrote; tuples among the values come back as lists.

    Raises
    ------
    ValueError, OSError, zipfile.BadZipFile
        If the file is not whole. Nothing in it is ever run.
    """
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    return arrays, json.loads(arrays.pop(_VALUES).tobytes().decode())


def save_fields(path: Path, record: Any) -> None:
    """Writes a dataclass whose fields are arrays and plain values."""
    fields = {field.name: getattr(record, field.name) for field in dataclasses.fields(record)}
    arrays = {name: value for name, value in fields.items() if isinstance(value, np.ndarray)}
    save_bundle(path, arrays, {name: value for name, value in fields.items() if name not in arrays})


def load_fields(path: Path) -> dict[str, Any]:
    """The fields that :func:`save_fields` wrote."""
    arrays, values = load_bundle(path)
    return {**arrays, **values}


def _plain(value: Any) -> Any:
    """A number of numpy's as one of Python's."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be handed over")
