"""One thing to remesh, and where what comes of it is put."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path

from .settings import Settings

WORK_FOLDER = ".hybrid-quad"  # in the output folder: what is not finished yet


@dataclass(frozen=True)
class Asset:
    """A mesh file, or an object of a Blender file, with its settings.

    Attributes
    ----------
    name : str
        Place in the output folder, without a suffix; folders are parted by ``/``.
    source : str
        Absolute path of the file.
    object_name : str
        The object of a ``.blend`` file; ``""`` for mesh files.
    settings : dict
        In the form of :func:`settings.canonical`.
    problem : str
        What keeps it from being run, if that is known already.
    """

    name: str
    source: str
    object_name: str = ""
    settings: Settings = field(default_factory=dict)
    problem: str = ""


@dataclass(frozen=True)
class BatchPlan:
    """What is the same for all assets of a batch.

    Attributes
    ----------
    output : str
        Absolute path of the folder for results and status files.
    result_format : str
        ``".obj"``, ``".ply"`` or ``".off"``, for the results of mesh files; those of objects are ``.blend`` files.
    pictures : bool
        Whether a picture of each result is drawn.
    blender : str
        The program for ``.blend`` files.
    retry_failed : bool
        Whether assets that failed are run again though nothing has changed.
    threads : int
        Threads of one asset's run where its settings do not say.
    time_limit : float
        Seconds for one asset's run where its settings do not say; 0: any.
    """

    output: str
    result_format: str = ".obj"
    pictures: bool = False
    blender: str = "blender"
    retry_failed: bool = False
    threads: int = 1
    time_limit: float = 0.0


@dataclass(frozen=True)
class AssetFiles:
    """Paths of an asset's files."""

    result: Path
    status: Path
    picture: Path
    work: Path  # the folder in which its run happens


def files_of(asset: Asset, plan: BatchPlan) -> AssetFiles:
    """Where an asset's files are."""
    output = Path(plan.output)
    suffix = ".blend" if asset.object_name else plan.result_format
    beside = output / asset.name
    return AssetFiles(
        result=beside.with_name(beside.name + suffix),
        status=beside.with_name(beside.name + ".hq.json"),
        picture=beside.with_name(beside.name + ".hq.png"),
        work=output / WORK_FOLDER / hashlib.sha256(asset.name.encode()).hexdigest()[:24],
    )
