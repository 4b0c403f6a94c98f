"""From what a user names to the list of assets."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from .asset import Asset, BatchPlan, files_of
from .asset_range import ranges_of
from .input_paths import BLEND, expand
from .job_file import JOB_SUFFIXES, LINES, JobFileError, Row, read_job_file, read_some_lines
from .settings import SettingError, Settings, canonical, merged

ListObjects = Callable[[Path], list[str]]


@dataclass(frozen=True)
class ObjectsUnknown(Exception):
    """A Blender file's objects cannot be listed."""

    reason: str


def list_assets(inputs: Sequence[str], defaults: Settings, plan: BatchPlan, list_objects: ListObjects) -> list[Asset]:
    """Assets of folders, patterns, files and job files, in a fixed order, each with a name of its own.

    A row's wrong value or missing file is that asset's `problem`; the others are not held up by it.

    Parameters
    ----------
    inputs : sequence of str
        Relative to the current folder; what job files name is relative to them.
    defaults : Settings
        For all assets that say nothing else.
    plan : BatchPlan
    list_objects : callable(Path) -> list of str
        Names of the mesh objects of a ``.blend`` file; raises ObjectsUnknown.

    Raises
    ------
    JobFileError
        If an input matches nothing, a job file cannot be used, two assets have one name, or a result would take the place
        of an input.
    """
    output = Path(plan.output)
    assets: list[Asset] = []
    for text in inputs:
        path = Path(text).absolute()
        if path.suffix.lower() in JOB_SUFFIXES and path.is_file():
            for row in read_job_file(path):
                assets += _assets_of_row(row, path.parent, defaults, output, list_objects)
        else:
            found = expand(text, Path(), output)
            if path.is_dir() and (path == output or output in path.parents):
                raise JobFileError(
                    f"{text}: lies in the folder of the results, whose files are not taken; choose another --output"
                )
            if not found or (len(found) == 1 and not found[0][0].exists()):
                raise JobFileError(f"{text}: no such file or folder, and no mesh or Blender file matches")
            for each, name in found:
                assets += _assets_of_file(Asset(name, str(each), settings=defaults), list_objects)
    if not assets:
        raise JobFileError("there is nothing to do: no mesh and no object was found")
    assets = _with_own_names(assets)
    _require_safe(assets, plan)
    return assets


def is_list_of_lines(inputs: Sequence[str]) -> bool:
    """Whether the inputs are one job file whose lines can be counted without looking at what they name."""
    return len(inputs) == 1 and Path(inputs[0]).suffix.lower() == LINES and Path(inputs[0]).is_file()


def list_lines(text: str, chosen: str, defaults: Settings, plan: BatchPlan, list_objects: ListObjects) -> list[Asset]:
    """Assets of some lines of a job file as ``--write-list`` makes it: one asset a line, under a name of its own.

    The time that it takes does not depend on how many assets the other lines name.

    Parameters
    ----------
    text : str
        Of the job file.
    chosen : str
        Numbers of lines, see :func:`.asset_range.ranges_of`.

    Raises
    ------
    JobFileError
        As :func:`list_assets` does, and where a line has no name, or does not stand for one asset.
    ValueError
        If `chosen` is no list of numbers.
    """
    path, output = Path(text).absolute(), Path(plan.output)
    assets = []
    for row in read_some_lines(path, ranges_of(chosen)):
        found = list(_assets_of_row(row, path.parent, defaults, output, list_objects))
        if len(found) != 1 or not row.name:
            raise JobFileError(f"{path}: {row.input!r} is not one asset with a name; freeze the list by --write-list")
        assets += found
    _require_safe(assets, plan)
    return assets


def _assets_of_row(
    row: Row, folder: Path, defaults: Settings, output: Path, list_objects: ListObjects
) -> Iterator[Asset]:
    found = expand(row.input, folder, output)
    settings, problem = defaults, ""
    try:
        settings = merged(defaults, canonical(row.settings, folder))
    except SettingError as error:
        problem = str(error)
    if not found:
        name = row.name or re.sub(r"[^\w.-]+", "_", row.input)
        yield Asset(name, str(folder / row.input), settings=settings, problem="no mesh or Blender file matches")
    if row.name and len(found) == 1:
        found = [(found[0][0], row.name)]
    for path, name in found:
        named = f"{row.name}/{name}" if row.name and len(found) > 1 else name
        asset = Asset(named, str(path), row.object, settings, problem)
        if row.object and not row.name:
            asset = replace(asset, name=f"{named}/{_safe(row.object)}")
        yield from _assets_of_file(asset, list_objects)


def _assets_of_file(asset: Asset, list_objects: ListObjects) -> Iterator[Asset]:
    """The asset itself, or one for each object of its Blender file."""
    path = Path(asset.source)
    if path.suffix.lower() != BLEND or asset.object_name or asset.problem or not path.is_file():
        yield asset
        return
    try:
        names = list_objects(path)
    except ObjectsUnknown as error:
        yield replace(asset, problem=error.reason)
        return
    for name in names:
        yield replace(asset, name=f"{asset.name}/{_safe(name)}", object_name=name)


def _safe(name: str) -> str:
    """An object's name as the name of a file."""
    return re.sub(r"[^\w .-]", "_", name).strip(" .") or "_"


def _with_own_names(assets: Iterable[Asset]) -> list[Asset]:
    """Assets of files that differ only in their suffix, and objects whose names become the same, get longer names."""
    listed = list(assets)
    for suffix_of in (_source_suffix, _counted(listed)):
        times = Counter(asset.name.casefold() for asset in listed)
        listed = [
            replace(asset, name=asset.name + suffix_of(asset)) if times[asset.name.casefold()] > 1 else asset
            for asset in listed
        ]
    return listed


def _source_suffix(asset: Asset) -> str:
    return "_" + Path(asset.source).suffix.lower().removeprefix(".")


def _counted(assets: Sequence[Asset]) -> Callable[[Asset], str]:
    """Numbers for objects of one file; assets of different files with one name are an error of whoever named them."""
    places = {(asset.source, asset.object_name): place for place, asset in enumerate(assets)}
    return lambda asset: f"_{places[asset.source, asset.object_name]}" if asset.object_name else ""


def _require_safe(assets: Sequence[Asset], plan: BatchPlan) -> None:
    owners: dict[str, Asset] = {}
    sources = {Path(asset.source) for asset in assets}
    for asset in assets:
        place = PurePosixPath(asset.name)
        if place.is_absolute() or ".." in place.parts or not place.name or "\\" in asset.name:
            raise JobFileError(f"{asset.name!r} is no name for a result: it must be a relative path")
        other = owners.setdefault(asset.name.casefold(), asset)
        if other is not asset:
            raise JobFileError(
                f"two assets would be written as {asset.name!r}: {other.source} and {asset.source}; "
                "give them different names in a job file"
            )
        if files_of(asset, plan).result in sources:
            raise JobFileError(
                f"the result of {asset.source} would take the place of an input; choose another --output"
            )
