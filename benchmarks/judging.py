"""The independent judge, asked many times about results of the same models.

The judge is a script; what it says of one input takes longest to find out about the input itself. So it is loaded once in a
process of its own, and what it computes from an input alone is kept for the next result of that input.
"""

from __future__ import annotations

import functools
import importlib.util
import json
import multiprocessing
import os
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from types import ModuleType
from typing import Any

import whole_surface

SHARP_ANGLE = 40.0  # degrees; the judge's own default
SAMPLED_CHECK = "no_inverted"  # the one that looks at random points of the input
REMEMBERED = 4  # inputs, and results of each function


class Judges:
    """Processes that judge.

    Parameters
    ----------
    script : Path
        The judge: a module with `read_obj`, `weld`, `Topology`, `triangulate`, `feature_edges` and `judge`.
    count : int
        Processes.
    """

    def __init__(self, script: Path, count: int = 1) -> None:
        self._script, self._count = script, count
        self._pool = self._new_pool()

    def ask(self, quads: int, source: Path, result: Path, seconds: float) -> dict[str, Any]:
        """What the judge says of a result; `failed` names it where it says nothing within some seconds."""
        pool = self._pool
        try:
            judgement: dict[str, Any] = pool.submit(_judge, self._script, quads, source, result).result(seconds)
            return judgement
        except TimeoutError:
            answer = "timeout"
        except BrokenProcessPool:
            answer = "died"
        except Exception as error:  # whatever the script raises is its answer
            return {"failed": [f"judge: {error!r}"]}
        if self._pool is pool:
            self._pool = self._new_pool()
            pool.shutdown(wait=False, cancel_futures=True)
        return {"failed": [f"judge: {answer}"]}

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self._count, mp_context=multiprocessing.get_context("spawn"))


def _judge(script: Path, quads: int, source: Path, result: Path) -> dict[str, Any]:
    judge = _load(script)
    vertices, faces = _input(script, source, source.stat().st_mtime_ns)
    mesh = judge.read_obj(result)
    judgement: dict[str, Any] = judge.judge(vertices, faces, *mesh, SHARP_ANGLE, None, quads)
    if judgement.get("failed") == [SAMPLED_CHECK]:
        judgement["inverted_by_whole_surface"] = _without_samples(judge, vertices, faces, *mesh)
    return judgement


def _without_samples(judge: ModuleType, vertices: Any, faces: Any, *mesh: Any) -> int:
    sampling = judge.count_inverted
    judge.count_inverted = whole_surface.count_inverted
    try:
        return int(judge.judge(vertices, faces, *mesh, SHARP_ANGLE, None, None)["inverted"])
    finally:
        judge.count_inverted = sampling


@functools.lru_cache(maxsize=1)
def _load(script: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location("judge", script)
    assert spec is not None and spec.loader is not None
    judge = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(judge)
    judge.Topology.components = _remembered(judge.Topology.components)
    for name in ("Topology", "triangulate", "feature_edges"):
        setattr(judge, name, _remembered(getattr(judge, name)))
    return judge


@functools.lru_cache(maxsize=REMEMBERED)
def _input(script: Path, source: Path, modified: int) -> tuple[Any, Any]:
    """The same two objects for the same file, by which `_remembered` knows them."""
    judge = _load(script)
    vertices, faces = judge.weld(*judge.read_obj(source))
    return vertices, faces


def _remembered(function: Callable[..., Any]) -> Callable[..., Any]:
    """A pure function that answers at once where it is called with the very same objects again."""
    answers: OrderedDict[tuple[Any, ...], tuple[Any, Any]] = OrderedDict()

    @functools.wraps(function)
    def call(*arguments: Any) -> Any:
        key = tuple(a if isinstance(a, int | float) else id(a) for a in arguments)
        if key not in answers:
            answers[key] = (arguments, function(*arguments))  # kept objects keep their ids
            if len(answers) > 2 * REMEMBERED:
                answers.popitem(last=False)
        answers.move_to_end(key)
        return answers[key][1]

    return call


@functools.cache
def judges(script: Path) -> Judges:
    """Those of a script, started where they are first asked for."""
    return Judges(script, os.cpu_count() or 1)


def judged(script: Path, quads: int, source: Path, result: Path, report: Path, seconds: float) -> dict[str, Any]:
    """What the judge says of a result, also written to `report`; `failed` names it where it says nothing.

    Parameters
    ----------
    script : Path
        The judge.
    quads : int
        The number asked for.
    seconds : float
        It may take so long.
    """
    judgement = judges(script).ask(quads, source, result, seconds)
    report.write_text(json.dumps(judgement, indent=1))
    return judgement
