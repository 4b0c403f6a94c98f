"""Why quads are badly shaped: measured on surfaces that have one cause each. Edges are 1 long."""

import itertools
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import shape_causes as causes
from input_patch import Ball, InputSurface
from kept_lines import KeptLines, line_edges
from shape_causes import Inspector, Measured
from support import surfaces

ROOT = Path(__file__).resolve().parents[2]
CONCAVE = [(2.0, 2.0, 0.0), (3.0, 2.0, 0.0), (2.2, 2.2, 0.0), (2.0, 3.0, 0.0)]


def measured(surface, corners, sharp=40.0):
    """The first quad, of which four of `corners` each are one."""
    points, triangles = surface
    vertices = np.array(corners, float).reshape(-1, 3)
    quads = np.arange(len(vertices)).reshape(-1, 4)
    made = InputSurface(np.array(points, float), triangles)
    lines = KeptLines(made, line_edges(made, sharp), vertices, quads, 1.0)
    return Inspector(made, lines, vertices, quads, 1.0).measure(0)


def extruded(profile, depth=4.0, rows=8):
    """A surface with a profile (k, 2) in x and z, along y."""
    k = len(profile)
    points, triangles = surfaces.grid(k - 1, rows, 1.0, depth)
    points[:, 0], points[:, 2] = np.tile(np.array(profile, float), (rows + 1, 1)).T
    return points, triangles


def plate(thickness):
    """4 x 4, its rim at x = 4 round enough for a 180 degree turn of normals in one step."""
    x = np.linspace(0, 4, 9)
    return extruded([*zip(x, 0 * x, strict=True), *zip(x[::-1], 0 * x + thickness, strict=True)])


def test_a_quad_with_room_is_open():
    at = measured(surfaces.grid(10, 10, 5.0, 5.0), CONCAVE)
    assert (at.cause, at.fold, at.degrees_a_quad) == (causes.OPEN, 0, 0)


@pytest.mark.parametrize("degrees", [5.0, 25.0, 35.0, 60.0])
def test_an_acute_tip(degrees):
    rays = np.radians(np.linspace(0, degrees, 5))
    points = [(0, 0, 0), *((2 * np.cos(ray), 2 * np.sin(ray), 0) for ray in rays)]
    fan = np.array([(0, i, i + 1) for i in range(1, 5)])
    end = np.radians(degrees)
    quad = [
        (0, 0, 0),
        (2, 0, 0),
        (2.6 * np.cos(end / 2), 2.6 * np.sin(end / 2), 0),
        (2 * np.cos(end), 2 * np.sin(end), 0),
    ]
    at = measured((points, fan), quad)
    assert at.tip == pytest.approx(degrees)
    assert (at.cause == causes.TIP) == (degrees < causes.ACUTE_DEGREES)


@pytest.mark.parametrize("width, cause", [(0.3, causes.LINES), (1.4, causes.OPEN)])
def test_two_creases(width, cause):
    """Only those that the quads' edges follow count."""
    surface = extruded([(-3, 0), (0, 0), (width * np.sqrt(0.5), width * np.sqrt(0.5)), (6, width * np.sqrt(0.5))])
    a, b = (0, 0), (width * np.sqrt(0.5), width * np.sqrt(0.5))
    quad = [(a[0], 1, a[1]), (b[0], 1, b[1]), (b[0], 2, b[1]), (a[0], 2, a[1])]
    at = measured(surface, quad)
    assert at.cause == cause
    if cause == causes.LINES:
        assert at.gap == pytest.approx(width, rel=0.05)
    elsewhere = [(x - 2.0, y, 0) for x, y, _ in quad]
    assert measured(surface, elsewhere).gap == np.inf
    assert measured(surface, quad, sharp=None).gap == np.inf


def test_corners_of_a_line():
    """A spike of the boundary, shorter than a quad."""
    outline = [(0, 0), (2, 0), (2.02, 0.3), (2.04, 0), (4, 0)]
    top = [(x, 3) for x, _ in outline]
    points = [(x, y, 0) for x, y in [*outline, *top]]
    triangles = np.array([t for i in range(4) for t in ((i, i + 1, i + 6), (i, i + 6, i + 5))])
    chain = [(1, 0, 0), (2, 0, 0), (2.02, 0.3, 0), (2.04, 0, 0), (3, 0, 0)]
    quads = [corner for a, b in itertools.pairwise(chain) for corner in (a, b, (b[0], 1, 0), (a[0], 1, 0))]
    at = measured((points, triangles), quads)
    assert at.cause == causes.LINES
    assert at.corners == pytest.approx(0.04)


