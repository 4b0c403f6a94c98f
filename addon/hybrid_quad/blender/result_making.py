"""A result's mesh, made a while at a time before it is placed."""

from __future__ import annotations

import time

import bpy

from ..core.errors import InputError
from ..core.remesh import RemeshResult
from ..worker.transfer_request import TransferredData
from .own_mesh import OwnMesh
from .remesh_task import RemeshTask
from .result_mesh import build_in_steps
from .steps import Steps


class ResultMaking:
    """Makes a mesh in steps that change nothing of the scene; once more where an undo takes away what is half made."""

    def __init__(self, task: RemeshTask, result: RemeshResult, carried: TransferredData) -> None:
        self._task, self._result, self._carried = task, result, carried
        self._steps: Steps[OwnMesh] | None = None
        self._made: OwnMesh | None = None

    def go_on(self, obj: bpy.types.Object, seconds: float) -> bool:
        """Does steps for some time; whether the mesh was there before: placing takes its time too."""
        if self._made is not None:
            return True
        until = time.monotonic() + seconds
        try:
            if self._steps is None:
                self._steps = build_in_steps(obj, self._task, self._result, self._carried)
            next(self._steps)
            while time.monotonic() < until:
                next(self._steps)
        except StopIteration as end:
            self._made = end.value
        except InputError:  # mesh_gone
            self._steps = None
        return False

    def take(self) -> OwnMesh | None:
        """The mesh, if it is made and still there; it belongs to the caller from now on."""
        made, self._made = self._made, None
        return made if made is not None and made.is_there() else None

    def cancel(self) -> None:
        """Removes what is made."""
        if self._steps is not None:
            self._steps.close()
        if self._made is not None:
            self._made.remove()
