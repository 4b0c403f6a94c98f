"""What is looked at after a run of ``hybrid-quad remesh``."""

from __future__ import annotations

from ..core.errors import InternalError


def check_valid(violations: list[str]) -> None:
    """Raises InternalError where there is any."""
    if violations:
        raise InternalError("the result is no valid quad mesh: " + "; ".join(violations), "validation")
