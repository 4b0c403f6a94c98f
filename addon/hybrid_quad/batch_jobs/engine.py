"""Shares assets out among worker processes of this machine."""

from __future__ import annotations

import threading
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from .asset import Asset, BatchPlan
from .asset_status import AssetStatus
from .run_asset import run_asset

# Seconds. A signal that comes just as the main thread falls asleep is not heeded before it wakes up.
_LOOK = 0.5
_AHEAD = 4  # assets for each job that wait their turn


def run_locally(assets: Sequence[Asset], plan: BatchPlan, jobs: int) -> Generator[AssetStatus, None, None]:
    """Runs assets, `jobs` at a time, and gives the status of each as soon as it is there.

    Each job is a thread that waits for a worker process. Where the caller stops iterating, or an exception comes up, runs
    that have begun are ended, and leave no status.

    Raises
    ------
    BatchFault
        At the first asset whose run the machine does not let happen.
    """
    stop = threading.Event()
    remaining = iter(assets)
    pending: set[Future[AssetStatus | None]] = set()
    with ThreadPoolExecutor(jobs, thread_name_prefix="asset") as pool:
        try:
            while True:
                while len(pending) < jobs * _AHEAD and (asset := next(remaining, None)) is not None:
                    pending.add(pool.submit(run_asset, asset, plan, stop.is_set))
                if not pending:
                    return
                done, pending = wait(pending, _LOOK, FIRST_COMPLETED)
                for future in done:
                    status = future.result()
                    if status is not None:
                        yield status
        finally:
            stop.set()
            for future in pending:
                future.cancel()
