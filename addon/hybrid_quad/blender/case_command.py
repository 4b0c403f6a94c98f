"""``case --object NAME``: packs an object of the open file that goes wrong for a report, as ``hybrid-quad case`` packs a mesh file."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy
import numpy as np

from ..batch_jobs.settings import KINDS, Value, as_arguments
from ..cli.main import main as package_main
from ..cli.messages import say
from ..core.options import RemeshOptions
from ..core.part_files import write_polygons
from ..core.remesh import usual_length
from ..core.strokes import Stroke
from ..worker.request import RemeshRequest
from .remesh_task import prepare_task


def is_of_object(arguments: Sequence[str]) -> bool:
    """Whether the words name an object rather than a mesh file."""
    return any(word.partition("=")[0] == "--object" for word in arguments)


def main(arguments: Sequence[str], find_object: Callable[[str], bpy.types.Object]) -> int:
    """Writes an object's mesh, as a run would take it, and what its settings ask to files, packs these and returns the exit status.

    Parameters
    ----------
    arguments : sequence of str
        What follows the word ``case``.
    find_object : callable
        The mesh object of a name.
    """
    parser = argparse.ArgumentParser(
        prog="hybrid_quad case", description="Packs an object with its settings and what comes of a run for a report."
    )
    parser.add_argument("--object", required=True, metavar="NAME", help="mesh object")
    parser.add_argument("-o", "--output", required=True, metavar="CASE.zip", help="where to write the case")
    parser.add_argument("--anonymous", action="store_true", help="leave out names; the geometry stays")
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    try:
        asked = parser.parse_args(list(arguments))
    except SystemExit as stop:  # argparse has printed usage or help
        return int(stop.code or 0)
    obj = find_object(asked.object)
    request = prepare_task(obj, bpy.context.evaluated_depsgraph_get()).request()
    with tempfile.TemporaryDirectory() as place:
        words = as_arguments(write_files(request, Path(place)))
        flags = [flag for flag in ("--anonymous", "--quiet") if getattr(asked, flag[2:])]
        return package_main(["case", str(Path(place) / "object.off"), "-o", asked.output, *words, *flags])


def write_files(request: RemeshRequest, folder: Path) -> dict[str, Value]:
    """Writes ``object.off`` and the files of its settings to a folder, and returns the settings of ``hybrid-quad remesh``.

    Painted directions have no file there: they are left out, which is said.
    """
    write_polygons(folder / "object.off", request.vertices, request.polygons)
    settings = _settings(request.options)
    files = {"features": [f"{a} {b}" for a, b in request.sharp_edges.tolist()]}
    files["curve_counts"] = [" ".join(map(str, (count, *path))) for path, count in request.curve_counts]
    if request.density is not None:
        files["density"] = [f"{value:.17g}" for value in request.density.tolist()]
    if request.guides is not None and np.any(request.guides):
        say("painted directions are not in the case")
    files["guides"] = list(_lines_of_strokes(request.strokes))
    if directions := [stroke.strength for stroke in request.strokes if stroke.kind == "direction"]:
        settings["guide_strength"] = max(directions)
        length = usual_length(request.vertices, request.polygons, request.options)
        settings["guide_radius"] = request.stroke_radius * length
    if request.part is not None:
        files["part"] = [str(face) for face in np.flatnonzero(request.part.faces).tolist()]
        settings["odd_border"] = request.part.odd_border
        if request.part.is_free:
            settings.pop("quads", None)
    for name, lines in files.items():
        if lines:
            path = folder / ("guides.obj" if name == "guides" else f"{name}.txt")
            path.write_text("".join(f"{line}\n" for line in lines))
            settings[name] = str(path)
    return settings


def _settings(options: RemeshOptions) -> dict[str, Value]:
    """What differs from the defaults, under the names of ``hybrid-quad remesh``; one of the sizes in any case."""
    usual = RemeshOptions()
    settings: dict[str, Value] = {
        name: value
        for name, value in vars(options).items()
        if name in KINDS and value not in (None, getattr(usual, name))
    }
    if options.edge_length is None and options.chord_error is None:
        settings["quads"] = options.quads
    else:
        settings.pop("quads", None)
    if options.sharp_angle is None:
        settings["no_sharp"] = True
    if options.fit_limit_surface:
        settings["fit_limit"] = True
    return settings


def _lines_of_strokes(strokes: Sequence[Stroke]) -> Iterator[str]:
    """An .obj file in which names say what each line is for."""
    count = 0
    for stroke in strokes:
        yield f"o {stroke.kind}_"
        for point in stroke.points.tolist():
            yield "v " + " ".join(f"{value:.17g}" for value in point)
        yield "l " + " ".join(str(count + place) for place in range(1, len(stroke.points) + 1))
        count += len(stroke.points)
