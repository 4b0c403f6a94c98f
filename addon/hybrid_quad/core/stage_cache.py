"""What the first stages of the latest run gave, kept for the next one."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

import numpy as np

from . import native

MOST_POLYGONS = 1_000_000  # of a surface of which anything is kept

_SURFACE = ("vertices", "face_sizes", "face_vertices")
_DIRECTIONS = ("vertex_guides", "face_guides")
_NO_MATTER = ("threads", "time_limit", "memory_limit")


class StageCache:
    """Lets runs on one surface, one after the other, share what they have in common.

    Given to :func:`hybrid_quad.preview` and :func:`hybrid_quad.remesh`, it keeps the repaired surface, what the features and
    sizes are, the even surface on which fields are solved for, and the field. A later run takes from it whatever depends only on
    values that are the same as in the run before: all but the field where `guides` are others, the repaired surface where
    any other wish is. Results are those of a run without, bit for bit. Of surfaces with more than a million polygons
    nothing is kept, and nothing for a run that begins while another one that was given the same cache goes on.
    """

    def __init__(self) -> None:
        """An empty cache."""
        self._stages: Any = None
        self._busy = threading.Lock()

    @property
    def recalled(self) -> frozenset[str]:
        """Names of the stages that the latest run took from here."""
        return frozenset() if self._stages is None else frozenset(self._stages.recalled)

    @contextmanager
    def lent(self, asked: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
        """Arguments of the compiled part that have one run use the cache.

        Parameters
        ----------
        asked : mapping
            All that the run is asked.
        """
        if len(asked["face_sizes"]) > MOST_POLYGONS or not self._busy.acquire(blocking=False):
            yield {}
            return
        try:
            if self._stages is None:
                self._stages = native.load().StageCache()
            yield {"cache": self._stages, "cache_keys": _keys_of(asked)}
        finally:
            self._busy.release()


def lent_by(cache: StageCache | None, asked: Mapping[str, Any]) -> AbstractContextManager[dict[str, Any]]:
    """:meth:`StageCache.lent`; no arguments where there is no cache."""
    return nullcontext({}) if cache is None else cache.lent(asked)


def _keys_of(asked: Mapping[str, Any]) -> list[str]:
    """Digests of the surface, of all that is asked but directions, and of all."""
    import hashlib  # loads OpenSSL, which runs without a cache do without

    plan = [name for name in asked if name not in (*_SURFACE, *_DIRECTIONS, *_NO_MATTER)]
    state = hashlib.blake2b(digest_size=16)
    keys = []
    for names in (_SURFACE, plan, _DIRECTIONS):
        for name in names:
            _add(state, name, asked[name])
        keys.append(state.hexdigest())
    return keys


def _add(state: Any, name: str, value: Any) -> None:
    is_array = isinstance(value, np.ndarray)
    state.update(repr((name, value.dtype.str, value.shape) if is_array else (name, value)).encode())
    if is_array:
        state.update(np.ascontiguousarray(value).data)
