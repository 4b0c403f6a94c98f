"""Pictures of many results, each beside the best peer's: wires, and irregular vertices as balls (orange: three quads, blue: more).

    blender -b --factory-startup --python-exit-code 1 -P docs/pictures/contact_sheet.py -- --ours FOLDER --peers FOLDER [NAME ...]

Meshes are those that scripts/sweep (`--ours`) and benchmarks/compare.py (`--peers`) leave in their folders. The best peer is the one
with the fewest irregular vertices among valid results or, where there is none, among all. Writes a picture for each model, and a
page that shows all of them. Models that the collection's index does not call CAD parts stand upright along y, as sculpts do.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from stage import Stage, irregular_vertices, save_side_by_side  # noqa: E402

from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402


@dataclass
class Shown:
    """A mesh of quads and whose it is."""

    program: str
    points: np.ndarray
    quads: np.ndarray
    valid: bool

    @property
    def caption(self) -> str:
        fewer, more = irregular_vertices(len(self.points), self.quads)
        flaw = "" if self.valid else ", invalid"
        return f"{self.program}: {len(self.quads)} quads, {len(fewer) + len(more)} irregular{flaw}"


def main() -> None:
    arguments = _parser().parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    images: Path = arguments.out / "images" / "contact-sheet"
    images.mkdir(parents=True, exist_ok=True)
    tail = f"_{arguments.quads}_sharp.obj"
    sculpts = _sculpts(arguments.models / "index.csv")
    rows = _rows(arguments.peers / "peers.jsonl")
    lines = [
        f"# Results at {arguments.quads} quads beside the best peer's",
        "",
        "Left this package's result, right that of the peer with the fewest irregular vertices (a valid one, where there is one).",
        "Orange: vertices where three quads meet, blue: five or more.",
        "",
    ]
    for path in sorted(arguments.ours.glob(f"*{tail}")):
        model = path.name[: -len(tail)]
        if arguments.names and not any(name in model for name in arguments.names):
            continue
        shown = [_shown("Hybrid Quad", path, True), *_best_peer(arguments.peers, rows, model, arguments.quads)]
        picture = images / f"{model}.png"
        if model in sculpts:
            for each in shown:
                each.points = each.points[:, [0, 2, 1]] * (1, -1, 1)
        _draw(shown, arguments.size, arguments.samples, picture)
        lines += [f"**{model}**. " + "; ".join(each.caption for each in shown), ""]
        lines += [f"![{model}]({picture.relative_to(arguments.out).as_posix()})", ""]
    (arguments.out / "contact-sheet.md").write_text("\n".join(lines))


def _sculpts(index: Path) -> set[str]:
    if not index.exists():
        return set()
    with index.open() as file:
        return {row["name"] for row in csv.DictReader(file) if "cad" not in row["tags"].split("|")}


def _rows(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def _best_peer(folder: Path, rows: list[dict], model: str, quads: int) -> list[Shown]:
    """The best peer's mesh, or nothing."""
    made = [
        row
        for row in rows
        if (row["model"], row["quads"]) == (model, quads)
        and row["judgement"].get("checks", {}).get("pure_quads")
        and (folder / f"{row['name']}.obj").exists()
    ]
    if not made:
        return []
    best = min(made, key=lambda row: (row["status"] != "valid", row["judgement"]["irregular"]))
    return [_shown(best["build"].removesuffix(" here"), folder / f"{best['name']}.obj", best["status"] == "valid")]


def _shown(program: str, path: Path, valid: bool) -> Shown:
    points, polygons = read_mesh(path)
    return Shown(program, points, polygons.vertices.reshape(-1, 4), valid)


def _draw(shown: list[Shown], size: int, samples: int, path: Path) -> None:
    stage = Stage(shown[0].points, size, samples)
    extent = float(np.linalg.norm(np.ptp(shown[0].points, axis=0)))
    panels, folder = [], Path(tempfile.mkdtemp())
    for each in shown:
        sides = np.sort(np.stack([each.quads, np.roll(each.quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        edges = np.unique(sides, axis=0)
        edge = float(np.linalg.norm(each.points[edges[:, 0]] - each.points[edges[:, 1]], axis=1).mean())
        stage.draw_quads(each.points, each.quads, edges, None, max(0.045 * edge, 0.0011 * extent))
        stage.add_irregular_vertices(each.points, each.quads, 0.3 * edge)
        panels.append(stage.render(folder / f"{len(panels)}.png"))
    save_side_by_side(panels, path)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="only models whose name contains one of these")
    parser.add_argument(
        "--ours", type=Path, default=ROOT / "out" / "sweep", help="folder of a sweep (default %(default)s)"
    )
    parser.add_argument("--peers", type=Path, default=ROOT / "out" / "compare", help="folder of a comparison")
    parser.add_argument(
        "--models", type=Path, default=ROOT.parent / "shared" / "meshes" / "dev", help="for its index.csv"
    )
    parser.add_argument("--quads", type=int, default=2000)
    parser.add_argument("--size", type=int, default=360, help="width of a panel in pixels")
    parser.add_argument("--samples", type=int, default=12)
    parser.add_argument(
        "--out", type=Path, default=ROOT / "out" / "contact_sheet", help="for contact-sheet.md and images"
    )
    return parser


main()
