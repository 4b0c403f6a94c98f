"""Every block of code in README.md and docs/*.md does what it should: it is run or, for commands of other programs, held against
what they name.

Blocks for inside Blender are run by tests/addon/test_docs.py. A block below a comment ``<!-- not run: REASON -->`` is only checked.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import hybrid_quad
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import _parser, main
from support.doc_blocks import Block, blocks_of, pages_of
from support.doc_world import fill_folder, names_of

ROOT = Path(__file__).resolve().parents[2]
PAGES = pages_of(ROOT)
LANGUAGES = {"python", "sh", "csv", ""}  # without one: diagrams and usage

NOT_RUN = {
    ("README.md", "needs Blender 4.2 and the add-on installed"),
    ("docs/part-of-a-mesh.md", "Python sees face sets from Blender 3.5 on"),
}

# Of `hybrid-quad case`, and those that stand for a family of flags.
SPOKEN_OF = {"--transfer", "--no-transfer"}

HAS_MODULE = any((ROOT / "addon" / "hybrid_quad").glob("_native*"))
BLENDER = shutil.which("blender") if HAS_MODULE else None


def test_few_blocks_are_not_run():
    found = {(page, block.not_run) for page in PAGES for block in blocks_of(ROOT, page) if block.not_run}
    assert found == NOT_RUN


def test_the_languages_are_those_that_are_tested():
    assert {block.language for page in PAGES for block in blocks_of(ROOT, page)} <= LANGUAGES


def test_every_page_has_a_place_in_the_site():
    settings = (ROOT / "mkdocs.yml").read_text()
    missing = [
        page for page in PAGES[1:] if not re.search(rf"[ :]{re.escape(Path(page).name)}$", settings, re.MULTILINE)
    ]
    assert not missing


def test_every_public_name_has_its_docstring_in_the_reference():
    shown = re.findall(r"^::: hybrid_quad\.(\w+)$", (ROOT / "docs" / "python.md").read_text(), re.MULTILINE)
    assert sorted(shown) == sorted(hybrid_quad.__all__)
    assert all(getattr(hybrid_quad, name).__doc__ for name in shown)


def test_links_lead_to_files():
    """Also those that the site does not have: of README.md and CONTRIBUTING.md."""
    pages = [ROOT / page for page in (*PAGES, "CONTRIBUTING.md", "CHANGELOG.md")]
    broken = [
        f"{page.name}: {link}"
        for page in (*pages, *(ROOT / "docs" / "decisions").glob("*.md"))
        for link in re.findall(r"\]\(([^)#\s]+)", page.read_text())
        if "://" not in link and not (page.parent / link).exists()
    ]
    assert not broken


def test_flags_and_files_in_the_text_are_there():
    """What stands in backticks in sentences and tables, beside the blocks."""
    folders = ("addon", "scripts", "benchmarks", "tests/fuzz", "docs/pictures")
    programs = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    programs += [path for path in (ROOT / "scripts").iterdir() if path.is_file()]
    sources = "".join(path.read_text() for path in programs)
    missing = set()
    for page in PAGES:
        text = re.sub(r"^```.*?^```", "", (ROOT / page).read_text(), flags=re.DOTALL | re.MULTILINE)
        for word in " ".join(re.findall(r"`([^`\n]+)`", text)).split():
            flag = re.match(r"--[a-z][a-z-]+[a-z]", word)
            if flag and flag[0] not in sources:
                missing.add(flag[0])
            place = re.fullmatch(r"(?:scripts|addon|docs|tests|benchmarks|farm|tools|blend_samples)/[\w./-]+", word)
            if place and not (ROOT / word).exists():
                missing.add(word)
    assert missing <= SPOKEN_OF


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    folder = tmp_path_factory.mktemp("docs")
    fill_folder(folder, ROOT, BLENDER)
    return folder


@pytest.mark.parametrize("page", [page for page in PAGES if blocks_of(ROOT, page)])
def test_a_page(page, world, tmp_path, monkeypatch):
    for entry in world.iterdir():
        (tmp_path / entry.name).symlink_to(entry)
    monkeypatch.chdir(tmp_path)
    blocks, names = blocks_of(ROOT, page), names_of(page, ROOT)
    is_for_blender = any(block.knows_blender for block in blocks)  # its blocks go on from each other there
    for block in blocks:
        if block.language == "python":
            code = compile(block.text, block.place, "exec")
            if not (is_for_blender or block.not_run):
                exec(code, names)
        elif block.language == "csv":
            rows = [row for row in block.text.splitlines() if BLENDER or ".blend" not in row]
            Path("jobs.csv").write_text("\n".join(rows) + "\n")
        elif block.language == "sh":
            for words in block.commands():
                do(words, block, tmp_path)


def do(words: list[str], block: Block, folder: Path) -> None:
    """Runs a command of ours, and checks one of others."""
    words = [re.sub(r"^((?:\w+=)?)/shared/", rf"\1{folder}/shared/", word) for word in words]
    check_versions(words, block)
    if words[0] == "hybrid-quad":
        run_ours(words[1:], block)
    elif words[0] == "blender":
        check_blender(words, block)
        if BLENDER and "addon/hybrid_quad/batch.py" in words and not block.not_run:
            here = {**os.environ, "PWD": str(folder)}  # Blender's own idea of where it is
            done = subprocess.run([BLENDER, *words[1:]], capture_output=True, text=True, timeout=200, env=here)
            assert done.returncode == 0, f"{block.place}: {done.stdout[-2000:]} {done.stderr[-2000:]}"
    else:
        check_other(words, block)


def run_ours(words: list[str], block: Block) -> None:
    if "--version" not in words:
        _parser().parse_args(words)
    if block.not_run:
        return
    assert main(words) == exit_codes.OK, block.place
    if words[0] == "batch" and "--write-list" not in words:
        lines = json.loads((Path(words[words.index("--output") + 1]) / "summary.json").read_text())["lines"]
        assert lines and {line["status"] for line in lines} == {"ok"}, f"{block.place}: {lines}"


def check_blender(words: list[str], block: Block) -> None:
    """The script is there, and knows its flags."""
    if "-P" not in words:
        assert "hybrid_quad" in words or "extension" in words, block.place
        return
    script = ROOT / words[words.index("-P") + 1]
    assert script.is_file(), block.place
    sources = [script]
    if script.name == "batch.py":
        sources = [
            ROOT / "addon" / "hybrid_quad" / "blender" / name
            for name in ("command_arguments.py", "case_command.py", "part_arguments.py")
        ]
    text = "".join(source.read_text() for source in sources)
    for flag in flags(words[words.index("--") + 1 :] if "--" in words else []):
        assert f'"{flag}"' in text, f"{block.place}: {flag}"


def check_other(words: list[str], block: Block) -> None:
    """Scripts, installers and the like name files, flags and parts that are there."""
    program, text = words[0], ""
    if program.startswith("scripts/"):
        assert (ROOT / program).stat().st_mode & 0o111, block.place
        text = (ROOT / program).read_text()
        paths = words[1:]
    elif program == ".venv/bin/python":
        paths, text = words[1:2], (ROOT / words[1]).read_text()
    elif program == "openjd":
        paths, text = words[2:3], (ROOT / words[2]).read_text()
        asked = [words[i + 1].split("=")[0] for i, word in enumerate(words) if word in ("-p", "--step")]
        missing = [name for name in asked if not re.search(rf"\bname: {name}\b", text)]
        assert not missing, f"{block.place}: {missing}"
        text = " ".join(flags(words))  # its own flags: tests/pipeline/test_farms.py
    elif program == "pip":
        wanted = re.findall(r"hybrid-quad\[(\w+)\]", " ".join(words))
        missing = [extra for extra in wanted if f"\n{extra} = [" not in (ROOT / "pyproject.toml").read_text()]
        assert not missing, f"{block.place}: {missing}"
        return
    elif program in ("mkdir", "ln"):
        paths = [word.removeprefix("$PWD/") for word in words if word.startswith("$PWD/")]
    else:
        raise AssertionError(f"{block.place}: nothing checks {program}")
    missing = [path for path in paths if "/" in path and not (ROOT / path).exists()]
    assert not missing, f"{block.place}: {missing}"
    unknown = [flag for flag in flags(words) if flag not in text and flag != "-p"]
    assert not unknown or program == "mkdir", f"{block.place}: {unknown}"


def check_versions(words: list[str], block: Block) -> None:
    for version in re.findall(r"hybrid_quad-(\d[\d.]*)-", " ".join(words)):
        assert version == hybrid_quad.__version__, block.place


def flags(words: list[str]) -> list[str]:
    return [word.split("=")[0] for word in words if word.startswith("--") and len(word) > 2]