def test_a_fold():
    turn = np.linspace(-np.pi / 2, np.pi / 2, 9)
    sheet = [(-3, 0), *zip(0.2 * np.cos(turn), 0.2 + 0.2 * np.sin(turn), strict=True), (-3, 0.4)]
    rim = [(-0.4, 1, 0), (0.2, 1.5, 0.2), (-0.4, 2, 0.4), (-0.4, 1.5, 0)]
    assert measured(extruded(sheet), rim, sharp=None).cause == causes.FOLD
    bend = extruded([(-3, 0), (0, 0), (0, 3)])  # a right angle is no fold
    at = measured(bend, [(-0.4, 1, 0), (0, 1, 0.4), (0, 2, 0.4), (-0.4, 2, 0)], sharp=None)
    assert at.fold == pytest.approx(90)
    assert at.cause == causes.OPEN


def test_a_thin_sheet_counts_near_its_rim():
    def quad(x):
        return [(x - 0.3, 1.5, 0), (x - 0.3, 2.5, 0), (x + 0.3, 2.5, 0), (x + 0.3, 1.5, 0)][::-1]

    at = measured(plate(0.3), quad(3.2), sharp=None)
    assert at.cause == causes.SHEET
    assert at.sheet == pytest.approx(0.3)
    assert measured(plate(0.3), quad(1.5), sharp=None).cause == causes.OPEN
    assert measured(plate(0.6), quad(3.2), sharp=None).sheet == np.inf


def test_a_hole_with_too_few_edges_around():
    points, faces = surfaces.annulus()  # of radii 0.5 and 1.5
    quad = [(0.2, -0.1, 0), (0.3, -0.1, 0), (0.3, 0.1, 0), (0.2, 0.1, 0)]
    small = measured((points * 0.4, faces), quad)
    assert small.cause == causes.NECK
    assert small.around == 2
    assert measured((points * 3, faces), [(x + 1.3, y, z) for x, y, z in quad]).around == np.inf


def test_euler_numbers_in_balls():
    def number(surface, centre, radius):
        made = InputSurface(*surface)
        ball = Ball(np.array(centre, float), radius)
        faces, distance = made.faces_in(ball)
        return made.euler_number(ball, int(faces[distance.argmin()]))

    assert number(surfaces.grid(9, 9), (0.5, 0.5, 0), 0.3) == 1
    assert number(surfaces.grid(9, 9), (0.0, 0.0, 0), 0.3) == 1
    assert number(surfaces.annulus(), (1, 0, 0), 0.3) == 1
    assert number(surfaces.annulus(), (1, 0, 0), 3.0) == 0
    assert number(surfaces.cylinder(), (1, 0, 1.5), 1.0) == 1
    assert number(surfaces.cylinder(), (1, 0, 1.5), 2.1) == 0
    assert number(surfaces.sphere(), (1, 0, 0), 1.0) == 1
    assert number(surfaces.sphere(), (1, 0, 0), 3.0) == 2
    assert number(surfaces.torus(), (1.4, 0, 0), 5.0) == 0


def test_numbers_survive_their_file():
    at = Measured(tip=12.5, fold=3.0)
    assert Measured.of_json(json.loads(json.dumps(at.as_json()))) == at


def test_a_page_is_made_from_a_sweep(tmp_path):
    """Of one run with a concave quad in the middle of nowhere; measured once."""
    sweep, models = tmp_path / "sweep", tmp_path / "models"
    sweep.mkdir()
    models.mkdir()
    points, triangles = surfaces.grid(10, 10, 5.0, 5.0)
    write(models / "flat.obj", points, triangles)
    write(sweep / "flat_25_no_sharp.obj", np.array(CONCAVE), np.arange(4)[None])
    write(sweep / "flat_26_no_sharp.obj", points, triangles)
    outcome = {"model": "flat", "setting": "no_sharp", "status": "valid", "variant": "default"}
    rows = [
        {"build": "b", "name": f"flat_{n}_no_sharp", "quads": n, **outcome, "report": report(minimum)}
        for n, minimum in ((25, -0.6), (26, 0.9))
    ]
    (sweep / "results.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    command = [sys.executable, ROOT / "benchmarks" / "exceptions.py", "--sweep", sweep, "--models", models]
    command += ["--out", tmp_path / "out", "--page", tmp_path / "page.md"]
    pytest.importorskip("PIL")
    first = subprocess.run(command, capture_output=True, text=True, check=False)
    assert first.returncode == 1, first.stderr
    text = (tmp_path / "page.md").read_text()
    assert "| flat | 1 (25) | no | -" in text
    assert "open 1" in text
    (sweep / "flat_25_no_sharp.obj").write_text("")
    again = subprocess.run(command, capture_output=True, text=True, check=False)
    assert again.stdout == first.stdout


def report(minimum):
    return {"quads": 1, "input_faces": 200, "scaled_jacobian": {"min": minimum}}


def write(path, points, faces):
    lines = ["v {} {} {}\n".format(*point) for point in points]
    path.write_text("".join([*lines, *("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)]))
