"""What a caller asks of places on the surface: directions, densities, frames, and what follows the curvature."""

import json

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.cli.main import main
from support import surfaces
from support.results import assert_sound


def quad_edges(result):
    quads = result.quads
    a = result.vertices[quads]
    b = result.vertices[np.roll(quads, -1, axis=1)]
    return a.reshape(-1, 3), b.reshape(-1, 3)


def slanted(points, angle=0.5):
    """Unit directions on the torus about z, turned by an angle from the parallels."""
    ring = np.stack([-points[:, 1], points[:, 0], np.zeros(len(points))], axis=1)
    ring /= np.linalg.norm(ring, axis=1, keepdims=True)
    out = points[:, :2] / np.linalg.norm(points[:, :2], axis=1, keepdims=True)
    normal = points - np.c_[out, np.zeros(len(points))]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.cos(angle) * ring + np.sin(angle) * np.cross(normal, ring)


def degrees_off(directions, guides):
    """Angle to the nearest of a guide's four directions."""
    cosine = np.abs((directions * guides).sum(axis=1)) / np.linalg.norm(directions, axis=1)
    angle = np.degrees(np.arccos(np.clip(cosine, 0, 1)))
    return np.minimum(angle, 90 - angle)


@pytest.mark.parametrize("by_face", [False, True])
def test_edges_follow_guides(by_face):
    vertices, faces = surfaces.torus()
    places = np.array([np.mean(np.asarray(vertices)[list(face)], axis=0) for face in faces]) if by_face else vertices
    guides = slanted(np.asarray(places, float)) * (np.asarray(places)[:, :1] > 0)
    result = hybrid_quad.remesh(vertices, faces, quads=1500, sharp_angle=None, guides=guides)
    assert_sound(result, faces)
    a, b = quad_edges(result)
    middle = (a + b) / 2
    off = degrees_off(b - a, slanted(middle))
    guided = middle[:, 0] > 0.25
    assert np.median(off[guided]) <= 5
    assert np.median(off[guided]) < np.median(off[~guided])


def test_a_guide_of_no_length_is_none():
    vertices, faces = surfaces.torus()
    plain = hybrid_quad.remesh(vertices, faces, quads=600)
    free = hybrid_quad.remesh(vertices, faces, quads=600, guides=np.zeros((len(vertices), 3)))
    assert np.array_equal(plain.vertices, free.vertices)
    assert np.array_equal(plain.quads, free.quads)


def test_density_shortens_edges_and_keeps_the_count():
    vertices, faces = surfaces.torus()
    density = np.where(np.asarray(vertices)[:, 0] > 0.3, 2.0, 1.0)
    result = hybrid_quad.remesh(vertices, faces, quads=3000, sharp_angle=None, density=density)
    assert_sound(result, faces)
    assert abs(len(result.quads) / 3000 - 1) < 0.06
    a, b = quad_edges(result)
    length = np.linalg.norm(b - a, axis=1)
    ratio = np.median(length[a[:, 0] > 0.5]) / np.median(length[a[:, 0] < -0.3])
    assert ratio == pytest.approx(0.5, rel=0.15)


def test_an_even_density_scales_a_given_edge_length_only():
    vertices, faces = surfaces.sphere(10)
    twice = np.full(len(vertices), 2.0)
    by_count = hybrid_quad.remesh(vertices, faces, quads=800, density=twice)
    assert abs(len(by_count.quads) / 800 - 1) < 0.1
    length = 0.2
    plain = hybrid_quad.remesh(vertices, faces, edge_length=length)
    fine = hybrid_quad.remesh(vertices, faces, edge_length=length, density=twice)
    assert len(fine.quads) / len(plain.quads) == pytest.approx(4, rel=0.15)


