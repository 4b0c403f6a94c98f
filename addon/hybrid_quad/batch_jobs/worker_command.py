"""The command that remeshes one asset into a folder."""

from __future__ import annotations

from pathlib import Path

from ..core.python_programs import python_program
from .asset import Asset, BatchPlan
from .settings import Settings, Value, as_arguments
from .worker_process import PACKAGE_PARENT

REPORT = "report.json"
PICTURE = "picture.png"


def result_name(asset: Asset, plan: BatchPlan) -> str:
    """Name of the result in the folder."""
    return "result.blend" if asset.object_name else f"result{plan.result_format}"


def settings_of_run(asset: Asset, plan: BatchPlan) -> Settings:
    """An asset's settings with the limits for all."""
    usual: dict[str, Value] = {"threads": plan.threads}
    if plan.time_limit:
        usual["time_limit"] = plan.time_limit
    return {**usual, **asset.settings}


def command_of(asset: Asset, plan: BatchPlan, folder: Path) -> list[str]:
    """Words of a command that writes a report, a picture where pictures are wanted, and then the result.

    The report is there once a run has ended by itself, the result only if there is a valid one.
    """
    result, report = str(folder / result_name(asset, plan)), str(folder / REPORT)
    words = [*as_arguments(settings_of_run(asset, plan)), "--report", report, "--quiet", "--end-with-stdin"]
    if plan.pictures:
        words += ["--picture", str(folder / PICTURE)]
    if not asset.object_name:
        return [python_program(), "-m", "hybrid_quad", "remesh", asset.source, result, *words]
    blender = blender_command(plan.blender, asset.source)
    return [*blender, "--object", asset.object_name, "--output", result, "--only-result", *words]


def blender_command(blender: str, path: str) -> list[str]:
    """The beginning of a command that runs the add-on's batch script on a Blender file; its arguments follow."""
    script = PACKAGE_PARENT / "hybrid_quad" / "batch.py"
    return [blender, "-b", "--factory-startup", path, "--python-exit-code", "1", "-P", str(script), "--"]
