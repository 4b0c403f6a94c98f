"""Is a quad mesh exactly its own mirror image?"""

from __future__ import annotations

from collections import Counter

import numpy as np


def assert_mirrored(vertices: np.ndarray, quads: np.ndarray, axis: int) -> None:
    """Vertices and oriented quads map one to one to their images, with coordinates equal bit for bit up to the sign."""
    image = vertices.copy()
    image[:, axis] *= -1
    # One zero only: -0.0 and 0.0 are the same coordinate.
    ours, images = vertices + 0.0, image + 0.0
    assert Counter(map(tuple, ours.tolist())) == Counter(map(tuple, images.tolist()))
    faces = Counter(map(_from_least, ours[quads].tolist()))
    assert faces == Counter(map(_from_least, images[quads[:, ::-1]].tolist()))


def assert_seam(vertices: np.ndarray, quads: np.ndarray, axis: int) -> int:
    """No quad reaches through the plane; the edges on it are closed chains, or end at the border. Returns their number."""
    along = vertices[quads][:, :, axis]
    assert not ((along.min(axis=1) < 0) & (along.max(axis=1) > 0)).any()
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    on_plane = vertices[:, axis] == 0
    seam = edges[on_plane[edges].all(axis=1)]
    degree = np.bincount(seam.ravel(), minlength=len(vertices))
    on_border = np.zeros(len(vertices), bool)
    on_border[edges[uses == 1]] = True
    assert (degree[on_plane & ~on_border] == 2).all()
    assert (degree[on_plane & on_border] == 1).all()
    return len(seam)


def _from_least(corners: list[list[float]]) -> tuple[tuple[float, ...], ...]:
    # Of all ways round: two corners may lie in one place.
    return min(tuple(map(tuple, corners[first:] + corners[:first])) for first in range(len(corners)))
