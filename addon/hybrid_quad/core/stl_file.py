"""Triangles from STL files, text and binary."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator

import numpy as np

from .equal_points import Indices, merged_points
from .mesh_arrays import FloatArray
from .number_words import coordinates

_BLOCK = 1 << 20  # bytes
_HEAD = 84  # bytes before the first triangle: any text, and how many there are
_TRIANGLE = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# What the lines that begin and end a solid call it, which may be anything: "my vertex model".
_NAME = re.compile(rb"^[ \t]*(?:end)?solid\b(?:(?!facet\s+normal)[^\n])*", re.MULTILINE)


def read_stl(data: bytes) -> tuple[FloatArray, Indices]:
    """Vertices (n, 3), those with the very same coordinates made one, and triangles (m, 3) of an STL file.

    Parameters
    ----------
    data : bytes
        The whole file.

    Raises
    ------
    ValueError
        If it is no STL file, or ends within a triangle.
    """
    count = int(np.frombuffer(data, "<u4", 1, _HEAD - 4)[0]) if len(data) >= _HEAD else -1
    end = _HEAD + count * _TRIANGLE.itemsize
    # Binary files may begin with the word "solid" as texts do, and may have something behind their triangles. In a text
    # letters are in the place of the count, which are more triangles than it could hold; and zeros are in none.
    if count >= 0 and end <= len(data):
        with np.errstate(invalid="ignore"):  # bytes may be numbers that signal
            points = np.frombuffer(data, _TRIANGLE, count, _HEAD)["corners"].reshape(-1, 3).astype(np.float64)
    elif data.removeprefix(codecs.BOM_UTF8).lstrip()[:5].lower() == b"solid" and b"\0" not in data[:_HEAD]:
        points = _points_of_text(data.removeprefix(codecs.BOM_UTF8))
    else:
        raise ValueError("no STL file, or one that ends too early")
    if len(points) % 3:
        raise ValueError("the STL file ends within a triangle")
    first, triangles = merged_points(points)
    return points[first], triangles.reshape(-1, 3)


def _points_of_text(data: bytes) -> FloatArray:
    parts: list[FloatArray] = []
    count, left = 0, list[bytes]()
    for block in _blocks(data.replace(b"\r", b"\n")):
        words = left + _NAME.sub(b"", block.lower()).split()
        begins = [place for place, word in enumerate(words) if word == b"vertex"]
        whole = [at for at in begins if at + 3 < len(words)]
        left = words[begins[len(whole)] :] if len(whole) < len(begins) else []
        parts.append(coordinates([word for at in whole for word in words[at + 1 : at + 4]], 3, count).reshape(-1, 3))
        count += len(whole)
    if left:
        raise ValueError("the STL file ends within a triangle")
    return np.concatenate(parts)


def _blocks(data: bytes) -> Iterator[bytes]:
    """Parts of a text that end with lines: its words at once would take many times its memory, and keep others waiting."""
    begin = 0
    while begin < len(data):
        end = data.find(b"\n", begin + _BLOCK)
        end = len(data) if end < 0 else end + 1
        yield data[begin:end]
        begin = end
