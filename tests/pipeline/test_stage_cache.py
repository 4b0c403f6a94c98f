"""Runs that share a cache give what they give alone, and do again only what depends on what has changed."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from hybrid_quad import RemeshOptions, StageCache, Stroke, preview, remesh
from hybrid_quad.core import stage_cache

FIRST = {"mesh", "features and sizes", "working surface"}


def torus(bumps: float = 0.06) -> tuple[np.ndarray, np.ndarray]:
    """A closed surface without a symmetry that the sizes could hide behind."""
    n = 24
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    u, v = np.meshgrid(angle, angle, indexing="ij")
    r = 0.4 + bumps * np.sin(2 * u + 0.3) * np.cos(3 * v)
    points = np.stack([(1 + r * np.cos(v)) * np.cos(u), (1 + r * np.cos(v)) * np.sin(u), r * np.sin(v)], axis=-1)
    i = np.arange(n * n).reshape(n, n)
    j = np.roll(i, -1, axis=0)
    return points.reshape(-1, 3), np.stack([i, j, np.roll(j, -1, 1), np.roll(i, -1, 1)], axis=-1).reshape(-1, 4)


def two_tori() -> tuple[np.ndarray, np.ndarray]:
    points, faces = torus()
    return np.concatenate([points, 0.5 * points + [3, 0, 0]]), np.concatenate([faces, faces + len(points)])


def along_x(points: np.ndarray) -> np.ndarray:
    return np.tile([1.0, 0.0, 0.0], (len(points), 1))


def denser_above(points: np.ndarray) -> np.ndarray:
    return np.where(points[:, 2] > 0, 2.0, 1.0)


def bits_of(found) -> dict[str, bytes]:
    """Every array of a result, and the report without what takes time."""
    arrays = {name: value.tobytes() for name, value in vars(found).items() if isinstance(value, np.ndarray)}
    report = {name: value for name, value in found.report.items() if name not in ("stages", "seconds", "peak_mb")}
    return arrays | {"report": repr(report).encode()}


CHANGES = {
    "nothing": {},
    "directions": {"guides": along_x},
    "count": {"quads": 420},
    "density": {"density": denser_above},
    "directions and density": {"guides": along_x, "density": denser_above},
    "curvature": {"adaptivity": 0.8},
    "mirror": {"symmetry": "z"},
    "directions in a mirror": {"symmetry": "z", "guides": along_x},
    "anisotropy": {"anisotropy": 2.0, "guides": along_x},
    "loop": {"strokes": [Stroke([[1.4, 0, 0], [0, 1.4, 0], [-1.4, 0, 0]])], "guides": along_x},
}


SETTINGS = ("quads", "adaptivity", "anisotropy", "symmetry")


def run(surface, change: dict, solve: str, cache: StageCache | None):
    points, faces = surface
    wishes = {key: wish(points) if callable(wish) else wish for key, wish in change.items()}
    asked = {"quads": 300} | {key: wishes.pop(key) for key in change if key in SETTINGS}
    if solve == "remesh":
        return remesh(points, faces, **asked, **wishes, cache=cache)
    return preview(points, faces, RemeshOptions(**asked), with_quads=solve == "quads", **wishes, cache=cache)


@pytest.mark.parametrize("solve", ["field", "quads", "remesh"])
@pytest.mark.parametrize("surface", [torus, two_tori])
def test_results_are_those_without_a_cache(solve, surface):
    cache = StageCache()
    made = surface()
    # Each after another one, and again after itself.
    for name in [*CHANGES, *(name for name in CHANGES for _ in range(2))]:
        found, expected = (run(made, CHANGES[name], solve, used) for used in (cache, None))
        assert bits_of(found) == bits_of(expected), name


def test_what_does_not_depend_on_a_change_is_not_done_again():
    points, faces = torus()
    cache = StageCache()

    def recalled(quads: int = 300, **more) -> set[str]:
        preview(points, faces, RemeshOptions(quads=quads), cache=cache, **more)
        return set(cache.recalled)

    assert recalled() == set()
    assert recalled() == {*FIRST, "frame field"}
    assert recalled(guides=along_x(points)) == FIRST
    assert recalled(guides=0.5 * along_x(points)) == {*FIRST, "index of component"}
    assert recalled(quads=350) == {"mesh"}
    assert recalled(quads=350, density=denser_above(points)) == {"mesh"}
    points = torus(bumps=0.1)[0]
    assert recalled() == set()


def test_quads_go_on_from_the_field_that_was_shown():
    points, faces = torus()
    cache = StageCache()
    options = RemeshOptions(quads=300)
    preview(points, faces, options, cache=cache)
    preview(points, faces, options, cache=cache, with_quads=True)
    assert cache.recalled == {*FIRST, "frame field"}
    remesh(points, faces, quads=300, cache=cache)
    assert cache.recalled == {*FIRST, "frame field", "index of whole"}


def test_a_stopped_run_leaves_nothing_wrong_behind():
    points, faces = torus()
    cache = StageCache()
    options = RemeshOptions(quads=300)
    expected = bits_of(preview(points, faces, options))
    for stop_after in range(1, 12):
        polls = iter(range(stop_after))
        try:
            preview(points, faces, options, cache=cache, cancel=lambda left=polls: next(left, None) is None)
        except Exception as error:
            assert type(error).__name__ == "Cancelled"
        assert bits_of(preview(points, faces, options, cache=cache)) == expected


def test_a_cache_in_use_and_a_huge_surface_are_runs_without_it(monkeypatch):
    points, faces = torus()
    cache = StageCache()
    options = RemeshOptions(quads=300)
    expected = bits_of(preview(points, faces, options))
    found = []

    def another(*_: object) -> None:
        if not found:
            found.append(None)
            thread = threading.Thread(target=lambda: found.append(preview(points, faces, options, cache=cache)))
            thread.start()

    assert bits_of(preview(points, faces, options, cache=cache, progress=another)) == expected
    while len(found) < 2:
        pass
    assert bits_of(found[1]) == expected
    monkeypatch.setattr(stage_cache, "MOST_POLYGONS", len(faces) - 1)
    preview(points, faces, options, cache=cache)
    preview(points, faces, options, cache=StageCache())
    other = StageCache()
    preview(points, faces, options, cache=other)
    preview(points, faces, options, cache=other)
    assert other.recalled == set()
