"""What the stages of a run are called where people read it: reports and files have the short names, a window has these words."""

from __future__ import annotations

from collections.abc import Callable

# Every stage that the native code or a worker tells of, and what is being done in it, in words that need no knowledge of the method.
WORDS = {
    "start": "starting",
    "mesh": "checking and repairing the mesh",
    "symmetry": "looking for symmetry",
    "features and sizes": "finding sharp edges and sizes",
    "working surface": "making an even surface to work on",
    "frame field": "finding the directions of edges",
    "sizing": "fitting the sizes to the directions",
    "periodic field": "finding where rows of quads lie",
    "spanning parameterization": "laying a grid on the surface",
    "regular quads": "cutting quads out of the grid",
    "singular patches": "filling the gaps between the quads",
    "assemble": "joining the quads",
    "improve": "improving the shape of the quads",
    "hard guides": "fitting edges to loops and rings",
    "count": "adjusting the number of quads",
    "limit surface": "fitting the subdivided surface",
    "quality": "measuring the result",
    "done": "handing the result over",
    "validation": "checking the result",
    "data_transfer": "transferring data to the result",
    # Where something is noticed that must not happen.
    "remesh": "making the quads",
    "repair": "checking and repairing the mesh",
    "quad complex": "joining the quads",
    "working_surface": "making an even surface to work on",
    "eigenpair": "finding where rows of quads lie",
    "patch": "filling the gaps between the quads",
    "morse-smale": "filling the gaps between the quads",
    "subdivision": "subdividing the surface",
    "case": "running a case",
}


def in_words(stage: str) -> str:
    """What is done in a stage, as it goes on in a sentence: ``"finding the directions of edges"``."""
    return WORDS.get(stage or "start") or stage.replace("_", " ")


def while_in(stage: str) -> str:
    """When something happened: ``"while finding the directions of edges"``; empty where the stage is not known."""
    return f"while {in_words(stage)}" if stage else ""


class StageWatch:
    """Remembers what ran last; hands progress on.

    Attributes
    ----------
    stage : str
    """

    def __init__(self, progress: Callable[[str, float], object] | None = None) -> None:
        self.stage = "start"
        self._progress = progress

    def __call__(self, stage: str, fraction: float) -> None:
        """Takes notice of progress."""
        self.stage = stage or self.stage
        if self._progress is not None:
            self._progress(stage, fraction)
