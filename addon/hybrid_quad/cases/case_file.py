"""A case as a zip file, and back."""

from __future__ import annotations

import json
import os
import platform
import re
import shlex
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import __version__
from ..batch_jobs.settings import Settings, files_of, unknown_names
from ..core.file_places import MeshFileError, replacing
from .case_run import RESULT, Outcome, command_of_case

DESCRIPTION = "case.json"
_FORM = 1
_NAME = re.compile(r"[a-z_]{1,30}\.[a-z0-9]{1,10}")
_NO_TIME = (1980, 1, 1, 0, 0, 0)  # a zip file's first moment: when a case was packed is nobody's business


@dataclass(frozen=True)
class Case:
    """What a run reads, and what came of it.

    Attributes
    ----------
    mesh : str
        The file that is remeshed.
    settings : Settings
        Those that name files name files of the case.
    files : dict of str to bytes
        Everything but the description, by name.
    status, code : str
        What came of the run.
    version : str
        Of the package that ran it.
    machine : dict
        Where it ran.
    """

    mesh: str
    settings: Settings
    files: Mapping[str, bytes]
    status: str
    code: str
    version: str = __version__
    machine: Mapping[str, Any] = field(default_factory=dict)

    @property
    def result(self) -> bytes | None:
        """The quads, where there are some."""
        return self.files.get(RESULT)


def save_case(
    path: str | os.PathLike[str],
    mesh: str,
    settings: Settings,
    files: Mapping[str, bytes],
    outcome: Outcome,
    origin: Mapping[str, Any],
) -> None:
    """Writes a case, whole or not at all; the same content gives the same bytes.

    Parameters
    ----------
    path : path
    mesh, settings, files
        See :class:`Case`.
    outcome : Outcome
        Its report and result become files.
    origin : mapping
        What is said of where the mesh comes from; empty for a case without names.

    Raises
    ------
    MeshFileError
        If it cannot be written.
    """
    members = dict(files)
    if outcome.report:
        members["report.json"] = _as_json(outcome.report)
    if outcome.result is not None:
        members[RESULT] = outcome.result
    description = {
        "form": _FORM,
        "version": __version__,
        "machine": this_machine(),
        "mesh": mesh,
        "settings": settings,
        "command": shlex.join(command_of_case(mesh, settings)),
        "replay": "hybrid-quad case --replay CASE.zip",
        "outcome": {
            "status": outcome.status,
            "code": outcome.code,
            "message": outcome.message,
            "seconds": round(outcome.seconds, 3),
        },
        "origin": dict(origin),
        "files": sorted(members),
    }
    with replacing(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in ((DESCRIPTION, _as_json(description)), *sorted(members.items())):
            entry = zipfile.ZipInfo(name, _NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data)


def load_case(path: str | os.PathLike[str]) -> Case:
    """Reads a case.

    Raises
    ------
    MeshFileError
        If it is none, or one of a later form; names outside of its own folder are never taken.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            described = json.loads(archive.read(DESCRIPTION))
            files = {name: archive.read(name) for name in described["files"] if _NAME.fullmatch(name)}
        if described["form"] != _FORM:
            raise ValueError(f"it is of form {described['form']}, not {_FORM}: another version wrote it")
        settings, mesh, outcome = described["settings"], described["mesh"], described["outcome"]
        named = {str(each) for each in files_of(_known(settings)).values()}
        missing = sorted(name for name in {mesh, *named} if name not in files)
        if missing:
            raise ValueError(f"{', '.join(missing)} is missing")
        return Case(
            mesh, settings, files, outcome["status"], outcome["code"], described["version"], described["machine"]
        )
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    except (zipfile.BadZipFile, KeyError, TypeError, ValueError) as error:
        raise MeshFileError(f"{path}: no case that can be read: {error}") from error


def this_machine() -> dict[str, Any]:
    """The kind of machine and the versions; no names of machines or users."""
    return {
        "system": platform.system(),
        "machine": platform.machine(),
        "libc": " ".join(platform.libc_ver()),
        "processors": os.cpu_count(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def write_files(case: Case, folder: Path) -> None:
    """Writes the files of a case to a folder."""
    for name, data in case.files.items():
        (folder / name).write_bytes(data)


def _known(settings: Settings) -> Settings:
    unknown = unknown_names(settings)
    if unknown:
        raise ValueError(f"there is no setting {', '.join(unknown)}")
    return settings


def _as_json(values: Mapping[str, Any]) -> bytes:
    return (json.dumps(values, indent=1) + "\n").encode()
