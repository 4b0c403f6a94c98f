"""The field's two solutions, and what it asks of a mesh."""

import json

import numpy as np
import pytest

import hybrid_quad
from support import surfaces


@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
def test_corners_of_a_box_count_in_the_field_and_in_the_mesh(sharp_angle):
    vertices, faces = surfaces.box(8)
    report = hybrid_quad.remesh(vertices, faces, quads=600, sharp_angle=sharp_angle).report
    assert report["field_singularities"] == report["irregular_vertices"] == 8
    assert report["feature_singularities"] == (8 if sharp_angle else 0)


def test_the_border_counts_in_neither():
    vertices, faces = surfaces.grid(20, 15, 2.0, 1.5)
    report = hybrid_quad.remesh(vertices, faces, quads=300).report
    assert report["field_singularities"] == report["irregular_vertices"] == 0


def test_one_of_both_solutions_is_kept_for_every_component_and_none_is_better_in_all_respects():
    vertices, faces = surfaces.together(surfaces.torus(), surfaces.box(5))
    report = hybrid_quad.remesh(vertices, faces, quads=900).report
    solutions = report["field_solutions"]
    assert solutions["relaxed"]["kept"] + solutions["smoothest"]["kept"] == report["components"] == 2
    least = min(solution["singularities"] for solution in solutions.values())
    assert least <= report["field_singularities"]
    json.dumps(solutions)


def test_threads_make_no_difference_to_what_is_kept():
    vertices, faces = surfaces.sphere(8)
    vertices = np.asarray(vertices) * (1.0, 0.7, 0.4)
    one, two = (hybrid_quad.remesh(vertices, faces, quads=500, threads=threads) for threads in (1, 2))
    assert one.report["field_solutions"] == two.report["field_solutions"]
    assert np.array_equal(one.vertices, two.vertices)
