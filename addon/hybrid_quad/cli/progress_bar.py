"""Progress of a run on the error stream."""

from __future__ import annotations

import contextlib
from types import TracebackType

from .messages import say
from .terminal_bar import terminal_bar


class ProgressBar:
    """Receives :func:`hybrid_quad.remesh`'s `progress` while it is used as a context.

    A terminal shows a bar that vanishes at the end, a log file a line for each stage. A terminal that is gone shows
    nothing, and ends no run.
    """

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet
        self._stage = ""
        form = "{desc:<28} {percentage:3.0f}% |{bar}| {elapsed}"
        self._bar = None if quiet else terminal_bar(total=100, leave=False, bar_format=form)

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            with contextlib.suppress(OSError):
                self._bar.close()

    def update(self, stage: str, fraction: float) -> None:
        """Shows a stage and the fraction of the whole run."""
        if self._bar is not None:
            with contextlib.suppress(OSError):
                self._bar.set_description_str(stage.replace("_", " "), refresh=False)
                self._bar.update(100 * fraction - self._bar.n)
        elif not self._quiet and stage != self._stage:
            say(f"{100 * fraction:3.0f}% {stage.replace('_', ' ')}")
        self._stage = stage
