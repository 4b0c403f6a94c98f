"""Drags a file into another program's window, as a file manager does: GTK's drag and drop, the mouse moved by XTEST.

    DISPLAY=:99 python3 drag_file.py PATH X Y

X, Y: where it is let go, in pixels of the screen. Ends with status 0 if what is there has taken the file, else with 1. The other
program need not see this one's files: a path is all that it gets. For Debian's Python, python3-gi, gir1.2-gtk-3.0 and xdotool.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import gi

gi.require_version("Gdk", "3.0")
gi.require_version("Gtk", "3.0")
from gi.repository import Gdk, GLib, Gtk  # noqa: E402

SIZE = 60
STEPS = 20
STEP = 0.05  # seconds
PATIENCE = 15


class Source:
    """A small window in the upper left corner, from which the file is taken."""

    def __init__(self, path: str, x: int, y: int) -> None:
        self.uri, self.end = Path(path).as_uri(), (x, y)
        self.context: Gdk.DragContext | None = None
        self.is_taken = False
        window = Gtk.Window(type=Gtk.WindowType.POPUP)
        window.add(Gtk.Label(label="zip"))
        window.set_default_size(SIZE, SIZE)
        window.move(0, 0)
        window.drag_source_set(Gdk.ModifierType.BUTTON1_MASK, [], Gdk.DragAction.COPY)
        window.drag_source_add_uri_targets()
        window.connect("drag-begin", self._begun)
        window.connect("drag-data-get", self._give)
        window.connect("drag-end", self._ended)
        window.show_all()

    def _begun(self, _window, context) -> None:
        self.context = context

    @property
    def is_accepted(self) -> bool:
        """Whether what is below the mouse has answered that it would take the file."""
        return self.context is not None and self.context.get_selected_action() != 0

    def _give(self, _window, _context, selection, _info, _time) -> None:
        selection.set_uris([self.uri])
        self.is_taken = True

    def _ended(self, _window, _context) -> None:
        Gtk.main_quit()

    def drag(self):
        """Takes hold, moves in steps so that the window below can answer each, and lets go once it has."""
        (x, y), begin = self.end, SIZE // 2
        for _ in range(10):  # until its window is on the screen
            yield
        mouse("mousemove", begin, begin)
        yield
        mouse("mousedown", 1)
        for step in range(1, STEPS + 1):
            mouse("mousemove", begin + (x - begin) * step // STEPS, begin + (y - begin) * step // STEPS)
            yield
        began = time.monotonic()
        while not self.is_accepted and time.monotonic() - began < PATIENCE:
            for side in (1, -1):
                mouse("mousemove_relative", "--", side, 0)
                yield
        mouse("mouseup", 1)


def mouse(*words: object) -> None:
    subprocess.run(["xdotool", *map(str, words)], check=True)


def main() -> int:
    path, x, y = sys.argv[1:]
    source = Source(path, int(x), int(y))
    steps = source.drag()
    GLib.timeout_add(int(STEP * 1000), lambda: next(steps, "end") is None)
    GLib.timeout_add(2 * PATIENCE * 1000, Gtk.main_quit)
    Gtk.main()
    return 0 if source.is_taken else 1


if __name__ == "__main__":
    sys.exit(main())
