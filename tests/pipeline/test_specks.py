"""Parts smaller than a quad: what they get, the rest of the surface pays for (docs/decisions/0056)."""

import numpy as np
import pytest

import hybrid_quad
from support import surfaces
from support.results import assert_sound

PARTS = 40
BLADE = (
    [[0, 0, 0], [1, 0, 0], [0.5, 0.25, 0], [0.5, -0.25, 0], [0.7, 0, 2]],
    [
        [0, 2, 1],
        [0, 1, 3],
        [0, 4, 2],
        [2, 4, 1],
        [1, 4, 3],
        [3, 4, 0],
    ],
)


def beside_specks(part):
    """A sphere, and forty times a part a twenty-fifth as large around it."""
    vertices, faces = surfaces.sphere(12)
    all_vertices, all_faces, count = [vertices], [faces], len(vertices)
    for angle in 2 * np.pi * np.arange(PARTS) / PARTS:
        all_vertices.append(0.04 * np.array(part[0]) + [2 * np.cos(angle), 2 * np.sin(angle), 0])
        all_faces.append(np.array(part[1]) + count)
        count += len(part[0])
    return np.concatenate(all_vertices), np.concatenate(all_faces)


@pytest.mark.parametrize("part", [BLADE, surfaces.box(2), surfaces.sphere(3)], ids=["blade", "box", "sphere"])
def test_the_body_keeps_its_quads(part):
    vertices, faces = beside_specks(part)
    result = hybrid_quad.remesh(vertices, faces, quads=1000)
    assert_sound(result, faces)
    assert abs(len(result.quads) / 1000 - 1) < 0.05
    middles = result.vertices[result.quads].mean(axis=1)
    of_body = int((np.linalg.norm(middles, axis=1) < 1.5).sum())
    of_each = (len(result.quads) - of_body) / PARTS
    assert of_each >= 6, "no closed surface has fewer"
    assert of_each <= 9, "a few more than that: each is smaller than one quad"
    assert result.report["scaled_jacobian"]["min"] > 0.2
