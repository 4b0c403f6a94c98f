"""Progress of a run on the error stream."""

from __future__ import annotations

import sys
from types import TracebackType

from tqdm import tqdm


class ProgressBar:
    """A bar for :func:`hybrid_quad.remesh`'s `progress`, shown while the object is used as a context."""

    def __init__(self, quiet: bool) -> None:
        self._bar = tqdm(
            total=100,
            disable=quiet,
            file=sys.stderr,
            leave=False,
            # A log file gets a line now and then, a terminal a bar that moves.
            mininterval=0.1 if sys.stderr.isatty() else 5.0,
            bar_format="{desc:<28} {percentage:3.0f}% |{bar}| {elapsed}",
        )

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.close()

    def update(self, stage: str, fraction: float) -> None:
        """Shows a stage and the fraction of the whole run."""
        self._bar.set_description_str(stage.replace("_", " "), refresh=False)
        self._bar.update(100 * fraction - self._bar.n)
