"""Results of the latest runs: who asks for the very same once more, as after an undo, has it at once."""

from __future__ import annotations

import hashlib
import json
from collections import OrderedDict

import numpy as np

from ..core.remesh import RemeshResult
from .request import RemeshRequest

_MOST_RESULTS = 4
_MOST_BYTES = 256 * 2**20
# Options that say when a run is ended, or how it is shared out, not what comes of it.
_NO_MATTER = ("time_limit", "memory_limit", "threads")


class KnownResults:
    """A few results in memory, the latest ones."""

    def __init__(self) -> None:
        self._results: OrderedDict[bytes, RemeshResult] = OrderedDict()

    def find(self, request: RemeshRequest) -> RemeshResult | None:
        """The result of a run that was given the same to the last bit; None where there is none."""
        return self._results.get(_digest(request)) if self._results else None

    def keep(self, request: RemeshRequest, result: RemeshResult) -> None:
        """Takes notice of a result; it is shared from now on, so nobody may change it."""
        digest = _digest(request)
        self._results[digest] = result
        self._results.move_to_end(digest)
        while len(self._results) > _MOST_RESULTS or sum(map(_size, self._results.values())) > _MOST_BYTES:
            self._results.popitem(last=False)

    def clear(self) -> None:
        """Lets go of all."""
        self._results.clear()


def _digest(request: RemeshRequest) -> bytes:
    arrays, values = request.as_bundle()
    values["options"] = {name: value for name, value in values["options"].items() if name not in _NO_MATTER}
    digest = hashlib.blake2b(json.dumps(values, sort_keys=True, default=float).encode())
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype} {array.shape}".encode())
        digest.update(array.tobytes())
    return digest.digest()


def _size(result: RemeshResult) -> int:
    return sum(value.nbytes for value in vars(result).values() if isinstance(value, np.ndarray))
