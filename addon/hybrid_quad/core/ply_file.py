"""Polygon meshes from PLY files: text and binary, with whatever else programs put into them.

After G. Turk's "The PLY Polygon File Format" (1994). Not by meshio, which takes the properties of a face for columns, so that
faces with colours or texture coordinates come out wrong, and which Blender's Python does not have.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray
from .number_words import coordinates, whole_number

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    "int64": "i8",
    "uint64": "u8",
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")

IntRow = npt.NDArray[np.int64]


@dataclass(frozen=True)
class _Property:
    name: str
    value: str
    count: str = ""  # the type of a list's length; empty for single values


@dataclass(frozen=True)
class _Element:
    name: str
    times: int
    properties: list[_Property] = field(default_factory=list)


def read_ply(data: bytes) -> tuple[FloatArray, IntRow, IntRow]:
    """Vertices and faces of a PLY file.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    vertices : (n, 3) float64
    sizes : (m,) int64
        How many corners each face has.
    corners : (k,) int64
        Vertices of all faces, one face after the other, as the file has them.

    Raises
    ------
    ValueError
        If it is no PLY file, ends too early, has more than one element of vertices, or a word that is no number where
        one belongs.
    """
    order, elements, body = _header(data)
    rows = _BinaryRows(body, order) if order else _TextRows(body)
    vertices: FloatArray = np.zeros((0, 3))
    faces: Columns = []
    names = [element.name for element in elements]
    if names.count("vertex") > 1:
        raise ValueError("the PLY file has more than one element vertex: which of them its faces mean is unknown")
    strips = "" if "face" in names else "tristrips"
    for element in elements:
        if element.name == "vertex":
            places = [_place_of(element, (axis,)) for axis in "xyz"]
            columns = rows.take(element, places)
            with np.errstate(invalid="ignore"):  # bytes may be numbers that signal
                vertices = np.stack([np.asarray(values, np.float64) for _, values in columns], axis=1)
        elif element.name == "face":
            faces += rows.take(element, [_place_of(element, _CORNERS)])
        elif element.name == strips:
            triangles = _triangles_of_strips(*rows.take(element, [_place_of(element, _CORNERS)])[0])
            faces.append((np.full(len(triangles), 3), triangles.reshape(-1)))
        else:
            rows.take(element, [])
    sizes, corners = (_joined(parts) for parts in zip(*(faces or [_NOTHING]), strict=True))
    return vertices, sizes, corners


def _joined(parts: tuple[Any, ...]) -> Any:
    # As Python's numbers, as their types may have none in common that holds them all.
    return parts[0] if len(parts) == 1 else np.concatenate([part.astype(object) for part in parts])


def _triangles_of_strips(lengths: IntRow, vertices: IntRow) -> IntRow:
    """Triangles (m, 3) of strips: of each three in a row, every second one the other way round; -1 begins a new strip.

    Those that use a vertex twice, which only lead from one part of a strip to the next, are left out.
    """
    ends = np.cumsum(lengths)
    broken = np.insert(vertices.astype(np.int64), ends, -1)  # as if all were one list
    last_break = np.maximum.accumulate(np.where(broken < 0, np.arange(len(broken)), -1))
    triples = np.stack([broken[:-2], broken[1:-1], broken[2:]], axis=1)
    is_odd = (np.arange(len(triples)) - last_break[: len(triples)]) % 2 == 0
    triples[is_odd] = triples[is_odd][:, [1, 0, 2]]
    first, second, third = triples.T
    has_area = (triples >= 0).all(axis=1) & (first != second) & (second != third) & (third != first)
    triangles: IntRow = triples[has_area]
    return triangles


def _place_of(element: _Element, names: Sequence[str]) -> int:
    of_corners = names is _CORNERS
    for place, each in enumerate(element.properties):
        if each.name in names and bool(each.count) == of_corners and not (of_corners and each.value[0] == "f"):
            return place
    raise ValueError(f"its element {element.name} has no property {names[0]}")


def _header(data: bytes) -> tuple[str, list[_Element], bytes]:
    """The byte order (empty: text), the elements, and what follows."""
    data = data.removeprefix(codecs.BOM_UTF8)
    line_end = b"\r" if re.match(rb"ply[ \t]*\r(?!\n)", data) else b"\n"
    order, elements, at = None, list[_Element](), 0
    while True:
        end = data.find(line_end, at)
        words = data[at : end if end >= 0 else len(data)].decode("ascii", "replace").split()
        if at == 0 and words[:1] != ["ply"]:
            raise ValueError("no PLY file")
        if end < 0 and words != ["end_header"]:
            raise ValueError("a PLY file that ends in its header")
        at = end + 1 if end >= 0 else len(data)
        if words == ["end_header"]:
            break
        if words[:1] == ["format"]:
            order = _ORDERS.get(words[1] if len(words) > 1 else "")
        elif words[:1] == ["element"]:
            if len(words) != 3 or not words[2].isdecimal():
                raise ValueError(f"no PLY header: {' '.join(words)!r}")
            elements.append(_Element(words[1], int(words[2])))
        elif words[:1] == ["property"]:
            if not elements:
                raise ValueError("a property stands before all elements of the PLY header")
            elements[-1].properties.append(_property(words[1:]))
    if order is None:
        raise ValueError("no PLY format that is known")
    return order, elements, data[at:]


def _property(words: list[str]) -> _Property:
    types = words[1:3] if words[:1] == ["list"] else words[:1]
    if len(words) != 2 * len(types) or not types or not set(types) <= _TYPES.keys():
        raise ValueError(f"no property of a PLY file: {' '.join(words)!r}")
    if len(types) == 2 and _TYPES[types[0]][0] == "f":
        raise ValueError("a list of the PLY file has a length that is no whole number")
    return _Property(words[-1], _TYPES[types[-1]], _TYPES[types[0]] if len(types) == 2 else "")


Columns = list[tuple[IntRow, Any]]


class _BinaryRows:
    """The rows of a binary file, element by element."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data, self._order, self._at = data, order, 0

    def take(self, element: _Element, wanted: Sequence[int]) -> Columns:
        """Goes on behind the next element; of each wanted property the lengths of its lists and the values."""
        if not element.times or not element.properties:
            return [_NOTHING for _ in wanted]
        lengths = [self._lengths_of_first(element)]
        row = self._row_type(element, lengths[0])
        table = np.frombuffer(
            self._data, row, min(element.times, (len(self._data) - self._at) // row.itemsize), self._at
        )
        lists = [place for place, each in enumerate(element.properties) if each.count]
        alike = all((table[f"n{place}"] == length).all() for place, length in zip(lists, lengths[0], strict=True))
        if alike and len(table) == element.times:
            self._at += table.nbytes
            return [_column(table, place) for place in wanted]
        if not lists:
            raise _too_short(element)
        return self._take_rows_of_all_kinds(element, wanted)

    def _take_rows_of_all_kinds(self, element: _Element, wanted: Sequence[int]) -> Columns:
        """Each kind of rows, those with lists of the same lengths, at once."""
        starts, lengths = self._walk(element)
        lists = [place for place, each in enumerate(element.properties) if each.count]
        found: Columns = []
        for place in wanted:
            sizes = lengths[:, lists.index(place)] if place in lists else np.ones(len(starts), np.int64)
            found.append((sizes, np.zeros(int(sizes.sum()), element.properties[place].value)))
        kinds, kind_of = np.unique(lengths, axis=0, return_inverse=True)
        everything = np.frombuffer(self._data, np.uint8)
        for number, kind in enumerate(kinds):
            rows = np.flatnonzero(kind_of.reshape(-1) == number)
            row = self._row_type(element, kind.tolist())
            table = everything[starts[rows, None] + np.arange(row.itemsize)].view(row).reshape(-1)
            for place, (sizes, values) in zip(wanted, found, strict=True):
                each = table[f"v{place}"].reshape(len(rows), -1)
                first = (np.cumsum(sizes) - sizes)[rows, None]
                values[first + np.arange(each.shape[1])] = each
        return found

    def _walk(self, element: _Element) -> tuple[IntRow, IntRow]:
        """Where each row begins (n,), and the lengths of its lists (n, lists)."""
        data, order = self._data, "big" if self._order == ">" else "little"
        steps = []  # of each list: bytes before its length, those of the length, its sign, those of a value
        before = 0
        for each in element.properties:
            size = np.dtype(each.value).itemsize
            if each.count:
                steps.append((before, np.dtype(each.count).itemsize, each.count[0] == "i", size))
                before = 0
            else:
                before += size
        starts, lengths, at = [], [], self._at
        for _ in range(element.times):
            starts.append(at)
            for skipped, width, has_sign, size in steps:
                at += skipped + width
                length = int.from_bytes(data[at - width : at], order, signed=has_sign)  # type: ignore[arg-type]
                if length < 0 or at > len(data):
                    raise _too_short(element)
                lengths.append(length)
                at += length * size
            at += before
            if at > len(data):
                raise _too_short(element)
        self._at = at
        return np.array(starts, np.int64), np.array(lengths, np.int64).reshape(len(starts), -1)

    def _lengths_of_first(self, element: _Element) -> list[int]:
        """How long the lists of the next row are."""
        lengths, at = [], self._at
        for each in element.properties:
            size = 1
            if each.count:
                kind = np.dtype(self._order + each.count)
                if at + kind.itemsize > len(self._data):
                    raise _too_short(element)
                size = int(np.frombuffer(self._data, kind, 1, at)[0])
                if not 0 <= size <= len(self._data):
                    raise _too_short(element)
                lengths.append(size)
                at += kind.itemsize
            at += size * np.dtype(each.value).itemsize
        return lengths

    def _row_type(self, element: _Element, lengths: Sequence[int]) -> np.dtype[Any]:
        fields: list[tuple[Any, ...]] = []
        left = iter(lengths)
        for place, each in enumerate(element.properties):
            if each.count:
                fields.append((f"n{place}", self._order + each.count))
                fields.append((f"v{place}", self._order + each.value, (next(left),)))
            else:
                fields.append((f"v{place}", self._order + each.value))
        return np.dtype(fields)


class _TextRows:
    """The rows of a text file, element by element."""

    def __init__(self, data: bytes) -> None:
        self._words, self._at = data.split(), 0

    def take(self, element: _Element, wanted: Sequence[int]) -> Columns:
        """As :meth:`_BinaryRows.take`."""
        if not element.times or not element.properties:
            return [_NOTHING for _ in wanted]
        if not any(each.count for each in element.properties):
            width = len(element.properties)
            words = self._next(element, width * element.times)
            return [(_NOTHING[0], coordinates(words[place::width])) for place in wanted]
        found: list[list[bytes]] = [[] for _ in wanted]
        sizes: list[list[int]] = [[] for _ in wanted]
        for row in range(element.times):
            for place, each in enumerate(element.properties):
                size = _length(self._next(element, 1)[0], element, row) if each.count else 1
                words = self._next(element, size)
                if place in wanted:
                    sizes[wanted.index(place)].append(size)
                    found[wanted.index(place)] += words
        return [
            (np.array(size, np.int64), _numbers(words, size, element, element.properties[place]))
            for place, size, words in zip(wanted, sizes, found, strict=True)
        ]

    def _next(self, element: _Element, count: int) -> list[bytes]:
        words = self._words[self._at : self._at + count]
        if len(words) < count:
            raise _too_short(element)
        self._at += count
        return words


def _too_short(element: _Element) -> ValueError:
    return ValueError(f"the PLY file ends before all of its {element.times} rows of {element.name}")


_NOTHING = (np.zeros(0, np.int64), np.zeros(0, np.int64))


def _column(table: Any, place: int) -> tuple[IntRow, Any]:
    values = table[f"v{place}"].reshape(len(table), -1)
    return np.full(len(values), values.shape[1], np.int64), values.reshape(-1)


def _numbers(words: list[bytes], sizes: list[int], element: _Element, kind: _Property) -> Any:
    if kind.count and kind.value[0] != "f":
        rows = np.repeat(np.arange(len(sizes)), sizes).tolist()
        what = "a corner of {} {}, counted from 0,"
        numbers = [whole_number(word, what, element.name, row) for word, row in zip(words, rows, strict=True)]
        return np.array(numbers, object)
    # Coordinates keep all digits that the file has, whatever type it names.
    return coordinates(words)


def _length(word: bytes, element: _Element, row: int) -> int:
    size = whole_number(word, "the length of a list of {} {}, counted from 0,", element.name, row)
    if size < 0:
        raise ValueError(f"a list of the PLY file has {size} values")
    return size
