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
_AHEAD = 4  # assets for each thread of the cluster that wait their turn


def run_on_dask(assets: Sequence[Asset], plan: BatchPlan, address: str) -> Generator[AssetStatus, None, None]:
    """Runs assets on a cluster, and gives the status of each as soon as it is there.

    A worker that dies takes its worker processes along; Dask gives its assets to others, where those that were finished
    are found to be so. An asset under which one worker after the other dies is lost: the next start runs it again.

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
        remaining = iter(assets)
        waiting: dict[str, Asset] = {}
        running: Any = as_completed(loop=client.loop)

        def submit(asset: Asset) -> None:
            future = client.submit(
                run_asset, asset, plan, key=f"hybrid-quad-{asset.name}", retries=_RETRIES, pure=False
            )
            waiting[future.key] = asset
            running.add(future)

        try:
            for first in islice(remaining, _ahead(client)):
                submit(first)
            for future in running:
                asset = waiting.pop(future.key)
                if (following := next(remaining, None)) is not None:
                    submit(following)
                try:
                    status = future.result()
                except KilledWorker as error:
                    status = _lost(asset, plan, str(error))
                except BatchFault:
                    raise
                except Exception as error:
                    raise BatchFault(f"{asset.name}: the cluster cannot run it: {error}") from error
                if status is not None:
                    yield status
        finally:
            client.cancel(list(running.futures), force=True)


def _ahead(client: Any) -> int:
    return int(_AHEAD * max(1, sum(client.nthreads().values())))


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
