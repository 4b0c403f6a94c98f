"""Lines that guide quads: curve objects, grease pencils, edges of mesh objects, and annotations."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from typing import Any

import bpy
import numpy as np

from ..core.mesh_arrays import FloatArray
from ..core.options import STROKE_KINDS
from ..core.strokes import joined_lines

# Object types whose lines can guide. GPENCIL became GREASEPENCIL in Blender 4.3.
LINE_TYPES = ("CURVE", "CURVES", "FONT", "SURFACE", "MESH", "GPENCIL", "GREASEPENCIL")
_PENCIL_TYPES = ("GPENCIL", "GREASEPENCIL")
# In a collection these are more likely models than lines.
_LINE_TYPES_OF_COLLECTION = tuple(kind for kind in LINE_TYPES if kind not in ("MESH", "FONT", "SURFACE"))


# Custom property of a guide object, or its collection, that says what its lines are for: one of STROKE_KINDS. Children of the object
# that have it guide without being named: painted lines are such.
KIND_PROPERTY = "hybrid_quad_guide_kind"


def lines_of_settings(settings: Any, depsgraph: bpy.types.Depsgraph) -> list[tuple[str, FloatArray]]:
    """Lines of the objects that an object's settings name as guides: the kind, and (k, 3) points in world space, of each."""
    objects = [settings.guide_object] if settings.guide_object else []
    if settings.guide_collection:
        objects += [obj for obj in settings.guide_collection.all_objects if obj.type in _LINE_TYPES_OF_COLLECTION]
    if settings.use_painted_lines:
        objects += [child for child in settings.id_data.children if child.type in LINE_TYPES and _own_kind(child)]
    unique = {obj.name_full: obj for obj in objects}
    default = settings.guide_objects_kind.lower()
    named = {obj.name_full for obj in settings.guide_collection.all_objects} if settings.guide_collection else set()
    of_collection = _own_kind(settings.guide_collection) or default
    return [
        (_own_kind(obj) or (of_collection if obj.name_full in named else default), line)
        for obj in unique.values()
        for line in joined_lines(lines_of_object(obj, depsgraph))
    ]


def guides_without_lines(settings: Any, depsgraph: bpy.types.Depsgraph) -> list[str]:
    """A sentence for each object or collection that an object's settings name as a guide, but that has no lines."""
    single, collection = settings.guide_object, settings.guide_collection
    found = []
    if single and not lines_of_object(single, depsgraph):
        found.append(f'The guide object "{single.name}" has no lines to follow')
    if collection and not any(
        lines_of_object(obj, depsgraph) for obj in collection.all_objects if obj.type in _LINE_TYPES_OF_COLLECTION
    ):
        found.append(f'The guide collection "{collection.name}" has no lines to follow')
    return found


def _own_kind(owner: Any) -> str | None:
    """What a guide object or collection says itself, or None."""
    kind = str(owner.get(KIND_PROPERTY, "")).lower() if owner else ""
    return kind if kind in STROKE_KINDS else None


