#!/usr/bin/env python3
"""Asked and got: edge lengths where a density is painted, distances for a chord error, numbers of quads; as Markdown.

The painted region is the nearest 30 % of the surface, along its edges, to the vertex farthest along the longest axis.
Edges count that are two asked edges or more away from the transition.
"""

from __future__ import annotations

import argparse
import heapq
import sys
from pathlib import Path

import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_arrays import FloatArray, IntArray
from hybrid_quad.core.mesh_io import read_mesh
from runs import COLLECTION, ROOT, Limits, Outcome, Run, models_of, run_and_judge

SMOOTH = (
    "c3d_rocker_arm",
    "dir_fertility_input",
    "c3d_stanford_bunny",
    "c3d_spot_triangulated",
    "dir_elephant",
    "dir_botijo",
    "c3d_cheburashka",
)
COUNTS = (100, 300, 500, 2000)
GROWTH = 0.5  # of lengths over a unit of distance, as between two densities
FEW, FEW_TOLERANCE, TOLERANCE = 500, 0.10, 0.05


class Surface:
    """A model's triangles, and distances along their edges."""

    def __init__(self, path: Path) -> None:
        self.vertices, polygons = read_mesh(path)
        starts = np.cumsum(np.r_[0, polygons.sizes[:-1]])
        fans = [
            (polygons.vertices[s], polygons.vertices[s + i], polygons.vertices[s + i + 1])
            for s, n in zip(starts, polygons.sizes, strict=False)
            for i in range(1, n - 1)
        ]
        self.triangles: IntArray = np.array(fans)
        corners = self.vertices[self.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.area: FloatArray = 0.5 * np.linalg.norm(normals, axis=1)
        self.diagonal = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0)))
        sides = np.sort(np.concatenate([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        self.edges: IntArray = np.unique(sides, axis=0)
        self.edge_length = np.linalg.norm(np.subtract(*self.vertices[self.edges.T]), axis=1)
        self._around: list[list[tuple[int, float]]] = [[] for _ in self.vertices]
        for (a, b), length in zip(self.edges.tolist(), self.edge_length.tolist(), strict=False):
            self._around[a].append((b, length))
            self._around[b].append((a, length))

    def spread(self, value: FloatArray, growth: float) -> FloatArray:
        """The largest values below `value` that grow by at most `growth` over a unit of distance."""
        value = value.copy()
        queue = [(x, v) for v, x in enumerate(value.tolist()) if np.isfinite(x)]
        heapq.heapify(queue)
        while queue:
            at, v = heapq.heappop(queue)
            if at > value[v]:
                continue
            for w, length in self._around[v]:
                reached = at + growth * length
                if reached < value[w]:
                    value[w] = reached
                    heapq.heappush(queue, (reached, w))
        return value

    def distance_from(self, vertices: IntArray) -> FloatArray:
        """Along edges, to the nearest of some vertices."""
        start = np.full(len(self.vertices), np.inf)
        start[vertices] = 0
        return self.spread(start, 1.0)

    def painted(self, share: float = 0.3) -> np.ndarray:
        """Whether a vertex is in the painted region."""
        used = np.unique(self.triangles)
        axis = int(np.argmax(np.ptp(self.vertices[used], axis=0)))
        far = self.distance_from(used[[np.argmax(self.vertices[used, axis])]])
        of_faces = far[self.triangles].mean(axis=1)
        order = np.argsort(of_faces)
        last = np.searchsorted(np.cumsum(self.area[order]), share * self.area.sum())
        return np.asarray(far <= of_faces[order[last]])

    def samples(self, count: int = 300_000) -> tuple[FloatArray, IntArray]:
        """Points all over the surface and the triangle of each."""
        each = np.maximum(1, np.round(count * self.area / self.area.sum()).astype(int))
        faces = np.repeat(np.arange(len(self.triangles)), each)
        random = np.random.default_rng(0).random((len(faces), 2))
        root = np.sqrt(random[:, :1])
        weights = np.hstack([1 - root, root * (1 - random[:, 1:]), root * random[:, 1:]])
        return np.einsum("ij,ijk->ik", weights, self.vertices[self.triangles[faces]]), faces

    def distance_to(self, points: FloatArray) -> FloatArray:
        """Of points near the surface, exact to the triangles around the nearest samples."""
        from scipy.spatial import cKDTree

        places, faces = self.samples()
        _, nearest = cKDTree(places).query(points, k=8)
        best = np.full(len(points), np.inf)
        for column in nearest.T:
            best = np.minimum(best, _to_triangles(points, self.vertices[self.triangles[faces[column]]]))
        return best


def _to_triangles(points: FloatArray, corners: FloatArray) -> FloatArray:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-300
    height = ((points - corners[:, 0]) * normal).sum(axis=1)
    foot = points - height[:, None] * normal
    inside = np.ones(len(points), bool)
    best = np.full(len(points), np.inf)
    for i in range(3):
        start, along = corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
        inside &= (np.cross(along, foot - start) * normal).sum(axis=1) >= 0
        share = ((points - start) * along).sum(axis=1) / ((along * along).sum(axis=1) + 1e-300)
        on_side = start + np.clip(share, 0, 1)[:, None] * along
        best = np.minimum(best, np.linalg.norm(points - on_side, axis=1))
    return np.where(inside, np.abs(height), best)


def _edges_of(quads: IntArray) -> IntArray:
    return np.unique(np.sort(np.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1), axis=0)


def density_row(path: Path, factor: float, quads: int) -> str:
    """Edge lengths over the asked ones, inside the painted region and outside: means around vertices, and single edges."""
    from scipy.spatial import cKDTree

    surface = Surface(path)
    inside = surface.painted()
    density = np.where(inside, factor, 1.0)
    length, graded = np.sqrt(surface.area.sum() / quads), density
    for _ in range(4):
        graded = length / surface.spread(length / density, GROWTH)
        length = np.sqrt((surface.area * (graded[surface.triangles] ** 2).mean(axis=1)).sum() / quads)
    result = hybrid_quad.remesh(surface.vertices, surface.triangles, quads=quads, sharp_angle=None, density=density)
    mixed = surface.edges[density[surface.edges[:, 0]] != density[surface.edges[:, 1]]]
    changing = np.union1d(np.nonzero(np.abs(graded / density - 1) > 0.02)[0], mixed)
    away = surface.distance_from(changing) > 2 * length / density
    edges = _edges_of(result.quads)
    ends = result.vertices[edges]
    places, faces = surface.samples()
    tree = cKDTree(places)

    def vertex_below(points: FloatArray) -> IntArray:
        return np.asarray(surface.triangles[faces[tree.query(points)[1]], 0])

    of_edge, of_vertex = vertex_below(ends.mean(axis=1)), vertex_below(result.vertices)
    ratio = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) * density[of_edge] / length
    around = np.bincount(edges.ravel(), np.repeat(ratio, 2)) / np.bincount(edges.ravel())
    cells = []
    for region in (inside, ~inside):
        single, local = ratio[(away & region)[of_edge]], around[(away & region)[of_vertex]]
        within = [f"{100 * np.mean(np.abs(own - 1) <= 0.15):.0f}" for own in (local, single) if len(own)]
        cells += [f"{np.median(single):.3f}", *within] if len(within) == 2 else ["-"] * 3
    count = f"{len(result.quads)} ({quads})"
    return f"| {path.stem} | {factor:g} | {count} | {result.report['irregular_vertices']} | " + " | ".join(cells) + " |"


def chord_row(path: Path, relative: float) -> str:
    """Distances of the quads' middles and edges' middles over the asked chord error."""
    surface = Surface(path)
    error = relative * surface.diagonal
    result = hybrid_quad.remesh(surface.vertices, surface.triangles, sharp_angle=None, chord_error=error)
    middles = result.vertices[result.quads].mean(axis=1)
    of_edges = result.vertices[_edges_of(result.quads)].mean(axis=1)
    cells = [f"{100 * relative:g}", str(len(result.quads))]
    for points in (middles, of_edges):
        got = surface.distance_to(points) / error
        cells += [f"{np.median(got):.2f}", f"{np.percentile(got, 95):.2f}", f"{got.max():.2f}"]
    return f"| {path.stem} | " + " | ".join(cells) + " |"


def _count_cell(outcome: Outcome) -> str:
    if outcome.status not in ("valid", "invalid"):
        return outcome.status
    report = outcome.report
    marks = ("!" if outcome.failed or report["flawed_quads"] else "") + ("-" if report["features_given_way"] else "")
    return f"{report['quads']}{marks}"


def count_rows(paths: list[Path], counts: list[int], out: Path, seconds: float) -> list[str]:
    """One row for each model, and the share of valid results within the tolerance for each count and setting.

    A minus says that features by angle gave way, an exclamation mark that the mesh is invalid or has flawed quads. Numbers
    that no mesh of quads can have (the report's fewest_quads is beyond the tolerance) are in brackets, and left out of the
    share.
    """
    columns = [(count, setting) for count in counts for setting in ("sharp", "no_sharp")]
    good, longest = dict.fromkeys(columns, 0), dict.fromkeys(columns, 0.0)
    possible = dict.fromkeys(columns, len(paths))
    rows = []
    for path in paths:
        cells = []
        for count, setting in columns:
            run = Run(path.stem, path, count, setting)
            outcome = run_and_judge(run, out, Limits(seconds=seconds), judge=None, keep_meshes=False)
            tolerance = FEW_TOLERANCE if count < FEW else TOLERANCE
            is_impossible = outcome.report.get("fewest_quads", 0) > (1 + tolerance) * count
            possible[count, setting] -= is_impossible
            cells.append(f"({_count_cell(outcome)})" if is_impossible else _count_cell(outcome))
            longest[count, setting] = max(longest[count, setting], outcome.cpu_seconds)
            is_sound = outcome.status == "valid" and not outcome.report["flawed_quads"]
            good[count, setting] += is_sound and abs(outcome.report["quads"] - count) <= tolerance * count
        rows.append(f"| {path.stem} | " + " | ".join(cells) + " |")
        print(rows[-1], file=sys.stderr, flush=True)
    shares = [f"{good[column]} of {possible[column]}" for column in columns]
    times = [f"{longest[column]:.0f} s" for column in columns]
    names = [f"{count} {'40°' if setting == 'sharp' else 'none'}" for count, setting in columns]
    return [
        f"| model | {' | '.join(names)} |",
        "|---|" + "--:|" * len(columns),
        *rows,
        f"| **within tolerance** | {' | '.join(shares)} |",
        f"| **longest, CPU** | {' | '.join(times)} |",
    ]


def main() -> int:
    """Prints the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=COLLECTION, help="folder of the models (default %(default)s)")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "sizes")
    parser.add_argument(
        "--tables", nargs="+", choices=("density", "chord", "counts"), default=("density", "chord", "counts")
    )
    parser.add_argument(
        "--quads", type=int, default=3000, help="asked where a density is painted (default %(default)s)"
    )
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS)
    parser.add_argument("--only", nargs="+", help="names of models instead of all, and instead of the smooth ones")
    parser.add_argument("--seconds", type=float, default=150.0, help="limit of a run for the table of counts")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    smooth = [arguments.models / f"{name}.obj" for name in arguments.only or SMOOTH]
    lines = []
    if "density" in arguments.tables:
        lines += [
            "| model | density | quads (asked) | irregular "
            "| inside: median | around a vertex within 15 %, % | single edges | outside: median | around a vertex | single edges |",
            "|---|" + "--:|" * 9,
            *(density_row(path, factor, arguments.quads) for factor in (0.5, 2.0) for path in smooth),
            "",
        ]
    if "chord" in arguments.tables:
        lines += [
            "| model | asked, % of diagonal | quads | quads: median | 95 % | largest | edges: median | 95 % | largest |",
            "|---|" + "--:|" * 8,
            *(chord_row(path, relative) for relative in (0.004, 0.001) for path in smooth),
            "",
        ]
    if "counts" in arguments.tables:
        paths = smooth if arguments.only else [path for path, is_clean in models_of(arguments.models) if is_clean]
        lines += count_rows(paths, list(arguments.counts), arguments.out, arguments.seconds)
    text = "\n".join(lines) + "\n"
    (arguments.out / "sizes.md").write_text(text)
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
