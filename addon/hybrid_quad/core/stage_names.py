"""What the stages of a run are called where people read it: reports and files have the short names, a window has these words."""

from __future__ import annotations

from collections.abc import Callable

# Every stage that the native code or a worker tells of, and what is being done in it, in words that need no knowledge of the method.
WORDS = {
    "start": "starting",
    "mesh": "checking the mesh",
    "symmetry": "looking for symmetry",
    "features and sizes": "finding edges to keep",
    "working surface": "making an even surface",
    "frame field": "finding edge directions",
    "sizing": "fitting the edge lengths",
    "periodic field": "laying out rows of quads",
    "spanning parameterization": "laying the grid",
    "regular quads": "cutting out quads",
    "singular patches": "filling the gaps",
    "assemble": "joining the quads",
    "improve": "improving the quads",
    "hard guides": "fitting loops and rings",
    "count": "adjusting the quad count",
    "limit surface": "fitting the subdivision",
    "quality": "measuring the result",
    "done": "handing the result over",
    "validation": "checking the result",
    "data_transfer": "transferring data",
    "part": "fitting the part in",
    # Where something is noticed that must not happen.
    "remesh": "making the quads",
    "repair": "checking the mesh",
    "quad complex": "joining the quads",
    "working_surface": "making an even surface",
    "eigenpair": "laying out rows of quads",
    "patch": "filling the gaps",
    "morse-smale": "filling the gaps",
    "subdivision": "subdividing the surface",
    "case": "running a case",
}


def in_words(stage: str) -> str:
    """What is done in a stage, as it goes on in a sentence: ``"finding edge directions"``."""
    return WORDS.get(stage or "start") or stage.replace("_", " ")


def while_in(stage: str) -> str:
    """When something happened: ``"while finding edge directions"``; empty where the stage is not known."""
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
