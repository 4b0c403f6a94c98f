"""What came of an asset: the status file beside its result, which is written last and says that all is done."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..core import report as reports
from ..core.file_places import replacing
from .settings import Settings

OK = "ok"
PENDING = "pending"  # no status file yet
LOST = "lost"  # the worker process was killed from outside: no fault of the asset, so the next start runs it again
CRASHED = "crashed"
WRONG_USAGE = "wrong_usage"
UNREADABLE = "unreadable_file"
OUT_OF_LIMITS = ("time_limit", "memory_limit")


@dataclass(frozen=True)
class AssetStatus:
    """What is in a status file.

    Attributes
    ----------
    asset, source, object : str
        The asset's name, its file, and the object in that.
    status : str
        ``"ok"``; ``"input_error"``, ``"wrong_usage"``, ``"unreadable_file"``, ``"unwritable_file"``,
        ``"internal_error"``, ``"time_limit"`` and ``"memory_limit"`` as in the reports of single runs; ``"crashed"``, or
        ``"lost"`` where it is to be run again.
    code, message : str
        What is wrong: a stable name, and a sentence.
    job_hash : str
        Of input, settings and version; empty where the input cannot be read.
    settings, limits : dict
        What was asked.
    result, picture : str
        Names of files beside the status file, empty where there are none.
    result_bytes : int
        Size of the result, by which one that was cut off or changed is noticed.
    seconds : float
        Duration of the run.
    command : list of str
        What was run, for doing it by hand.
    report : dict
        The report of the run; empty where it left none.
    """

    asset: str
    source: str
    status: str
    object: str = ""
    code: str = ""
    message: str = ""
    job_hash: str = ""
    settings: Settings = field(default_factory=dict)
    limits: dict[str, float] = field(default_factory=dict)
    result: str = ""
    picture: str = ""
    result_bytes: int = 0
    seconds: float = 0.0
    version: str = ""
    command: list[str] = field(default_factory=list)
    report: dict[str, Any] = field(default_factory=dict)

    @property
    def warnings(self) -> list[str]:
        """Those of the run."""
        return [str(warning) for warning in self.report.get("warnings", ())]


def read_status(path: Path) -> AssetStatus | None:
    """The status in a file; None where there is no file, or none of this form."""
    try:
        return _of(json.loads(path.read_text(encoding="utf-8")))
    except (FileNotFoundError, NotADirectoryError, ValueError, TypeError):
        return None


def write_status(path: Path, status: AssetStatus) -> None:
    """Writes a status file, whole or not at all.

    Raises
    ------
    MeshFileError
        If it cannot be written.
    """
    with replacing(path) as file:
        file.write(reports.as_text(asdict(status)).encode())


def stands(status: AssetStatus | None, job_hash: str, limits: Mapping[str, float], folder: Path) -> bool:
    """Whether a status says all that another run would.

    Parameters
    ----------
    status : AssetStatus or None
    job_hash : str
        Of the asset as it is now.
    limits : mapping
        Limits as they are now: a run that reached them may not reach others.
    folder : Path
        Where the status file lies.
    """
    if status is None or status.job_hash != job_hash or status.status == LOST:
        return False
    if status.status == OK:
        result = folder / status.result
        return result.is_file() and result.stat().st_size == status.result_bytes
    return status.status not in OUT_OF_LIMITS or dict(limits) == status.limits


def _of(values: Mapping[str, Any]) -> AssetStatus:
    return AssetStatus(**{name: values[name] for name in AssetStatus.__dataclass_fields__ if name in values})
