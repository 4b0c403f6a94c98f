"""Runs the commands of docs/gallery.md, puts their pictures in docs/images/gallery, and prints their figures.

.venv/bin/python docs/pictures/gallery.py
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main() -> None:
    """Prints a row of the page's tables for every command."""
    images = ROOT / "docs" / "images" / "gallery"
    images.mkdir(parents=True, exist_ok=True)
    page = (ROOT / "docs" / "gallery.md").read_text().replace("\\\n", " ")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "tests").symlink_to(ROOT / "tests")
        for line in page.splitlines():
            if not line.startswith("hybrid-quad "):
                continue
            words = shlex.split(line)[1:]
            before = os.times()
            subprocess.run([sys.executable, "-m", "hybrid_quad", *words, "--quiet"], cwd=folder, check=True)
            report = json.loads((Path(folder) / words[words.index("--report") + 1]).read_text())
            after = os.times()
            seconds = after.children_user + after.children_system - before.children_user - before.children_system
            print(row(Path(words[2]).stem, report, seconds))
            shutil.copy(Path(folder) / words[words.index("--picture") + 1], images)


def row(name: str, report: dict, seconds: float) -> str:
    """A row of the page's table; `seconds` are the processor's, of the whole command."""
    shape = report["scaled_jacobian"]
    cells = (
        name,
        report["options"]["quads"],
        report["quads"],
        f"{report['irregular_vertices']} / {report['field_singularities']}",
        f"{shape['mean']:.3f} / {shape['min']:.2f}".replace("0.", "."),
        f"{report['hausdorff_percent']:.2f}",
        f"{seconds:.1f}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


main()
