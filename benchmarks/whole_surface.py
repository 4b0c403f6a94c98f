"""The judge's question whether quads point against a surface, answered by all of the surface instead of samples of it.

The judge looks at 200000 random points of a surface. Where sheets coincide, about half of those near a quad lie on the sheet that
faces the other way: of a thousand quads of which each has ten points, one finds none of its own side's. Quads smaller than the gaps
between points find none at all.
"""

from __future__ import annotations

import numpy as np

LEAST_AGAINST = -0.2  # cosine between a quad's normal and the nearest triangle's, as in the judge
REACH = 1 / 3  # of a quad's mean edge, beyond its distance


def count_inverted(
    centres: np.ndarray,
    normals: np.ndarray,
    sizes: np.ndarray,
    vertices: np.ndarray,
    triangles: np.ndarray,
    _rng: object = None,
) -> int:
    """Quads that point against the triangle nearest to them and against every one within reach.

    Parameters
    ----------
    centres, normals : (q, 3) float
        Of the quads; unit normals.
    sizes : (q,) float
        Mean edge lengths.
    vertices : (n, 3) float
    triangles : (t, 3) int
        The surface.
    """
    import igl  # the judge needs it too

    corners = vertices[triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(areas, axis=1)
    sides = areas / np.maximum(lengths, 1e-300)[:, None]
    low, high = corners.min(axis=1), corners.max(axis=1)

    def squared_distances(points: np.ndarray, of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = igl.point_mesh_squared_distance(
            np.ascontiguousarray(points), np.ascontiguousarray(vertices), np.ascontiguousarray(of).astype(np.int64)
        )
        return np.atleast_1d(found[0]), np.atleast_1d(found[1])

    squared, nearest = squared_distances(centres, triangles)
    distances = np.sqrt(np.maximum(squared, 0))
    inverted = 0
    for q in np.flatnonzero(np.einsum("ij,ij->i", normals, sides[nearest]) < LEAST_AGAINST):
        reach = distances[q] + sizes[q] * REACH
        is_near = ((low <= centres[q] + reach) & (high >= centres[q] - reach)).all(axis=1)
        agreeing = triangles[is_near & (lengths > 0) & (sides @ normals[q] > 0)]
        inverted += not (len(agreeing) and squared_distances(centres[q][None], agreeing)[0][0] <= reach**2)
    return int(inverted)
