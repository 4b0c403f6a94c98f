"""The three ways in which a run can fail."""

from __future__ import annotations

TYPE_CHECKING = False  # see the package's own
if TYPE_CHECKING:
    from collections.abc import Sequence


class InputError(ValueError):
    """The input cannot be remeshed, and whoever made it can change that.

    Attributes
    ----------
    code : str
        Stable and machine-readable, for example ``"non_orientable"``.
    element_kind : str
        What `elements` counts: ``"vertex"``, ``"face"``, ``"edge"`` (vertex pairs, flattened) or ``""``.
    elements : tuple of int
        Offending elements of the input, 0-based.
    """

    def __init__(self, code: str, message: str, element_kind: str = "", elements: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.code = code
        self.element_kind = element_kind
        self.elements = tuple(int(element) for element in elements)

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str, tuple[int, ...]]]:
        return type(self), (self.code, str(self), self.element_kind, self.elements)


class Cancelled(Exception):
    """The caller asked to stop, or the time or memory limit is reached.

    Attributes
    ----------
    code : str
        ``"cancelled"``, ``"time_limit"`` or ``"memory_limit"``.
    """

    def __init__(self, message: str = "cancelled", code: str = "cancelled") -> None:
        super().__init__(message)
        self.code = code

    def __reduce__(self) -> tuple[type[Cancelled], tuple[str, str]]:
        return type(self), (str(self), self.code)


class InternalError(RuntimeError):
    """A promise between two stages did not hold: a bug of this program, not of the mesh.

    Attributes
    ----------
    stage : str
        Where it was noticed.
    """

    def __init__(self, message: str, stage: str = "") -> None:
        super().__init__(message)
        self.stage = stage

    def __reduce__(self) -> tuple[type[InternalError], tuple[str, str]]:
        return type(self), (str(self), self.stage)
