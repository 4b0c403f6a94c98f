#!/usr/bin/env python3
"""What a batch of many assets costs beside their runs: lists, resuming, summaries; with status files made up for it.

    batch_scale.py [--assets 10000,30000] [--per-folder 1000] [--status FILE.hq.json] [--steps list,range,...] [--folder FOLDER]

Inputs are small files, status files copies of one of a real run under other names and with hashes that fit.
Prints processor seconds and the peak of memory for each step, each of which runs in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from hybrid_quad import __version__
from hybrid_quad.batch_jobs import summary, summary_page
from hybrid_quad.batch_jobs.asset import Asset, BatchPlan, files_of
from hybrid_quad.batch_jobs.asset_status import AssetStatus, read_status, write_status
from hybrid_quad.batch_jobs.job_file import write_job_file
from hybrid_quad.batch_jobs.job_hash import job_hash
from hybrid_quad.batch_jobs.job_list import list_assets
from hybrid_quad.batch_jobs.run_asset import run_asset
from hybrid_quad.cli.main import main as command

STEPS = ("list", "write list", "read list", "range", "resume", "collect", "tables", "page")  # and "dask"
ON_DASK = 2000


def main() -> None:
    """Makes the files and measures each step."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assets", default="10000,30000", type=lambda text: [int(part) for part in text.split(",")])
    parser.add_argument("--per-folder", type=int, default=1000)
    parser.add_argument("--status", type=Path, help="a status file of a real run")
    parser.add_argument("--steps", default=",".join(STEPS), type=lambda text: text.split(","))
    parser.add_argument("--folder", type=Path, help="where to make the files (default: a temporary folder)")
    arguments = parser.parse_args()
    model = read_status(arguments.status) if arguments.status else None
    for count in arguments.assets:
        with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
            place = Path(folder)
            begun = time.process_time()
            make_files(place, count, arguments.per_folder, model)
            print(f"{count} assets, files made in {time.process_time() - begun:.1f} s", flush=True)
            for step in arguments.steps:
                alone(f"  {step}", steps_of(place)[step])


def make_files(place: Path, count: int, per_folder: int, model: AssetStatus | None) -> None:
    """Inputs, results and status files of `count` assets, `per_folder` in a folder."""
    plan = plan_of(place)
    for number in range(count):
        name = f"{number // per_folder:04}/asset{number % per_folder:06}"
        source = place / "in" / f"{name}.obj"
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 {number}\nf 1 2 3\n")
        asset = Asset(name, str(source), settings={"quads": 2000})
        files = files_of(asset, plan)
        files.status.parent.mkdir(parents=True, exist_ok=True)
        files.result.write_text("x")
        status = replace(
            model or AssetStatus(name, str(source), "ok"),
            asset=name, source=str(source), job_hash=job_hash(asset, plan), result=files.result.name, picture="",
            result_bytes=1, settings=asset.settings, version=__version__,
        )  # fmt: skip
        files.status.write_text(json.dumps(vars(status), indent=2))


def plan_of(place: Path) -> BatchPlan:
    """Where results are."""
    return BatchPlan(output=str(place / "out"))


def steps_of(place: Path) -> dict[str, Callable[[], object]]:
    """What is measured."""
    plan, listed = plan_of(place), place / "list.jsonl"

    def assets() -> list[Asset]:
        return list_assets([str(place / "in")], {"quads": 2000}, plan, lambda _: [])

    def lines() -> list[summary.Line]:
        return summary.collect(assets(), plan)

    def resume() -> None:
        for asset in assets():
            run_asset(asset, plan)

    def on_dask() -> None:
        """The first of the assets, on two workers of this machine; the figures are the scheduler's and the client's."""
        from distributed import LocalCluster

        from hybrid_quad.batch_jobs import dask_engine

        chosen = assets()[:ON_DASK]
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            for most in (1, dask_engine._MOST_IN_TASK):
                dask_engine._MOST_IN_TASK = most
                begun = time.process_time()
                done = len(list(dask_engine.run_on_dask(chosen, plan, cluster.scheduler_address)))
                tasks = len(dask_engine.tasks_of(chosen, 2))
                used = time.process_time() - begun
                print(f"  {done} on Dask in {tasks} tasks: {used:.2f} s of scheduler and client", flush=True)

    return {
        "dask": on_dask,
        "list": assets,
        "write list": lambda: write_job_file(listed, assets()),
        "read list": lambda: list_assets([str(listed)], {}, plan, lambda _: []),
        "range": lambda: command(["batch", str(listed), "--output", plan.output, "--range", "0-19", "--quiet"]),
        "resume": resume,
        "collect": lines,
        "tables": lambda: summary.write_summary(Path(plan.output), lines()),
        "page": lambda: summary_page.write_page(Path(plan.output), lines()),
        "write status": lambda: write_status(place / "one.json", AssetStatus("one", "one", "ok")),
    }


def alone(name: str, step: Callable[[], object]) -> None:
    """Runs a step in a child process, so that no other step's memory is counted, and prints what it took.

    The child begins with what this process holds: the interpreter, the package and little else, 20 MB.
    """
    child = os.fork()
    if not child:
        begun = time.monotonic()
        step()
        used = resource.getrusage(resource.RUSAGE_SELF)
        print(
            f"{name:14} {used.ru_utime:8.2f} s user {used.ru_stime:8.2f} s system {time.monotonic() - begun:8.2f} s wall "
            f"{used.ru_maxrss / 1024:8.0f} MB",
            flush=True,
        )
        os._exit(0)
    _, status = os.waitpid(child, 0)
    if status:
        sys.exit(f"{name} failed")


if __name__ == "__main__":
    main()
