"""Finds the compiled module, and explains what to do where it is missing."""

from __future__ import annotations

from importlib import import_module, util
from types import ModuleType

_PACKAGE = __package__.rpartition(".")[0]


def is_there() -> bool:
    """Whether the module is installed for this Python; it may still fail to load."""
    return util.find_spec(f"{_PACKAGE}._native") is not None


def load() -> ModuleType:
    """The module ``_native`` of this package.

    Raises
    ------
    ImportError
        If it is missing or was built for another Python, with what to do about it.
    """
    try:
        return import_module(f"{_PACKAGE}._native")
    except ImportError as error:
        raise ImportError(
            "the compiled part of hybrid_quad (_native) cannot be loaded by this Python: "
            f"{error}. Install the package with 'pip install .', or install a release of the add-on for this "
            "Blender (a source download has no compiled part)."
        ) from error
