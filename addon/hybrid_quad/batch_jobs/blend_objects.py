"""The mesh objects of Blender files, as Blender itself lists them; lists are kept for the next start."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

from .asset import WORK_FOLDER, BatchPlan
from .job_hash import file_hash
from .job_list import ObjectsUnknown
from .run_asset import BatchFault
from .worker_command import blender_command
from .worker_process import run_process

_SECONDS = 600.0  # for opening one file


def object_lister(plan: BatchPlan) -> Callable[[Path], list[str]]:
    """A function that names the visible mesh objects with faces in a ``.blend`` file.

    It raises ObjectsUnknown where Blender cannot open the file, and BatchFault where there is no Blender.
    """

    def list_objects(path: Path) -> list[str]:
        if shutil.which(plan.blender) is None:
            raise BatchFault(f"{plan.blender}: no such program; name one by --blender for objects of .blend files")
        folder = Path(plan.output) / WORK_FOLDER
        try:
            listed = folder / f"objects-{file_hash(path)[:24]}.json"
        except OSError as error:
            raise ObjectsUnknown(f"{path}: {error.strerror}") from error
        if not listed.is_file():
            folder.mkdir(parents=True, exist_ok=True)
            _ask_blender(plan.blender, path, listed)
        names = json.loads(listed.read_text(encoding="utf-8"))
        return [str(name) for name in names]

    return list_objects


def _ask_blender(blender: str, path: Path, listed: Path) -> None:
    log = listed.with_suffix(".txt")
    command = [*blender_command(blender, str(path)), "--list-objects", str(listed), "--end-with-stdin"]
    try:
        outcome = run_process(command, log, lambda: False, time_limit=_SECONDS)
    finally:
        log.unlink(missing_ok=True)
    if not listed.is_file():
        last = outcome.messages.splitlines()[-1:] or [f"exit status {outcome.exit_status}"]
        raise ObjectsUnknown(f"Blender cannot list the objects of {path}: {last[0]}")
