"""What a caller can ask of a run."""

from __future__ import annotations

import math
import operator
import os
from dataclasses import dataclass
from typing import Any

SOLVERS = ("multilevel", "eigen")
AXES = "xyz"
SYMMETRY_CENTERS = ("origin", "bounds")

STROKE_KINDS = ("direction", "loop", "ring")
ODD_BORDERS = ("refuse", "grow", "shrink")  # what is done where the border of a part has an odd number of edges

# More would take more memory than a machine has, and is most often a length in the wrong unit.
MOST_QUADS = 5_000_000

MOST_ANISOTROPY = 10


@dataclass(frozen=True)
class RemeshOptions:
    """Settings of a run, checked when they are made.

    Attributes
    ----------
    quads : int
        Number of quads to aim at; ignored where `edge_length` is given.
    edge_length : float or None
        Length of the quads' edges, in the units of the vertices.
    sharp_angle : float or None
        Edges whose faces' normals differ by more than this many degrees (0..180) become chains of output edges.
        ``None``: only the boundary and marked edges do.
    field_smoothness : float
        0: edges follow the surface's bends wherever they are clear at the size of the quads; 1: as few irregular vertices
        as can be, whatever the bends.
    adaptivity : float
        0: edges of even length; 1: as short as the curvature asks for, so that all quads are about equally far from the
        surface. Within a third and twice the usual length.
    chord_error : float or None
        Largest distance between quads and the surface that is aimed at, in the units of the vertices. The curvature then
        says how long edges are, not `quads`; `edge_length` is the longest, an eighth of the bounding box's diagonal
        where it is not given, and 64 times the shortest. In place of `adaptivity`.
    narrow_quads : int, 1 or 2
        Rows of quads that strips between two features get at least.
    anisotropy : float
        The most, 1 to 10, by which quads are stretched along the direction in which the surface bends less.
    size_fidelity : float
        Where sizes vary (`adaptivity`, density, frames): 0 keeps irregular vertices few, 1 keeps the asked sizes.
    fit_limit_surface : bool
        Move vertices off the surface so that the limit surface of the quads, subdivided by Catmull and Clark's rules with
        sharp creases on features, lies on it.
    symmetry : str
        Planes about which the result is to be symmetric, exactly: letters of ``"xyz"``, each the direction in which the
        plane mirrors. ``"auto"``: those about which the surface itself is symmetric. ``""``: none.
    symmetry_center : {"origin", "bounds"} or (float, float, float)
        Where the planes meet: the origin, the middle of the bounding box, or a point.
    solver : {"multilevel", "eigen"}
        How the periodic field is found: coarse to fine, or, slower, by the paper's eigenvector and Gauss-Newton steps.
    seed : int
        Seed of every random choice; the same seed gives the same bytes.
    threads : int
        Threads to use, 0: as many as this process may. The result does not depend on it.
    time_limit : float or None
        Seconds after which the run stops with :class:`~hybrid_quad.Cancelled`.
    memory_limit : float or None
        Megabytes (of 2**20 bytes) of resident memory of the process at which it stops likewise; looked at twenty times a
        second.
    """

    quads: int = 5000
    edge_length: float | None = None
    sharp_angle: float | None = 40.0
    field_smoothness: float = 0.5
    adaptivity: float = 0.0
    chord_error: float | None = None
    narrow_quads: int = 2
    anisotropy: float = 1.0
    size_fidelity: float = 0.5
    fit_limit_surface: bool = False
    symmetry: str = ""
    symmetry_center: str | tuple[float, float, float] = "origin"
    solver: str = "multilevel"
    seed: int = 0
    threads: int = 0
    time_limit: float | None = None
    memory_limit: float | None = None

    def __post_init__(self) -> None:
        for name in (*_NUMBERS, *(name for name in _NUMBERS_OR_NONE if getattr(self, name) is not None)):
            _require_number(name, getattr(self, name))
        _require(
            _is_integer(self.quads) and 1 <= self.quads <= MOST_QUADS,
            f"quads must be a whole number between 1 and {MOST_QUADS}, not {self.quads!r}",
        )
        _require(
            self.edge_length is None or (math.isfinite(self.edge_length) and self.edge_length > 0),
            f"edge_length must be > 0, not {self.edge_length!r}",
        )
        _require(
            self.sharp_angle is None or 0 <= self.sharp_angle <= 180,
            f"sharp_angle must be between 0 and 180 degrees, not {self.sharp_angle!r}",
        )
        for name in ("field_smoothness", "adaptivity", "size_fidelity"):
            value = getattr(self, name)
            _require(0 <= value <= 1, f"{name} must be between 0 and 1, not {value!r}")
        _require(
            self.chord_error is None or (math.isfinite(self.chord_error) and self.chord_error > 0),
            f"chord_error must be > 0, not {self.chord_error!r}",
        )
        _require(
            self.chord_error is None or self.adaptivity == 0,
            "chord_error and adaptivity exclude each other: both make sizes follow the curvature",
        )
        _require(
            _is_integer(self.narrow_quads) and 1 <= self.narrow_quads <= 2,
            f"narrow_quads must be 1 or 2, not {self.narrow_quads!r}",
        )
        _require(
            1 <= self.anisotropy <= MOST_ANISOTROPY,
            f"anisotropy must be between 1 and {MOST_ANISOTROPY}, not {self.anisotropy!r}",
        )
        _require(
            isinstance(self.fit_limit_surface, bool),
            f"fit_limit_surface must be True or False, not {self.fit_limit_surface!r}",
        )
        _require(
            isinstance(self.symmetry, str)
            and (self.symmetry == "auto" or len(set(self.symmetry) & set(AXES)) == len(self.symmetry)),
            f'symmetry must be "auto" or different letters of "{AXES}", not {self.symmetry!r}',
        )
        _require(
            self.symmetry_center in SYMMETRY_CENTERS
            if isinstance(self.symmetry_center, str)
            else hasattr(self.symmetry_center, "__len__")
            and len(self.symmetry_center) == 3
            and all(math.isfinite(value) for value in self.symmetry_center),
            f'symmetry_center must be "origin", "bounds" or a point, not {self.symmetry_center!r}',
        )
        _require(self.solver in SOLVERS, f"solver must be one of {', '.join(SOLVERS)}, not {self.solver!r}")
        _require(
            _is_integer(self.seed) and 0 <= self.seed < 2**64,
            f"seed must be a whole number from 0 to {2**64 - 1}, not {self.seed!r}",
        )
        _require(
            _is_integer(self.threads) and 0 <= self.threads < 2**16,
            f"threads must be a whole number from 0 to {2**16 - 1}, not {self.threads!r}",
        )
        _require(
            self.time_limit is None or (not math.isnan(self.time_limit) and self.time_limit > 0),
            f"time_limit must be > 0 seconds, not {self.time_limit!r}",
        )
        _require(
            self.memory_limit is None or (not math.isnan(self.memory_limit) and self.memory_limit > 0),
            f"memory_limit must be > 0 MB, not {self.memory_limit!r}",
        )

    def for_native(self) -> dict[str, Any]:
        """Keyword arguments of the compiled module's ``remesh``."""
        return {
            "quads": int(self.quads),
            "edge_length": float(self.edge_length or 0.0),
            "sharp_angle": None if self.sharp_angle is None else float(self.sharp_angle),
            "field_smoothness": float(self.field_smoothness),
            "adaptivity": float(self.adaptivity),
            "chord_error": float(self.chord_error or 0.0),
            "narrow_quads": int(self.narrow_quads),
            "anisotropy": float(self.anisotropy),
            "size_fidelity": float(self.size_fidelity),
            "fit_limit_surface": self.fit_limit_surface,
            "symmetry": self.symmetry,
            "solver": self.solver,
            "seed": int(self.seed),
            "threads": int(self.threads) or usable_threads(),
            "time_limit": float(self.time_limit or 0.0),
            "memory_limit": float(self.memory_limit or 0.0),
        }


def usable_threads() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


_NUMBERS = ("field_smoothness", "adaptivity", "anisotropy", "size_fidelity")
_NUMBERS_OR_NONE = ("edge_length", "sharp_angle", "chord_error", "time_limit", "memory_limit")


def _require_number(name: str, value: object) -> None:
    is_array = getattr(value, "ndim", 0) > 0
    if is_array or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
        raise TypeError(f"{name} must be a number, not {value!r}")


def _is_integer(value: object) -> bool:
    try:
        operator.index(value)  # type: ignore[arg-type]
    except TypeError:  # arrays have the method as well
        return False
    return not isinstance(value, bool)


def _require(condition: bool, message: str) -> None:
    if not condition:
        raise ValueError(message)
