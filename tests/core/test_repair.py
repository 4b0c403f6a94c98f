"""The repaired mesh: a sound one, of the same surface, that says where it comes from."""

from __future__ import annotations

import numpy as np
import pytest

import hybrid_quad
from support import surfaces


def test_a_sound_mesh_stays_as_it_is():
    vertices, faces = surfaces.torus()
    found = hybrid_quad.repair(vertices, faces)
    assert np.array_equal(found.vertices, vertices[found.vertex_origins])
    assert len(found.triangles) == len(faces) and not found.defects


def test_what_was_wrong_is_right_afterwards_and_said():
    vertices, faces = surfaces.box()
    wrong = np.vstack([np.where(np.arange(len(faces))[:, None] < 5, faces[:, ::-1], faces), faces[:1]])
    found = hybrid_quad.repair(np.vstack([vertices, [[9, 9, 9]]]), wrong)
    assert {"flipped_face", "duplicate_face", "isolated_vertex"} <= {defect.code for defect in found.defects}
    assert all(defect.repairable for defect in found.defects)
    left = hybrid_quad.check(found.vertices, found.triangles)
    assert not [defect for defect in left if not defect.kept]
    assert found.face_origins.max() < len(wrong) and found.vertex_origins.max() < len(vertices)


def test_what_is_no_surface_is_refused():
    with pytest.raises(hybrid_quad.InputError):
        hybrid_quad.repair([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])


def test_sheets_that_are_cut_apart_have_vertices_of_their_own():
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 2, 0)]
    found = hybrid_quad.repair(corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3), (1, 2, 4)])
    edges = np.sort(np.stack([found.triangles, np.roll(found.triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    assert np.unique(edges, axis=0, return_counts=True)[1].max() == 2
    own = found.vertex_origins >= 0
    assert set(found.vertex_origins[own]) == set(range(5))
    assert np.array_equal(found.vertices[own], np.array(corners)[found.vertex_origins[own]])
    distances = hybrid_quad.surface_distances(
        found.vertices, corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3), (1, 2, 4)]
    )
    assert distances.max() == 0
