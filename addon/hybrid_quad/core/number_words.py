"""Numbers in the text of mesh files; of a word that is none the message says where it stands."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from .mesh_arrays import FloatArray

_NAN = re.compile(r"[+-]?nan\(\w*\)", re.IGNORECASE | re.ASCII)  # as C libraries print it: Windows' writes nan(ind)
_SHOWN = 40


def coordinates(words: Sequence[str | bytes], per_vertex: int = 1, first: int = 0) -> FloatArray:
    """(k,) the numbers that `words` are, of which each vertex has `per_vertex`, from the one of number `first` on.

    Raises
    ------
    ValueError
        If one is no number; names its vertex.
    """
    try:
        return np.array(words, dtype=object).astype(np.float64)
    except ValueError:
        return np.array([_coordinate(word, first + place // per_vertex) for place, word in enumerate(words)])


def whole_number(word: str | bytes, what: str, *names: object) -> int:
    """The number that a word is; `what` it is, with `names` in its braces, begins the message where it is none.

    Raises
    ------
    ValueError
    """
    try:
        return int(word)
    except ValueError:
        raise ValueError(f"{what.format(*names)} is no whole number: {_shown(word)!r}") from None


def _coordinate(word: str | bytes, vertex: int) -> float:
    try:
        return float(word)
    except ValueError:
        if _NAN.fullmatch(_shown(word)):
            return np.nan
        raise ValueError(
            f"vertex {vertex}, counted from 0, has a coordinate that is no number: {_shown(word)!r}"
        ) from None


def _shown(word: str | bytes) -> str:
    text = word.decode("ascii", "backslashreplace") if isinstance(word, bytes) else word
    return text[:_SHOWN]
