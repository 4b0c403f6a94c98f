"""Labels of the sidebar: none is cut where it is as wide as Blender makes it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import blf
import bpy
import pytest

from hybrid_quad.blender import panels
from scenes import add_sphere

# Pixels that stand beside a value, and beside the box of a switch, in panels inside a panel: as seen in Blender 3.4 and 5.2.
VALUE_LABEL, SWITCH_LABEL = 58, 75
CHOICE = 74  # what a list shows of the one that is chosen


class Layout:
    """Takes the place of a panel's layout, and collects the labels that a property-split column has to hold."""

    def __init__(self, labels: list[tuple[str, int]]) -> None:
        self._labels = labels

    def __getattr__(self, name: str) -> Any:
        return lambda *_args, **_kwargs: SimpleNamespace()

    def _inner(self, heading: str = "", **_kwargs: Any) -> Layout:
        self._labels.append((heading, VALUE_LABEL))
        return Layout(self._labels)

    row = column = box = split = _inner

    def prop(self, data: Any, name: str, *, text: str | None = None, toggle: bool = False, **_kwargs: Any) -> None:
        prop = data.bl_rna.properties[name]
        is_switch = prop.type == "BOOLEAN" and not toggle
        if prop.type == "ENUM" and not prop.is_enum_flag:
            self._labels.extend((item.name, CHOICE) for item in prop.enum_items)
        self._labels.append((prop.name if text is None else text, SWITCH_LABEL if is_switch else VALUE_LABEL))

    def prop_search(self, data: Any, name: str, *_where: Any, text: str | None = None) -> None:
        self.prop(data, name, text=text)


def width_of(text: str) -> float:
    """In pixels, in the font of panels."""
    blf.size(0, 11)
    return float(blf.dimensions(0, text)[0])


@pytest.mark.parametrize("panel", panels.CLASSES[1:], ids=lambda panel: panel.bl_label)
def test_no_label_is_cut(panel):
    obj = add_sphere()
    obj.hybrid_quad.part.region = "ATTRIBUTE"
    labels: list[tuple[str, int]] = []
    panel.draw(SimpleNamespace(layout=Layout(labels)), bpy.context)
    too_long = [(label, width_of(label)) for label, room in labels if width_of(label) > room]
    assert not too_long


def test_a_long_label_is_noticed():
    labels: list[tuple[str, int]] = []
    layout = Layout(labels)
    layout.prop(bpy.context.scene.render, "use_border", text="A label that is far too long")
    assert width_of(labels[0][0]) > labels[0][1]
