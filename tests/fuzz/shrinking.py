"""Makes a failing case smaller: fewer wishes, then fewer faces, as long as it still fails."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fuzz.cases import Case


def shrunk(case: Case, fails: Callable[[Case], bool], seconds: float) -> Case:
    """The smallest case found in the time; `fails` says whether a case fails as the first does."""
    end = time.monotonic() + seconds
    for name in [name for name in case.options if name not in ("quads", "sharp_angle")]:
        without = replace(case, options={key: value for key, value in case.options.items() if key != name})
        if time.monotonic() < end and fails(without):
            case = without
    part = len(case.faces) // 2
    while part >= 1 and time.monotonic() < end:
        begin, removed = 0, False
        while begin < len(case.faces) and time.monotonic() < end:
            smaller = _with_faces(case, case.faces[:begin] + case.faces[begin + part :])
            if smaller.faces and fails(smaller):
                case, removed = smaller, True
            else:
                begin += part
        if not removed or part > 1:
            part //= 2
    compact = _without_loose_vertices(case)
    return compact if fails(compact) else case


def _with_faces(case: Case, faces: list[list[int]]) -> Case:
    """Fewer faces; wishes about edges that are gone go with them."""
    edges = {frozenset((face[i - 1], face[i])) for face in faces for i in range(len(face))}
    options = dict(case.options)
    if "sharp_edges" in options:
        options["sharp_edges"] = [edge for edge in options["sharp_edges"] if frozenset(edge) in edges]
    if "curve_counts" in options:
        options["curve_counts"] = [row for row in options["curve_counts"] if frozenset(row[0]) in edges]
    return Case(case.vertices, faces, options)


def _without_loose_vertices(case: Case) -> Case:
    used = np.unique(np.concatenate([np.array(face) for face in case.faces]))
    place = {int(v): i for i, v in enumerate(used)}
    options = dict(case.options)
    for name in ("density", "frames", "guides"):
        if name in options:
            options[name] = [options[name][v] for v in used]
    for name in ("sharp_edges",):
        if name in options:
            options[name] = [[place[v] for v in edge] for edge in options[name]]
    if "curve_counts" in options:
        options["curve_counts"] = [[[place[v] for v in path], count] for path, count in options["curve_counts"]]
    return Case(case.vertices[used], [[place[v] for v in face] for face in case.faces], options)
