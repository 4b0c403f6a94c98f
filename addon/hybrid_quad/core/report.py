"""The report of a run, as plain values that JSON can hold."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

from .options import RemeshOptions


def finished(native_report: dict[str, Any], options: RemeshOptions, version: str) -> dict[str, Any]:
    """The report of a run that gave a mesh.

    Parameters
    ----------
    native_report : dict
        As the compiled module makes it.
    options : RemeshOptions
        What was asked.
    version : str
        Version of the package.
    """
    report = {"status": "ok", **native_report}
    report["defects"] = [defect_as_json(row) for row in native_report["defects"]]
    return {**report, **_origin(options, version)}


def defect_as_json(row: dict[str, Any]) -> dict[str, Any]:
    """A defect of the compiled part, its edges as pairs of vertices; see :class:`hybrid_quad.Defect`."""
    elements = row["elements"]
    if row["element_kind"] == "edge":
        elements = [[a, b] for a, b in zip(elements[0::2], elements[1::2], strict=True)]
    names = ("code", "element_kind", "elements", "repairable", "remedy", "kept")
    return {name: elements if name == "elements" else row[name] for name in names}


def failed(status: str, error: BaseException, options: RemeshOptions | None, version: str) -> dict[str, Any]:
    """The report of a run that gave none.

    Parameters
    ----------
    status : str
        ``"input_error"``, ``"internal_error"``, ``"cancelled"``, ``"time_limit"``, ``"memory_limit"``,
        ``"unreadable_file"``, ``"unwritable_file"`` or ``"wrong_usage"``: whose fault it is.
    error : BaseException
        What stopped the run; its code and elements are kept where it has them.
    """
    report: dict[str, Any] = {
        "status": status,
        "message": str(error),
        "code": getattr(error, "code", status),
        "element_kind": getattr(error, "element_kind", ""),
        "elements": list(getattr(error, "elements", ())),
        "warnings": [],
        "stages": [],
    }
    return {**report, **(_origin(options, version) if options else {"version": version})}


def as_text(report: dict[str, Any]) -> str:
    """JSON; numbers that JSON lacks become null."""
    return json.dumps(_finite(report), indent=2, allow_nan=False) + "\n"


def _origin(options: RemeshOptions, version: str) -> dict[str, Any]:
    return {"seed": options.seed, "version": version, "options": asdict(options)}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