def lines_of_object(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[FloatArray]:
    """An object's lines as modifiers leave them: (k, 3) points each, in world space.

    Of a curve that has a thickness it is the line in the middle, without modifiers. Objects of other types have none.
    """
    if obj.type not in LINE_TYPES:
        return []
    evaluated = obj.evaluated_get(depsgraph)
    if obj.type in _PENCIL_TYPES:
        lines = list(_pencil_lines(evaluated.data, depsgraph.scene.frame_current))
    elif obj.type == "CURVES":
        lines = list(_hair_lines(evaluated.data))
    elif obj.type == "CURVE" and _is_thick(obj.data):
        lines = _lines_of_bare_copy(obj)
    else:
        lines = _mesh_lines(evaluated)
    matrix = np.array(evaluated.matrix_world, np.float64)
    return [_moved(line, matrix) for line in lines if len(line) > 1]


def lines_of_annotations(scene: bpy.types.Scene) -> list[FloatArray]:
    """Visible strokes of a scene's annotations in its current frame: (k, 3) points each, in world space."""
    # "annotation" from Blender 5.0 on.
    data = getattr(scene, "annotation", None) or getattr(scene, "grease_pencil", None)
    if data is None:
        return []
    lines = []
    for layer in data.layers:
        if layer.annotation_hide:
            continue
        frame = _frame_at(layer.frames, scene.frame_current)
        if frame is not None:
            lines += [line for line in _stroke_lines(frame.strokes) if len(line) > 1]
    return lines


def _pencil_lines(data: Any, frame_number: int) -> Iterator[FloatArray]:
    for layer in data.layers:
        frame = None if layer.hide else _frame_at(layer.frames, frame_number)
        if frame is None:
            continue
        if hasattr(frame, "drawing"):  # from Blender 4.3 on
            matrix, lines = layer.matrix_local, _drawing_lines(frame.drawing)
        else:
            matrix, lines = layer.matrix_layer, _stroke_lines(frame.strokes)
        for line in lines:
            yield _moved(line, np.array(matrix, np.float64))


def _frame_at(frames: Iterable[Any], number: int) -> Any:
    """The key frame that shows at a frame: the latest one not after it."""
    begun = [frame for frame in frames if frame.frame_number <= number]
    return max(begun, key=lambda frame: frame.frame_number, default=None)


def _stroke_lines(strokes: Iterable[Any]) -> Iterator[FloatArray]:
    """Lines of strokes of annotations, and of grease pencils before Blender 4.3; not of those drawn on the screen."""
    for stroke in strokes:
        if getattr(stroke, "display_mode", "3DSPACE") == "3DSPACE":
            line = _read(stroke.points, "co", 3).reshape(-1, 3)
            yield _closed(line) if getattr(stroke, "use_cyclic", False) else line


def _drawing_lines(drawing: Any) -> Iterator[FloatArray]:
    positions, offsets = drawing.attributes.get("position"), drawing.curve_offsets
    if positions is None or not len(offsets):
        return
    points = _read(positions.data, "vector", 3).reshape(-1, 3)
    cyclic = drawing.attributes.get("cyclic")
    bounds = [offset.value for offset in offsets]
    for index, (begin, end) in enumerate(itertools.pairwise(bounds)):
        is_closed = cyclic is not None and cyclic.data[index].value
        yield _closed(points[begin:end]) if is_closed else points[begin:end]


def _hair_lines(data: Any) -> Iterator[FloatArray]:
    points = _read(data.points, "position", 3).reshape(-1, 3)
    for curve in data.curves:
        yield points[curve.first_point_index : curve.first_point_index + curve.points_length]


def _is_thick(curve: Any) -> bool:
    return bool(
        curve.bevel_depth
        or curve.extrude
        or curve.bevel_object
        or (curve.dimensions == "2D" and curve.fill_mode != "NONE")
    )


def _lines_of_bare_copy(obj: bpy.types.Object) -> list[FloatArray]:
    data = obj.data.copy()
    data.dimensions, data.bevel_depth, data.extrude, data.bevel_object = "3D", 0.0, 0.0, None
    bare = bpy.data.objects.new("Hybrid Quad guide", data)
    try:
        return _mesh_lines(bare)
    finally:
        bpy.data.objects.remove(bare)
        bpy.data.curves.remove(data)


def _mesh_lines(obj: bpy.types.Object) -> list[FloatArray]:
    """Every edge of an object's mesh as a line of its own."""
    try:
        mesh = obj.to_mesh()
    except RuntimeError:  # it has none
        return []
    try:
        if mesh is None or not len(mesh.edges):
            return []
        ends = np.empty(2 * len(mesh.edges), np.int32)
        mesh.edges.foreach_get("vertices", ends)
        return list(_read(mesh.vertices, "co", 3).reshape(-1, 3)[ends.reshape(-1, 2)])
    finally:
        obj.to_mesh_clear()


def _read(collection: Any, name: str, width: int) -> FloatArray:
    values = np.empty(width * len(collection), np.float32)
    collection.foreach_get(name, values)
    return values.astype(np.float64)


def _closed(line: FloatArray) -> FloatArray:
    return np.concatenate([line, line[:1]])


def _moved(line: FloatArray, matrix: FloatArray) -> FloatArray:
    return line @ matrix[:3, :3].T + matrix[:3, 3]
