#!/usr/bin/env python3
"""What an asset of a batch costs: processor seconds, peak of memory, files and bytes.

    batch_cost.py MESH... [--counts 500,2000,8000] [--assets 50] [--output FOLDER] [--report FILE.json]

Assets are the meshes in turn, the counts in turn, each run as `hybrid-quad batch` runs it: in a process of its own, one thread,
with a picture. Processor seconds are those of that process and of what the batch does around it.
"""

from __future__ import annotations

import argparse
import itertools
import json
import resource
import statistics
import tempfile
from pathlib import Path
from typing import Any

from hybrid_quad.batch_jobs.asset import Asset, BatchPlan, files_of
from hybrid_quad.batch_jobs.run_asset import run_asset

COLUMNS = (
    "worker_cpu",
    "batch_cpu",
    "seconds",
    "peak_mb",
    "input_bytes",
    "result_bytes",
    "status_bytes",
    "picture_bytes",
)


def main() -> None:
    """Runs the assets and prints means, medians, nineteenths of twenty and the most."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--counts", default="500,2000,8000", type=lambda text: [int(part) for part in text.split(",")])
    parser.add_argument("--assets", type=int, default=50)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--report", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        plan = BatchPlan(output=str((arguments.output or Path(folder)).absolute()), pictures=True)
        pairs = zip(itertools.cycle(arguments.meshes), itertools.cycle(arguments.counts), strict=False)
        rows = []
        for place, (mesh, quads) in enumerate(itertools.islice(pairs, arguments.assets)):
            asset = Asset(f"{place:04}_{mesh.stem}", str(mesh.absolute()), settings={"quads": quads})
            rows.append(measured(asset, plan))
            print(json.dumps(rows[-1]), flush=True)
            if arguments.report:
                arguments.report.write_text(json.dumps(rows, indent=1) + "\n")
    print(table(rows))


def measured(asset: Asset, plan: BatchPlan) -> dict[str, Any]:
    """Figures of one asset's run."""
    before = [processor_seconds(who) for who in (resource.RUSAGE_CHILDREN, resource.RUSAGE_SELF)]
    status = run_asset(asset, plan)
    after = [processor_seconds(who) for who in (resource.RUSAGE_CHILDREN, resource.RUSAGE_SELF)]
    assert status is not None
    files = files_of(asset, plan)
    sizes = {
        f"{name}_bytes": path.stat().st_size if path.is_file() else 0
        for name, path in (
            ("input", Path(asset.source)),
            ("result", files.result),
            ("status", files.status),
            ("picture", files.picture),
        )
    }
    return {
        "asset": asset.name,
        "asked": asset.settings["quads"],
        "quads": status.report.get("quads"),
        "status": status.status,
        "worker_cpu": round(after[0] - before[0], 3),
        "batch_cpu": round(after[1] - before[1], 4),
        "seconds": status.seconds,
        "peak_mb": max((stage["peak_mb"] for stage in status.report.get("stages", ())), default=0),
        **sizes,
    }


def processor_seconds(who: int) -> float:
    """Of this process, or of all its children that have ended."""
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def table(rows: list[dict[str, Any]]) -> str:
    """Mean, median, 95th percentile, most and sum of each figure."""
    lines = [f"{len(rows)} assets, {sum(row['status'] == 'ok' for row in rows)} ok"]
    for name in COLUMNS:
        values = sorted(row[name] for row in rows)
        p95 = values[min(len(values) - 1, round(0.95 * len(values)))]
        lines.append(
            f"{name:14} mean {statistics.fmean(values):12.3f} median {statistics.median(values):12.3f} "
            f"p95 {p95:12.3f} most {values[-1]:12.3f} sum {sum(values):14.3f}"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    main()
