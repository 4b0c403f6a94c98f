"""Pure-quad remeshing of surface meshes (Morse-parameterization hybridization, Fang et al. 2018).

``import hybrid_quad`` needs numpy and nothing of Blender; Blender loads the same folder as an add-on and calls
:func:`register`.
"""

from __future__ import annotations

from .core.errors import Cancelled, InputError, InternalError

TYPE_CHECKING = (
    False  # not typing's, which takes longer to load than all else before a command can answer an interruption
)
if TYPE_CHECKING:
    from typing import Any

    from .core.check import Defect, check
    from .core.mesh_objects import mesh_arrays
    from .core.options import RemeshOptions
    from .core.preview import Preview, preview
    from .core.remesh import RemeshResult, remesh
    from .core.remesh_part import PartRemesh, remesh_part
    from .core.repair import Repaired, repair
    from .core.stage_cache import StageCache
    from .core.strokes import Stroke, guides_from_strokes
    from .core.subdivision import Subdivided, subdivide, surface_distances

bl_info = {
    "name": "Hybrid Quad",
    "author": "Hybrid Quad contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > Hybrid Quad",
    "description": "Turns any surface mesh into pure quads that follow its features",
    "category": "Mesh",
}

__version__ = ".".join(str(part) for part in bl_info["version"])

__all__ = [
    "Cancelled",
    "Defect",
    "InputError",
    "InternalError",
    "PartRemesh",
    "Preview",
    "RemeshOptions",
    "RemeshResult",
    "Repaired",
    "StageCache",
    "Stroke",
    "Subdivided",
    "check",
    "guides_from_strokes",
    "mesh_arrays",
    "preview",
    "remesh",
    "remesh_part",
    "repair",
    "subdivide",
    "surface_distances",
]

# Names that need numpy or the compiled module are loaded on first use, so that Blender can register the add-on, and
# say what is missing, where one of them is not there.
_MODULE_OF = {
    "Defect": "check",
    "check": "check",
    "mesh_arrays": "mesh_objects",
    "Preview": "preview",
    "preview": "preview",
    "RemeshOptions": "options",
    "RemeshResult": "remesh",
    "remesh": "remesh",
    "PartRemesh": "remesh_part",
    "remesh_part": "remesh_part",
    "Repaired": "repair",
    "repair": "repair",
    "StageCache": "stage_cache",
    "Stroke": "strokes",
    "guides_from_strokes": "strokes",
    "Subdivided": "subdivision",
    "subdivide": "subdivision",
    "surface_distances": "subdivision",
}


if not TYPE_CHECKING:  # else every misspelt name would be taken for one that is there

    def __getattr__(name: str) -> Any:
        if name not in _MODULE_OF:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(f"{__name__}.core.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def register() -> None:
    """Called by Blender when the add-on is enabled."""
    from .blender import registration

    registration.register()


def unregister() -> None:
    """Called by Blender when the add-on is disabled."""
    from .blender import registration

    registration.unregister()
