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
_ARRAY = "$array"  # key of the name of an array, in its place
_NESTED = (np.ndarray, Mapping, list, tuple)


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
    """Writes a dataclass whose fields are arrays, plain values, and lists and dictionaries of these."""
    save_bundle(path, *pack({field.name: getattr(record, field.name) for field in dataclasses.fields(record)}))


def load_fields(path: Path) -> dict[str, Any]:
    """The fields that :func:`save_fields` wrote; tuples come back as lists."""
    return unpack(*load_bundle(path))


def pack(fields: Mapping[str, Any]) -> tuple[Arrays, dict[str, Any]]:
    """The arrays among nested lists and dictionaries, each under a name of its own, and the rest, with names in their places."""
    arrays: Arrays = {}

    def without_arrays(value: Any, place: str) -> Any:
        if isinstance(value, np.ndarray):
            arrays[place] = value
            return {_ARRAY: place}
        if isinstance(value, Mapping):
            return {name: without_arrays(each, f"{place}.{name}") for name, each in value.items()}
        if isinstance(value, (list, tuple)) and any(isinstance(each, _NESTED) for each in value):
            return [without_arrays(each, f"{place}.{index}") for index, each in enumerate(value)]
        return value

    return arrays, {name: without_arrays(value, f"field.{name}") for name, value in fields.items()}


def unpack(arrays: Arrays, values: Mapping[str, Any]) -> dict[str, Any]:
    """What :func:`pack` took apart."""

    def with_arrays(value: Any) -> Any:
        if isinstance(value, dict):
            if value.keys() == {_ARRAY}:
                return arrays[value[_ARRAY]]
            return {name: with_arrays(each) for name, each in value.items()}
        if isinstance(value, list) and any(isinstance(each, _NESTED) for each in value):
            return [with_arrays(each) for each in value]
        return value

    return {name: with_arrays(value) for name, value in values.items()}


def _plain(value: Any) -> Any:
    """A number of numpy's as one of Python's."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be handed over")