def test_frames_stretch_quads():
    vertices, faces = surfaces.torus()
    points = np.asarray(vertices, float)
    frames = np.stack([1.6 * slanted(points, 0), 0.8 * slanted(points, np.pi / 2)], axis=1)
    result = hybrid_quad.remesh(vertices, faces, quads=1500, sharp_angle=None, frames=frames)
    assert_sound(result, faces)
    a, b = quad_edges(result)
    length = np.linalg.norm(b - a, axis=1)
    along = np.abs(((b - a) * slanted((a + b) / 2, 0)).sum(axis=1)) > 0.7 * length
    assert np.median(length[along]) / np.median(length[~along]) == pytest.approx(2, rel=0.2)


@pytest.mark.parametrize("option", [{"adaptivity": 1.0}, {"anisotropy": 3.0}, {"field_smoothness": 0.0}])
@pytest.mark.parametrize("name", ["sphere", "torus", "box", "wavy_grid"])
def test_sound_whatever_follows_the_curvature(option, name):
    vertices, faces = {
        "sphere": surfaces.sphere(10),
        "torus": surfaces.torus(),
        "box": surfaces.box(8),
        "wavy_grid": surfaces.wavy_grid(),
    }[name]
    result = hybrid_quad.remesh(vertices, faces, quads=500, **option)
    assert_sound(result, faces)
    assert result.report["options"][next(iter(option))] == next(iter(option.values()))


@pytest.mark.parametrize("name", ["guides", "density", "frames"])
def test_what_is_not_finite_is_refused_by_name_and_place(name):
    vertices, faces = surfaces.sphere(4)
    shape = {"guides": (3,), "density": (), "frames": (2, 3)}[name]
    values = np.ones((len(vertices), *shape))
    values[6] = np.nan
    with pytest.raises(hybrid_quad.InputError, match=name) as caught:
        hybrid_quad.remesh(vertices, faces, quads=100, **{name: values})
    assert caught.value.code == f"non_finite_{name}"
    assert list(caught.value.elements) == [6]
    assert f"The {name} {'is' if name == 'density' else 'are'} not finite at vertex 6." in str(caught.value)


@pytest.mark.parametrize("name", ["guides", "density", "frames"])
def test_what_a_vertex_without_faces_is_asked_makes_no_difference(name):
    vertices, faces = surfaces.sphere(4)
    loose = [*vertices, (9.0, 9.0, 9.0)]
    shape = {"guides": (3,), "density": (), "frames": (2, 3)}[name]
    values = np.full((len(loose), *shape), 1.0 if name == "density" else 0.0)
    plain = hybrid_quad.remesh(loose, faces, quads=100, **{name: values})
    values[-1] = np.nan
    asked = hybrid_quad.remesh(loose, faces, quads=100, **{name: values})
    assert np.array_equal(asked.vertices, plain.vertices)


@pytest.mark.parametrize("name", ["guides", "density", "frames"])
def test_what_has_another_shape_is_refused(name):
    vertices, faces = surfaces.sphere(4)
    with pytest.raises(ValueError, match=name):
        hybrid_quad.remesh(vertices, faces, quads=100, **{name: np.ones((5, 2))})


def test_parallel_frame_vectors_are_refused():
    vertices, faces = surfaces.sphere(4)
    frames = np.zeros((len(vertices), 2, 3))
    frames[3] = [[1, 0, 0], [2, 0, 0]]
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices, faces, quads=100, frames=frames)
    assert caught.value.code == "degenerate_frame"
    assert list(caught.value.elements) == [3]


def test_a_chord_error_decides_how_many_quads_there_are():
    vertices, faces = surfaces.torus()
    few, many = (hybrid_quad.remesh(vertices, faces, sharp_angle=None, chord_error=error) for error in (0.04, 0.01))
    for result in (few, many):
        assert_sound(result, faces)
    assert 2 < len(many.quads) / len(few.quads) < 6
    assert many.report["mean_distance_percent"] < few.report["mean_distance_percent"]


def write_obj(path, vertices, faces):
    rows = [f"v {x} {y} {z}" for x, y, z in vertices]
    rows += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(rows) + "\n")


