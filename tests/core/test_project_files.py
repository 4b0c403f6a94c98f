"""What several files say of the project is one thing."""

import re

import pytest

import hybrid_quad

tomllib = pytest.importorskip("tomllib")


def test_one_licence_and_one_version(root):
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    manifest = tomllib.loads((root / "addon" / "hybrid_quad" / "blender_manifest.toml").read_text())
    citation = dict(re.findall(r"^(\w+): (\S+)$", (root / "CITATION.cff").read_text(), re.MULTILINE))
    licence = (root / "LICENSE").read_text()
    assert "GNU GENERAL PUBLIC LICENSE" in licence and "Version 3" in licence
    assert project["license"]["text"] == citation["license"] == "GPL-3.0-or-later"
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    assert project["version"] == manifest["version"] == citation["version"] == hybrid_quad.__version__


def test_the_commands_for_contributors_are_there(root):
    text = (root / "CONTRIBUTING.md").read_text()
    for name in re.findall(r"`(scripts/\w+)`", text):
        assert (root / name).stat().st_mode & 0o111, name
    # What a test needs the setup installs.
    setup = (root / "scripts" / "lib" / "setup.sh").read_text()
    for need in tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]["test"]:
        assert f'"{need}"' in setup
