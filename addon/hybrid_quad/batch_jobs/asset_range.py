"""Which assets of a list a farm's task is to run."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


def in_range(items: Sequence[T], text: str) -> list[T]:
    """The items that numbers and ranges name, counted from 0, both ends included: ``"0-9"``, ``"3,5,10-19"``.

    Numbers past the end name nothing, so that the last task of a farm's job may be shorter.

    Raises
    ------
    ValueError
        If the text is anything else.
    """
    places: set[int] = set()
    for first, last in ranges_of(text):
        places.update(range(first, min(last + 1, len(items))))
    return [items[place] for place in sorted(places)]


def ranges_of(text: str) -> list[tuple[int, int]]:
    """First and last number of each range that a text names.

    Raises
    ------
    ValueError
        If the text is anything else.
    """
    ranges = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d+)\s*(?:-\s*(\d+)\s*)?", part)
        if match is None:
            raise ValueError(f"{text!r} is no list of numbers and ranges, as 0-9 or 3,5,10-19")
        first, last = int(match[1]), int(match[2] or match[1])
        if last < first:
            raise ValueError(f"{part.strip()!r} ends before it begins")
        ranges.append((first, last))
    return ranges