def test_the_command_line_takes_a_density_and_settings(tmp_path):
    vertices, faces = surfaces.torus()
    source, target, report, file = (tmp_path / name for name in ("in.obj", "out.obj", "report.json", "density.txt"))
    write_obj(source, vertices, faces)
    density = np.where(np.asarray(vertices)[:, 0] > 0.3, 2.0, 1.0)
    file.write_text("# one a vertex\n" + "\n".join(map(str, density)))
    arguments = ["remesh", str(source), str(target), "--quads", "1500", "--density", str(file), "--report", str(report)]
    settings = ["--field-smoothness", "0.7", "--adaptivity", "0.2", "--anisotropy", "1.5", "--size-fidelity", "0.6"]
    assert main([*arguments, *settings, "--no-sharp", "--quiet"]) == 0
    options = json.loads(report.read_text())["options"]
    assert [options[name] for name in ("field_smoothness", "adaptivity", "anisotropy", "size_fidelity")] == [
        0.7,
        0.2,
        1.5,
        0.6,
    ]
    points = np.array([line.split()[1:] for line in target.read_text().splitlines() if line.startswith("v ")], float)
    assert (points[:, 0] > 0.3).sum() > 1.5 * (points[:, 0] < -0.3).sum()


def test_the_command_line_takes_a_chord_error_or_a_count(tmp_path):
    vertices, faces = surfaces.torus()
    source, target, report = (tmp_path / name for name in ("in.obj", "out.obj", "report.json"))
    write_obj(source, vertices, faces)
    arguments = ["remesh", str(source), str(target), "--chord-error", "0.03", "--quiet", "--report", str(report)]
    assert main([*arguments, "--quads", "500"]) == 2
    assert not target.exists()
    assert main([*arguments, "--narrow-quads", "1"]) == 0
    options = json.loads(report.read_text())["options"]
    assert (options["chord_error"], options["narrow_quads"]) == (0.03, 1)


def test_a_limit_surface_on_the_input_and_how_near_it_comes(tmp_path):
    vertices, faces = surfaces.torus()
    source, target, report = (tmp_path / name for name in ("in.obj", "out.obj", "report.json"))
    write_obj(source, vertices, faces)
    arguments = ["remesh", str(source), str(target), "--quads", "500", "--quiet", "--report", str(report)]
    assert main(arguments) == 0
    assert json.loads(report.read_text())["limit_distance_percent"] is None
    assert main([*arguments, "--fit-limit"]) == 0
    made = json.loads(report.read_text())
    assert made["options"]["fit_limit_surface"] is True
    before, after = (made["limit_distance_percent"][when] for when in ("before", "after"))
    assert after["mean"] < 0.25 * before["mean"]
    result = hybrid_quad.remesh(vertices, faces, quads=500, fit_limit_surface=True)
    assert_sound(result, faces)


def test_edge_loops_of_a_torus_close():
    vertices, faces = surfaces.torus()
    loops = hybrid_quad.remesh(vertices, faces, quads=500, sharp_angle=None).report["edge_loops"]
    assert loops["closed"] > 0 and loops["longest"] >= loops["median_length"] > 1
    assert set(loops) == {
        "closed", "open", "longest", "median_length", "self_crossing", "spirals", "longest_spiral",
    }  # fmt: skip


def test_a_density_file_that_does_not_fit_is_wrong_usage(tmp_path):
    vertices, faces = surfaces.sphere(4)
    source, file = tmp_path / "in.obj", tmp_path / "density.txt"
    write_obj(source, vertices, faces)
    file.write_text("1\n2\n")
    assert main(["remesh", str(source), str(tmp_path / "out.obj"), "--density", str(file), "--quiet"]) == 2
    file.write_text("1 2\n")
    assert main(["remesh", str(source), str(tmp_path / "out.obj"), "--density", str(file), "--quiet"]) == 2
