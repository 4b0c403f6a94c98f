"""What runs came to, kept in files for the same build of the library, or one that gives the same, to go on with."""

from __future__ import annotations

import hashlib
import json
import lzma
import os
from pathlib import Path
from typing import Any

from hybrid_quad.core import native
from runs import Outcome


def build_id(package: Path | None = None) -> str:
    """Names the compiled library, of this Python or of the package in a folder."""
    library = Path(str(native.load().__file__))
    if package is not None:
        library = package / "hybrid_quad" / library.name
    return hashlib.sha256(library.read_bytes()).hexdigest()[:12]


def read_results(path: Path, *builds: str) -> dict[str, Outcome]:
    """What is done, by the names of runs, as far as these builds did it; whatever did it where none is named. The file may be
    compressed (``.xz``)."""
    done: dict[str, Outcome] = {}
    if not path.exists():
        return done
    data = path.read_bytes()
    for line in (lzma.decompress(data) if path.suffix == ".xz" else data).splitlines():
        try:
            row = json.loads(line)
        except ValueError:  # the last line of a sweep that was killed while it wrote
            continue
        name = row.pop("name")
        # Older results do not say it; those written in short have lost their judgements, but were judged.
        row.setdefault("judged", bool(row.get("judgement")) or path.suffix == ".xz")
        if not builds or row["build"] in builds:
            done[name] = Outcome(**row)
    return done


def append_row(path: Path, row: dict[str, Any]) -> None:
    """Adds a line to results; what a killed sweep left of its last one stays on a line of its own."""
    with path.open("ab+") as file:
        is_cut = False
        if file.tell():
            file.seek(-1, os.SEEK_END)
            is_cut = file.read(1) != b"\n"
        file.write(("\n" * is_cut + json.dumps(row) + "\n").encode())


def pack_results(done: dict[str, Outcome], path: Path) -> None:
    """Writes what is done; of reports what a summary needs, of judgements what failed, no messages: they say where files lay."""
    kept = ("status", "quads", "field_singularities", "irregular_vertices", "flawed_quads", "code", "warnings")
    with lzma.open(path, "wt") as file:
        for name, outcome in sorted(done.items()):
            row = {"name": name, **outcome.as_json()}
            row["report"] = {key: value for key, value in outcome.report.items() if key in kept}
            row["judgement"], row["message"] = {}, ""
            file.write(json.dumps(row) + "\n")
