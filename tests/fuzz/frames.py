"""Frames that a run takes. Of vectors as they come, some are nearly parallel at one of many vertices: a refusal."""

from __future__ import annotations

import numpy as np

MOST_STRETCH = 9.0  # 10 is refused
SHARE_OF_ANY = 0.05  # of the cases, so that refusals are met too
SHARE_OF_FREE = 0.3  # of the vertices


def random_frames(vertices: np.ndarray, faces: list[list[int]], random: np.random.Generator) -> np.ndarray:
    """(n, 2, 3) vectors, zero where a vertex has no wish."""
    is_any = random.random() < SHARE_OF_ANY
    frames = random.normal(size=(len(vertices), 2, 3)) if is_any else _crosses(vertices, faces, random)
    frames[random.random(len(vertices)) < SHARE_OF_FREE] = 0
    return frames


def _crosses(vertices: np.ndarray, faces: list[list[int]], random: np.random.Generator) -> np.ndarray:
    """Along the surface: one direction in space for all, turned, stretched and slanted by up to a case's own amount."""
    count = len(vertices)
    noise = random.uniform(0, np.pi / 2)
    most_stretch = random.uniform(1, MOST_STRETCH)
    turn, slant = random.uniform(0, np.pi, (2, 1)) + noise * random.uniform(-1, 1, (2, count))
    stretch = most_stretch ** random.uniform(0, 1, count)
    lengths = 10.0 ** random.uniform(-0.5, 0.5, count) * np.sqrt([stretch, 1 / stretch])
    # A rotation on either side: the ratio of singular values, which is what is bounded, stays the stretch.
    inner, outer = _rotations(slant), _rotations(turn)
    return np.einsum("nij,jn,njk,nkd->nid", inner, lengths, outer, _tangents(vertices, faces, random.normal(size=3)))


def _rotations(angles: np.ndarray) -> np.ndarray:
    """(n, 2, 2), one for each angle."""
    return np.moveaxis(np.array([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]]), 2, 0)


def _tangents(vertices: np.ndarray, faces: list[list[int]], direction: np.ndarray) -> np.ndarray:
    """(n, 2, 3) unit vectors: the direction in the surface, and the one across it."""
    normals = np.zeros((len(vertices), 3))
    for face in faces:
        spokes = vertices[face[1:]] - vertices[face[0]]
        normals[face] += np.cross(spokes[:-1], spokes[1:]).sum(axis=0)
    normals[~normals.any(axis=1)] = (0, 0, 1)  # no area around: any will do
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    along = direction - (normals @ direction)[:, None] * normals
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([along, np.cross(normals, along)], axis=1)
