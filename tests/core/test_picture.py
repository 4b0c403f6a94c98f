"""Pictures of quad meshes, and the files that they are written to."""

import struct
import zlib

import numpy as np
import pytest

from hybrid_quad.core import picture
from hybrid_quad.core.png_file import png_of

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int32)


def pixels_of(data):
    """The pixels of a file with a palette and unfiltered rows, by the specification; sums of its chunks are checked."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        chunks[kind] = data[at + 8 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + chunks[kind])
        at += 12 + size
    assert list(chunks) == [b"IHDR", b"PLTE", b"IDAT", b"IEND"]
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, width + 1)
    assert not rows[:, 0].any()
    return np.frombuffer(chunks[b"PLTE"], np.uint8).reshape(-1, 3)[rows[:, 1:]]


def flat_grid(count):
    u, v = np.meshgrid(np.linspace(0, 1, count + 1), np.linspace(0, 1, count + 1), indexing="ij")
    first = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    quads = np.stack([first, first + count + 1, first + count + 2, first + 1], axis=1).astype(np.int32)
    return np.stack([u.ravel(), 0 * u.ravel(), v.ravel()], axis=1), quads


def orange_places(pixels):
    return np.abs(pixels.astype(int) - picture._FEW).sum(axis=2) < 60


def test_a_picture_of_a_cube(tmp_path):
    picture.write_picture(tmp_path / "p.png", CORNERS, SIDES)
    pixels = pixels_of((tmp_path / "p.png").read_bytes())
    assert pixels.shape == (picture.HEIGHT, picture.WIDTH, 3)
    assert (pixels[0] == 255).all() and (pixels[:, 0] == 255).all()  # nothing at the rim
    assert orange_places(pixels).sum() > 50  # its corners, where three quads meet
    assert ((pixels != 255).any(axis=2)).mean() > 0.2


def test_what_is_nearer_hides_what_is_behind_it():
    """A large wall before the cube, whose corners have no colours as they are on the boundary."""
    wall = np.array([[-4, -3, -4], [5, -3, -4], [5, -3, 5], [-4, -3, 5]], float)
    vertices, quads = np.concatenate([CORNERS, wall]), np.concatenate([SIDES, [[8, 9, 10, 11]]]).astype(np.int32)
    assert orange_places(picture.draw(CORNERS, SIDES)).any()
    assert not orange_places(picture.draw(vertices, quads)).any()


@pytest.mark.parametrize("count", [1, 7, 60, 220])
def test_quads_of_every_size_are_drawn_without_gaps(count):
    filled = (picture.draw(*flat_grid(count)) != 255).any(axis=2)
    inside = [row[row.argmax() : len(row) - row[::-1].argmax()] for row in filled if row.any()]
    assert min(row.mean() for row in inside) == 1


def test_a_file_has_the_colours_that_it_can_have():
    few = np.zeros((5, 7, 3), np.uint8)
    few[1:3, 2:6], few[4, 4] = (200, 10, 30), (255, 255, 255)
    assert np.array_equal(pixels_of(png_of(few)), few)
    random = np.random.default_rng(0)
    many = random.integers(16, 256, (90, 80, 3)).astype(np.uint8)
    many[3, 3] = (1, 2, 3)
    found = pixels_of(png_of(many, colours=256, kept=[(1, 2, 3)]))
    assert found[3, 3].tolist() == [1, 2, 3]
    assert np.abs(found.astype(int) - many).mean() < 32
    assert len(np.unique(found.reshape(-1, 3), axis=0)) <= 256
