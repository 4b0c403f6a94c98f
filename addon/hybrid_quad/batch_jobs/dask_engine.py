"""Shares assets out on a Dask cluster, whose workers see the same folders and have this package installed."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

from .. import __version__
from . import asset_status
from .asset import Asset, BatchPlan, files_of
from .asset_status import AssetStatus, write_status
from .run_asset import BatchFault, run_asset

_RETRIES = 3  # after an error of a worker's machine
_PATIENCE = 30  # seconds to reach the scheduler
_AHEAD = 4  # tasks for each thread of the cluster that wait their turn
# A task costs the scheduler and this process some milliseconds, so those of large batches are of several assets, in turn: as
# many as leave every thread this many tasks, so that all end at about the same time.
_TASKS_PER_THREAD = 50
_MOST_IN_TASK = 20


def run_on_dask(assets: Sequence[Asset], plan: BatchPlan, address: str) -> Generator[AssetStatus, None, None]:
    """Runs assets on a cluster, and gives the status of each as soon as it is there.

    A worker that dies takes its worker processes along; Dask gives its tasks to others, where assets that were finished
    are found to be so. A task under which one worker after the other dies is taken apart. An asset alone under which they do
    is lost: the next start runs it again.

    Parameters
    ----------
    assets : sequence of Asset
    plan : BatchPlan
        With paths that mean the same on every machine.
    address : str
        Of the scheduler, as ``tcp://host:8786``.

    Raises
    ------
    BatchFault
        If the cluster cannot be reached, has another version of this package, or a machine lets no run happen.
    """
    try:
        from distributed import Client, as_completed
        from distributed.scheduler import KilledWorker
    except ImportError as error:
        raise BatchFault("--dask needs the package distributed: pip install 'hybrid-quad[dask]'") from error
    try:
        client: Any = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise BatchFault(f"no Dask scheduler at {address}: {error}") from error
    with client:
        _require_same_version(client)
        threads = _threads(client)
        remaining = iter(tasks_of(assets, threads))
        waiting: dict[str, Sequence[Asset]] = {}
        running: Any = as_completed(loop=client.loop)

        def submit(task: Sequence[Asset]) -> None:
            key = f"hybrid-quad-{len(task)}-{task[0].name}"
            future = client.submit(_run_in_turn, task, plan, key=key, retries=_RETRIES, pure=False)
            waiting[future.key] = task
            running.add(future)

        try:
            for first in islice(remaining, _AHEAD * threads):
                submit(first)
            for future in running:
                task = waiting.pop(future.key)
                if (following := next(remaining, None)) is not None:
                    submit(following)
                try:
                    yield from future.result()
                except KilledWorker as error:
                    if len(task) == 1:
                        yield _lost(task[0], plan, str(error))
                    else:
                        for asset in task:
                            submit([asset])
                except BatchFault:
                    raise
                except Exception as error:
                    raise BatchFault(f"{task[0].name}: the cluster cannot run it: {error}") from error
        finally:
            client.cancel(list(running.futures), force=True)


def tasks_of(assets: Sequence[Asset], threads: int) -> list[Sequence[Asset]]:
    """Assets in their order, one or several a task."""
    size = min(_MOST_IN_TASK, max(1, len(assets) // (_TASKS_PER_THREAD * threads)))
    return [assets[first : first + size] for first in range(0, len(assets), size)]


def _run_in_turn(assets: Sequence[Asset], plan: BatchPlan) -> list[AssetStatus]:
    """What a task does, on a worker."""
    return [status for asset in assets if (status := run_asset(asset, plan)) is not None]


def _threads(client: Any) -> int:
    return max(1, int(sum(client.nthreads().values())))


def _require_same_version(client: Any) -> None:
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
        versions = client.run(_version_here)
    except Exception as error:
        raise BatchFault(f"the workers of the Dask cluster cannot use hybrid_quad: {error}") from error
    others = sorted({str(version) for version in versions.values() if version != __version__})
    if others:
        raise BatchFault(f"the Dask cluster has hybrid-quad {', '.join(others)}, this machine {__version__}")


def _version_here() -> str:
    from ..core import native

    native.load()
    return __version__


def _lost(asset: Asset, plan: BatchPlan, message: str) -> AssetStatus:
    files = files_of(asset, plan)
    status = AssetStatus(asset.name, asset.source, asset_status.LOST, asset.object_name, asset_status.LOST, message)
    files.status.parent.mkdir(parents=True, exist_ok=True)
    write_status(files.status, replace(status, version=__version__))
    return status
