"""The kinds of work that a worker process does, and the file that asks for it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol, TypeVar

from ..core.remesh import CancelCallback, ProgressCallback
from ..core.stage_cache import StageCache
from .bundle import load_bundle
from .limit_request import LimitRequest
from .preview_request import PreviewRequest
from .request import RemeshRequest
from .transfer_request import TransferRequest

Result = TypeVar("Result", covariant=True)


class Request(Protocol[Result]):
    """What a worker can solve: data that can be saved, and a result that is a dataclass of arrays and plain values."""

    @property
    def result_type(self) -> type[Result]:
        """The class of the result."""

    @property
    def time_limit(self) -> float | None:
        """Seconds after which the run stops by itself."""

    def save(self, path: Path) -> None:
        """Writes the request to a file for :func:`load_request`."""

    def solve(
        self,
        progress: ProgressCallback | None = None,
        cancel: CancelCallback | None = None,
        cache: StageCache | None = None,
    ) -> Result:
        """Does the work, with what the cache has of earlier work where that is of use."""


_KINDS: dict[str, Any] = {
    request.kind: request for request in (RemeshRequest, TransferRequest, PreviewRequest, LimitRequest)
}


def load_request(path: Path) -> Request[Any]:
    """The request that a file holds."""
    arrays, values = load_bundle(path)
    request: Request[Any] = _KINDS[values["kind"]].of_bundle(arrays, values)
    return request
