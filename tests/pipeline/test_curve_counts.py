"""An exact number of quad edges along chains of edges, in Python and by the command line."""

import json

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.cli.main import main
from hybrid_quad.core.mesh_io import read_mesh
from support import surfaces
from support.results import assert_sound


def _on_edge(points, axis, corner):
    """Which points are on the line along an axis through a corner."""
    return np.isclose(np.delete(points, axis, axis=1), np.delete(corner, axis)).all(axis=1)


def _box_edge(vertices, axis):
    on = np.flatnonzero(_on_edge(vertices, axis, vertices.min(axis=0)))
    return on[np.argsort(vertices[on, axis])].tolist()


def _edges_along(result, vertices, axis):
    on = _on_edge(result.vertices, axis, vertices.min(axis=0))
    sides = np.sort(np.stack([result.quads, np.roll(result.quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    return len(np.unique(sides[on[sides].all(axis=1)], axis=0))


@pytest.mark.parametrize("quads", [400, 2000])
def test_two_edges_of_a_box(quads):
    vertices, faces = surfaces.box(8)
    asked = [(_box_edge(vertices, 0), 6), (np.array(_box_edge(vertices, 2)), 11)]
    result = hybrid_quad.remesh(vertices, faces, quads=quads, curve_counts=asked)
    assert_sound(result, faces)
    assert _edges_along(result, vertices, 0) == 6
    assert _edges_along(result, vertices, 2) == 11
    assert result.report["curve_counts"] == [{"asked": n, "got": n, "reason": ""} for n in (6, 11)]


@pytest.mark.parametrize("quads", [4, 8])
@pytest.mark.parametrize("count", [10, 20, 40])
def test_where_quads_are_scarce_counts_keep_their_features_or_give_way(quads, count):
    vertices, faces = surfaces.box(1)
    asked = [(_box_edge(vertices, 0), count)]
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=40.0, curve_counts=asked)
    assert_sound(result, faces)
    is_met = result.report["curve_counts"][0]["got"] == count
    assert is_met == (_edges_along(result, vertices, 0) == count)
    assert is_met or result.report["curve_counts"][0]["reason"]
    assert result.report["features_given_way"] == 0
    assert result.report["quads"] <= 10 * max(quads, result.report["fewest_quads"])


def test_no_curves_are_as_none():
    vertices, faces = surfaces.box(5)
    plain = hybrid_quad.remesh(vertices, faces, quads=300)
    empty = hybrid_quad.remesh(vertices, faces, quads=300, curve_counts=[])
    assert np.array_equal(plain.vertices, empty.vertices)
    assert plain.report["curve_counts"] == []


def test_what_parity_forbids_is_reported():
    vertices, faces = surfaces.cylinder()
    around = np.flatnonzero(np.isclose(vertices[:, 2], vertices[:, 2].min()))
    ring = around[np.argsort(np.arctan2(vertices[around, 1], vertices[around, 0]))].tolist()
    result = hybrid_quad.remesh(vertices, faces, quads=500, curve_counts=[([*ring, ring[0]], 17)])
    assert_sound(result, faces)
    (record,) = result.report["curve_counts"]
    assert record["asked"] == 17
    assert record["got"] in (16, 18)
    assert "even" in record["reason"]
    assert any("asked for 17" in warning for warning in result.report["warnings"])


def test_numbers_that_make_no_sense_are_told_as_they_were_given():
    vertices, faces = surfaces.quad_box(2)
    path = faces[0][:2].tolist()
    with pytest.raises(hybrid_quad.InputError, match="-3"):
        hybrid_quad.remesh(vertices, faces, curve_counts=[(path, -3)])
    with pytest.raises(TypeError, match="pairs of a path and a number"):
        hybrid_quad.remesh(vertices, faces, curve_counts=path)


def test_numbers_that_would_take_endlessly_short_edges_are_reported_as_missed():
    """Two more vertices on an edge of a box, near each other: between them fifty quads are asked for."""
    vertices, faces = surfaces.box(4)
    a, b = _box_edge(vertices, 0)[:2]
    on_edge = vertices[a] + np.array([[0.5], [0.5 + 1e-4]]) * (vertices[b] - vertices[a])
    c, d = len(vertices), len(vertices) + 1
    split = []
    for face in faces.tolist():
        corner = next((i for i in range(3) if {face[i], face[(i + 1) % 3]} == {a, b}), None)
        if corner is None:
            split.append(face)
            continue
        first, second, apex = face[corner], face[(corner + 1) % 3], face[(corner + 2) % 3]
        line = [first, c, d, second] if first == a else [first, d, c, second]
        split += [[line[i], line[i + 1], apex] for i in range(3)]
    result = hybrid_quad.remesh(np.vstack([vertices, on_edge]), split, quads=300, curve_counts=[([c, d], 50)])
    assert_sound(result, np.array(split))
    assert result.report["curve_counts"][0]["got"] < 50
    assert any("curve_counts" in warning for warning in result.report["warnings"])


def test_more_quads_along_curves_than_there_may_be_are_refused():
    vertices, faces = surfaces.box(4)
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices, faces, curve_counts=[(_box_edge(vertices, 0), 10**9)])
    assert caught.value.code == "wrong_count"


def test_errors_name_the_elements():
    vertices, faces = surfaces.box(4)
    path = _box_edge(vertices, 0)
    with pytest.raises(hybrid_quad.InputError) as refused:
        hybrid_quad.remesh(vertices, faces, quads=100, curve_counts=[([path[0], path[-1]], 4)])
    assert refused.value.code == "unknown_edge"
    assert sorted(refused.value.elements) == sorted([path[0], path[-1]])


def test_command_line(tmp_path):
    vertices, faces = surfaces.box(6)
    mesh, counts, out, report = (tmp_path / name for name in ("box.obj", "counts.txt", "out.obj", "report.json"))
    rows = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in vertices]
    rows += ["f " + " ".join(str(v + 1) for v in face) for face in np.asarray(faces).tolist()]
    mesh.write_text("\n".join(rows) + "\n")
    counts.write_text(" ".join(map(str, [9, *_box_edge(vertices, 1)])) + "\n")
    arguments = ["remesh", str(mesh), str(out), "--quads", "300", "--quiet"]
    arguments += ["--curve-counts", str(counts), "--report", str(report)]
    assert main(arguments) == 0
    assert json.loads(report.read_text())["curve_counts"] == [{"asked": 9, "got": 9, "reason": ""}]
    assert (read_mesh(out)[1].sizes == 4).all()
    counts.write_text("9 0 x\n")
    assert main(arguments) == 2
