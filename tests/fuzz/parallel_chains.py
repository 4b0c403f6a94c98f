"""Two chains of edges side by side, far closer to each other than any quad is long."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

Faces = list[list[int]]


def with_parallel_chains(
    vertices: np.ndarray, faces: Faces, random: np.random.Generator
) -> tuple[np.ndarray, Faces, list[list[int]]]:
    """Cuts the faces on one side of a chain of edges, a millionth to a hundredth of an edge away from it.

    The cut goes from face to face, and where it passes beside an edge, that edge is one of the chain. Vertices that it
    makes are also put into faces which only touch it, so that no gap opens.

    Returns
    -------
    (n, 3) float, faces, edges
        The last are those of the chain and of the cut: two features.
    """
    distance = 10.0 ** random.uniform(-6, -2)
    turn = random.integers(3)  # faces between two edges of the chain: 0 is straight on across quads, 1 across triangles
    face_at = {
        (face[i - 1], face[i]): n
        for n, face in enumerate(faces)
        if len(face) > 2 and len(set(face)) == len(face)
        for i in range(len(face))
    }
    if not face_at:
        return vertices, faces, []
    points, cut_faces, edges = list(vertices), list(faces), []
    cuts: dict[tuple[int, int], int] = {}  # vertices on edges, by the edges' ends in either order

    def cut(far: int, near: int) -> int:
        if (far, near) not in cuts:
            points.append(points[near] + distance * (points[far] - points[near]))
            cuts[far, near] = cuts[near, far] = len(points) - 1
        return cuts[far, near]

    far, near = list(face_at)[random.integers(len(face_at))]
    visited = set()
    for step in range(random.integers(4, 60)):
        n = face_at.get((far, near))
        if n is None or n in visited:
            break
        visited.add(n)
        place = faces[n].index(near)
        ring = faces[n][place:] + faces[n][:place]
        on_chain = 1 if step % (turn + 1) else 2  # vertices of the face: its corner is cut off, or one of its sides
        first = cut(far, near)
        far, near = ring[on_chain], ring[on_chain - 1]
        last = cut(far, near)
        cut_faces[n] = [last, *ring[on_chain:], first]
        cut_faces.append([first, *ring[:on_chain], last])
        edges += [[first, last], ring[:2]][:on_chain]

    def with_cuts(path: list[int]) -> list[int]:
        made = path[:1]
        for a, b in pairwise(path):
            made += [cuts[a, b], b] if (a, b) in cuts else [b]
        return made

    features = [list(pair) for edge in edges for pair in pairwise(with_cuts(edge))]  # a cut may cross the chain's edges
    return np.array(points), [with_cuts(face + face[:1])[:-1] for face in cut_faces], features
