"""What the fuzzer makes and how it makes it smaller: cases that reach the stages they are meant for."""

import json

import numpy as np
import pytest

import hybrid_quad
from fuzz.cases import Case, load_case, make_case
from fuzz.fuzz_pipeline import shrink_stored
from fuzz.parallel_chains import with_parallel_chains
from fuzz.verdict import arguments_of
from hybrid_quad.core.validation import topology
from support import surfaces


def as_lists(faces):
    return [[int(v) for v in face] for face in faces]


class Begun(Exception):
    """The run has taken its arguments."""


def refusal_of(case):
    """Code with which a case is refused before its first stage is over, if it is."""

    def stop(snapshot):
        raise Begun

    try:
        hybrid_quad.remesh(case.vertices, case.faces, **arguments_of(case), on_snapshot=stop)
    except hybrid_quad.InputError as error:
        return error.code
    except Begun:
        return None
    raise AssertionError("a run has a first stage")


def test_most_frames_are_taken():
    cases = [case for case in map(make_case, range(180)) if "frames" in case.options]
    refusals = [refusal_of(case) for case in cases]
    assert len(cases) > 20
    assert refusals.count("degenerate_frame") <= 0.2 * len(cases)


def test_parallel_frames_would_be_noticed():
    vertices, faces = surfaces.grid(2, 2)
    options = {"frames": np.ones((len(vertices), 2, 3)).tolist()}
    assert refusal_of(Case(vertices, as_lists(faces), options)) == "degenerate_frame"


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    "surface", [surfaces.sphere(4), surfaces.grid(6, 6), surfaces.quad_box(), surfaces.annulus(9, 3)]
)
def test_parallel_chains_are_edges_side_by_side_and_cut_nothing_open(surface, seed):
    vertices = np.asarray(surface[0], float)
    faces = as_lists(surface[1])
    points, cut, features = with_parallel_chains(vertices, faces, np.random.default_rng(seed))
    assert topology(cut) == topology(faces)
    edges = {frozenset((face[i - 1], face[i])) for face in cut for i in range(len(face))}
    assert features and all(frozenset(edge) in edges for edge in features)
    made = points[len(vertices) :]
    gaps = np.linalg.norm(made[:, None] - vertices[None], axis=2).min(axis=1)
    longest = max(np.linalg.norm(vertices[face] - vertices[np.roll(face, 1)], axis=1).max() for face in faces)
    assert (gaps > 0).all() and (gaps <= 0.0101 * longest).all()


def test_some_cases_run_on_two_threads():
    threads = [make_case(seed).options.get("threads") for seed in range(40)]
    assert set(threads) == {None, 2}


def test_a_stored_case_is_made_smaller_as_long_as_it_is_refused_alike(tmp_path):
    vertices, faces = surfaces.grid(3, 3)
    frames = np.tile(np.eye(2, 3), (len(vertices), 1, 1))
    frames[0, 1] = frames[0, 0]
    options = {"quads": 20, "frames": frames.tolist(), "adaptivity": 0.5}
    Case(vertices, as_lists(faces), options).save(tmp_path)
    (tmp_path / "expected.json").write_text(json.dumps({"outcome": "refused", "code": "degenerate_frame"}))
    assert shrink_stored(tmp_path, 20.0) == 0
    smaller = load_case(tmp_path)
    assert (len(smaller.faces), sorted(smaller.options)) == (1, ["frames", "quads"])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["expected.json", "mesh.obj", "options.json"]


def test_a_valid_case_stays_as_it_is(tmp_path):
    vertices, faces = surfaces.grid(2, 2)
    Case(vertices, as_lists(faces), {"quads": 4}).save(tmp_path)
    assert shrink_stored(tmp_path, 20.0) == 1
    assert len(load_case(tmp_path).faces) == len(faces)
