"""What came of a case: one word, and what is wrong where something is."""

from __future__ import annotations

import time
import traceback
from typing import Any

import numpy as np

import hybrid_quad
from fuzz.cases import Case
from hybrid_quad.core.snapshots import Snapshot
from hybrid_quad.core.validation import topology, violations
from repaired import with_edges_apart

NO_ELEMENTS = {
    "empty_mesh",
    "no_area",
    "malformed_faces",
    "coordinates_too_coarse",
    "coordinates_too_small",
    "symmetry_side_empty",
    "symmetry_plane_missed",
    "symmetry_edge_in_two_planes",
    "stroke_too_far",
}
BAD = ("invalid", "internal_error", "exception", "bad_refusal", "timeout", "crash")


def verdict_of(case: Case, time_limit: float) -> dict[str, Any]:
    """Runs a case and says what came of it. The limit is of processor time, so that other work does not matter.

    Returns
    -------
    dict
        ``outcome``: "valid"; "flawed": valid, but for quads that point against the surface, as the report says;
        "refused"; or one of `BAD`. ``code``: of a refusal, else None. ``detail``: a sentence. ``seconds``.
    """
    begin = time.process_time()
    outcome, code, detail = _outcome(case, time_limit)
    return {"outcome": outcome, "code": code, "detail": detail, "seconds": round(time.process_time() - begin, 3)}


def _outcome(case: Case, time_limit: float) -> tuple[str, str | None, str]:
    repaired = []

    def look(snapshot: Snapshot) -> None:
        if snapshot.stage == "mesh":
            repaired.append(snapshot)

    begin = time.process_time()

    def is_late() -> bool:
        return time.process_time() - begin > time_limit

    try:
        result = hybrid_quad.remesh(
            case.vertices, case.faces, **{"threads": 1, **arguments_of(case)}, cancel=is_late, on_snapshot=look
        )
    except hybrid_quad.InputError as error:
        good = error.code and str(error).endswith(".") and (error.code in NO_ELEMENTS or len(error.elements))
        return ("refused" if good else "bad_refusal"), error.code, f"{error.code}: {error}"[:300]
    except hybrid_quad.Cancelled as error:
        return "timeout", None, str(error)
    except hybrid_quad.InternalError as error:
        return "internal_error", None, str(error)
    except Exception:
        return "exception", None, traceback.format_exc()[-600:]
    found = violations(result.vertices, result.quads)
    if not len(result.quads):
        found.append("no quads")
    if not case.options.get("symmetry"):
        found += _differences(repaired[0], result.quads)
    if found:
        return "invalid", None, "; ".join(found)[:600]
    if result.report["flawed_quads"] > 0:
        warnings = [warning for warning in result.report["warnings"] if "against the surface" in warning]
        return "flawed", None, warnings[0]
    return "valid", None, ""


def _differences(mesh: Snapshot, quads: np.ndarray) -> list[str]:
    """Where the result has another topology than the repaired input."""
    given, made = topology(with_edges_apart(mesh)[1]), topology(quads)
    return [] if given == made else [f"topology {made} instead of {given}"]


def arguments_of(case: Case) -> dict[str, Any]:
    """The case's options as ``hybrid_quad.remesh`` takes them."""
    arguments = dict(case.options)
    if "strokes" in arguments:
        arguments["strokes"] = [hybrid_quad.Stroke(np.array(p), s, kind) for p, s, kind in arguments["strokes"]]
    if "frames" in arguments:
        arguments["frames"] = np.array(arguments["frames"]).reshape(-1, 2, 3)
    return arguments
