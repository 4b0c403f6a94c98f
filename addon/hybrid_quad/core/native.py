"""Finds the compiled module, and explains what to do where it is missing."""

from __future__ import annotations

import sys
from importlib import import_module, util
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType

_PACKAGE = __package__.rpartition(".")[0]
_NAME = f"{_PACKAGE}._native"
# Blender's extensions may bring compiled code only as wheels, one for each Python; Blender unpacks the one that fits.
_WHEEL = "hybrid_quad_native"


def is_there() -> bool:
    """Whether the module is installed for this Python; it may still fail to load."""
    return util.find_spec(_NAME) is not None or _spec_in_wheel() is not None


def folder_of_wheel() -> str:
    """The folder in which the package ``hybrid_quad_native`` lies, for other processes to find it; ``""`` where there is none."""
    wheel = util.find_spec(_WHEEL)
    places = wheel.submodule_search_locations if wheel is not None else None
    return str(Path(next(iter(places))).parent) if places else ""


def load() -> ModuleType:
    """The module ``_native`` of this package: of its own folder, or else of the package ``hybrid_quad_native``.

    Raises
    ------
    ImportError
        If it is missing, was built for another Python or needs a newer system, with what to do about it.
    """
    try:
        spec = None if util.find_spec(_NAME) is not None else _spec_in_wheel()
        return import_module(_NAME) if spec is None else _load_as_own(spec)
    except ImportError as error:
        raise ImportError(
            "the compiled part of hybrid_quad (_native) cannot be loaded by this Python "
            f"({sys.implementation.cache_tag}, {sys.platform}): {error}. "
            "In Blender, install the zip for this version of Blender and this system "
            "(a download of the sources has no compiled part); outside of Blender, run 'pip install .' in the sources, "
            "or install the wheel for this Python."
        ) from error


def _spec_in_wheel() -> ModuleSpec | None:
    """Where the wheel's module is, under the name that it has in this package, whatever Blender calls that."""
    wheel = util.find_spec(_WHEEL)
    return None if wheel is None else PathFinder.find_spec(_NAME, wheel.submodule_search_locations)


def _load_as_own(spec: ModuleSpec) -> ModuleType:
    """The module as one of this package: it raises the errors of the package that its name says it is in."""
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules[spec.name] = module
    return module
