"""Progress of a batch on the error stream."""

from __future__ import annotations

import contextlib
import sys
from collections import Counter
from types import TracebackType

from ..batch_jobs.asset_status import OK, AssetStatus
from .messages import say
from .terminal_bar import terminal_bar


class BatchProgress:
    """Receives the status of each asset while it is used as a context.

    A terminal shows a bar, and above it a line for every asset that failed; a log file, and Blender's terminal, get a line for
    every asset, which says how many are done.
    """

    def __init__(self, total: int, quiet: bool) -> None:
        self._total, self._quiet = total, quiet
        self._counts: Counter[str] = Counter()
        self._bar = None if quiet else terminal_bar(total=total, unit="asset", dynamic_ncols=True)

    def __enter__(self) -> BatchProgress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            with contextlib.suppress(OSError):  # a terminal that is gone
                self._bar.close()

    def update(self, status: AssetStatus) -> None:
        """Counts an asset."""
        self._counts[status.status] += 1
        message = f"{status.asset}: {status.status}{': ' + status.message if status.message else ''}"
        if self._bar is not None:
            with contextlib.suppress(OSError):
                if status.status != OK:
                    self._bar.write(f"hybrid-quad: {message}", file=sys.stderr)
                self._bar.set_postfix({name: times for name, times in self._counts.items()}, refresh=False)
                self._bar.update()
        elif not self._quiet:
            done = sum(self._counts.values())
            quads = f", {status.report.get('quads')} quads, {status.seconds:.1f} s" if status.status == OK else ""
            say(f"[{done}/{self._total}] {message}{quads}")
