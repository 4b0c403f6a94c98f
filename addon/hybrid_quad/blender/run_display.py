"""How far the run in the background is, in the status bar and the sidebar."""

from __future__ import annotations

import contextlib

import bpy

from .background_run import BackgroundRun, current

_HOW_TO_CANCEL = "Esc in the 3D View or Cancel in the sidebar ends it"


class RunDisplay:
    """Tells of one run, and clears everything again."""

    def __init__(self, run: BackgroundRun) -> None:
        self._run = run
        self._text = ""
        self._workspaces: set[str] = set()

    def update(self, context: bpy.types.Context) -> None:
        """Shows how far the run is, where that has changed."""
        done = f"{100 * self._run.fraction:.0f} %"
        now = ". ".join(part for part in (f"{self._run.status}, {done}", self._run.silence) if part)
        text = f'Remeshing "{self._run.source.name}": {now}    {_HOW_TO_CANCEL}'
        if self._run.is_finished and not self._run.is_building:
            text = f'"{self._run.source.name}" is remeshed: go to Object Mode to get the result'
        if text == self._text and context.workspace.name in self._workspaces:
            return
        self._text = text
        self._workspaces.add(context.workspace.name)
        context.workspace.status_text_set(text)
        redraw_sidebars()

    def clear(self) -> None:
        """Gives the status bar back."""
        for name in self._workspaces:
            if name in bpy.data.workspaces:
                bpy.data.workspaces[name].status_text_set(None)
        redraw_sidebars()


def redraw_sidebars() -> None:
    """Of all 3D views; the views themselves, which may take their time, stay."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def register() -> None:
    """Adds what Blenders before 4.0, which have no progress bar, show in its place: a number that nobody can set."""
    bpy.types.WindowManager.hybrid_quad_progress = bpy.props.FloatProperty(
        name="Progress",
        description="How much of the run in the background is done",
        min=0.0,
        max=100.0,
        precision=0,
        subtype="PERCENTAGE",
        get=lambda _manager: 0.0 if current() is None else 100.0 * current().fraction,
    )


def unregister() -> None:
    """Takes it away again, if it is there."""
    with contextlib.suppress(AttributeError):
        del bpy.types.WindowManager.hybrid_quad_progress
