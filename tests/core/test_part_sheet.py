"""Which borders a part has, and how they become even."""

import numpy as np
import pytest

from hybrid_quad import InputError
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.part_parity import even_part
from hybrid_quad.core.part_sheet import CUT, FREE, SHARED, border_length, sheet_of
from support import surfaces


def disc_of(vertices, faces, radius, hole=0.0):
    distance = np.linalg.norm(vertices[faces].mean(axis=1)[:, :2] - 0.5, axis=1)
    return (distance < radius) & (distance >= hole)


def random_parts(seed, count=20):
    vertices, faces = surfaces.grid(12, 12)
    generator = np.random.default_rng(seed)
    for _ in range(count):
        yield vertices, faces, generator.random(len(faces)) < generator.uniform(0.1, 0.9)


def test_loops_are_all_sides_of_the_border_once_and_in_order():
    for vertices, faces, part in random_parts(1):
        sheet = sheet_of(as_polygons(faces), len(vertices), part)
        loops = sheet.loops()
        sides = np.concatenate(loops)
        assert sorted(sides.tolist()) == np.flatnonzero(sheet.kinds != 0).tolist()
        for loop in loops:
            begin, end = sheet.sides[loop].T
            assert np.array_equal(np.roll(begin, -1), end)
            assert len(np.unique(begin)) == len(begin)  # where the part touches itself, the sheet does not


def test_sides_are_shared_exactly_where_the_rest_has_them():
    for vertices, faces, part in random_parts(2):
        sheet = sheet_of(as_polygons(faces), len(vertices), part)
        edges = {
            tuple(sorted(pair))
            for face in faces[~part].tolist()
            for pair in zip(face, face[1:] + face[:1], strict=True)
        }
        pairs = np.sort(sheet.origin[sheet.sides], axis=1).tolist()
        assert [kind == SHARED for kind in sheet.kinds] == [tuple(pair) in edges for pair in pairs]
        at_rim = np.isclose(vertices[np.array(pairs)][:, :, :2], 0) | np.isclose(vertices[np.array(pairs)][:, :, :2], 1)
        assert np.array_equal(sheet.kinds == FREE, at_rim.all(axis=1).any(axis=1))


@pytest.mark.parametrize("odd_border", ["grow", "shrink"])
def test_all_borders_become_even_or_free(odd_border):
    settled = 0
    for vertices, faces, part in random_parts(3, 60):
        try:
            found = even_part(vertices, as_polygons(faces), part, odd_border)
        except InputError as error:
            assert error.code in ("odd_border", "no_part")
            continue
        settled += 1
        more = found.part ^ part
        assert not (more & part if odd_border == "grow" else more & ~part).any()
        for loop in found.sheet.loops():
            kinds = found.sheet.kinds[loop]
            assert (kinds == FREE).any() or (kinds == SHARED).sum() % 2 == 0
    assert settled > 40


def test_an_odd_border_is_refused_and_named():
    vertices, faces = surfaces.grid(4, 4)
    part = np.zeros(len(faces), bool)
    part[5] = True
    with pytest.raises(InputError) as refused:
        even_part(vertices, as_polygons(faces), part)
    assert refused.value.code == "odd_border" and refused.value.element_kind == "edge"
    assert {*refused.value.elements} == {*faces[5].tolist()}


def test_two_odd_borders_are_joined_by_one_cut():
    vertices, faces = surfaces.grid(20, 20)
    part = disc_of(vertices, faces, 0.4, 0.15)
    outer, inner = faces[disc_of(vertices, faces, 0.5, 0.4)], faces[disc_of(vertices, faces, 0.15)]
    assert len(outer) and len(inner)
    # One triangle less at either border makes both odd.
    for side in (outer, inner):
        edges = {tuple(sorted(p)) for face in side.tolist() for p in zip(face, face[1:] + face[:1], strict=True)}
        for index in np.flatnonzero(part):
            face = faces[index].tolist()
            if sum(tuple(sorted(p)) in edges for p in zip(face, face[1:] + face[:1], strict=True)) == 1:
                part[index] = False
                break
    found = even_part(vertices, as_polygons(faces), part)
    assert len(found.cuts) == 1 and len(found.sheet.loops()) == 1
    cut = found.cuts[0]
    assert (found.sheet.kinds == CUT).sum() == 2 * (len(cut.forward) - 1)
    assert np.array_equal(found.sheet.origin[list(cut.forward)], found.sheet.origin[list(cut.backward)][::-1])


def test_what_has_no_clear_border_is_refused():
    vertices, faces = surfaces.grid(2, 2)
    part = np.ones(len(faces), bool)
    flipped = faces.copy()
    flipped[0] = flipped[0][::-1]
    for bad, code in (
        (flipped, "flipped_part"),
        (np.concatenate([faces, [[0, 1, 8]], [[1, 0, 5]]]), "non_manifold_part"),
    ):
        with pytest.raises(InputError) as refused:
            sheet_of(as_polygons(bad), len(vertices), np.resize(part, len(bad)))
        assert refused.value.code == code and refused.value.element_kind == "edge" and refused.value.elements


def test_length_of_the_border():
    vertices, faces = surfaces.grid(10, 10)
    part = (vertices[faces].mean(axis=1)[:, 0] < 0.5) & (vertices[faces].mean(axis=1)[:, 1] < 0.5)
    assert border_length(vertices, sheet_of(as_polygons(faces), len(vertices), part)) == pytest.approx(0.1)
