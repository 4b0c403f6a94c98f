"""What a result depends on, as one hash: where it has not changed, nothing is run again."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from .. import __version__
from ..core.file_places import require_regular
from .asset import Asset, BatchPlan
from .settings import LIMITS, files_of

_FORM = 1  # of what is hashed


def job_hash(asset: Asset, plan: BatchPlan, version: str = __version__) -> str:
    """Hash of an asset's input, the settings that make a difference, the files they name, and the version.

    Raises
    ------
    OSError
        If a file cannot be read.
    """
    settings = {name: value for name, value in asset.settings.items() if name not in LIMITS}
    files = files_of(settings)
    content = {
        "form": _FORM,
        "version": version,
        "input": file_hash(Path(asset.source)),
        "kind": Path(asset.source).suffix.lower(),
        "object": asset.object_name,
        "settings": {name: value for name, value in settings.items() if name not in files},
        "files": {name: file_hash(path) for name, path in files.items()},
        "format": "" if asset.object_name else plan.result_format,
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def file_hash(path: Path) -> str:
    """SHA-256 of a file, as hexadecimal digits."""
    require_regular(path)
    with path.open("rb") as file:
        digest = hashlib.sha256()
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
