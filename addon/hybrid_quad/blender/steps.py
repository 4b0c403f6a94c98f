"""Work on Blender's own thread that is done in steps, between which the window answers."""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

Result = TypeVar("Result")

# What is done up to each `yield` is a step; what is returned comes of the whole. The first step may look at the scene as it is;
# those after it know nothing of Blender's that could be gone by then.
Steps = Generator[None, None, Result]


def finish(steps: Steps[Result]) -> Result:
    """Does all steps that are left, at once."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: Result = end.value
            return result
