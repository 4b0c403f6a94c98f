"""Finds the package, and gives tests their surfaces and models."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

if importlib.util.find_spec("hybrid_quad") is None:  # not installed: the module built into the source tree
    sys.path.insert(0, str(ROOT / "addon"))


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def models() -> Path:
    """Folder of the real models in the repository."""
    return ROOT / "tests" / "data" / "meshes"
