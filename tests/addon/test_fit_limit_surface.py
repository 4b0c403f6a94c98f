"""A result whose subdivision surface is where the source was, by Blender's own modifier."""

from __future__ import annotations

import bpy
import numpy as np

from hybrid_quad.blender import command_arguments
from hybrid_quad.blender.remesh_task import prepare_task
from scenes import add_cube, add_sphere, points_of, remesh


def _subdivided(obj: bpy.types.Object) -> np.ndarray:
    """(n, 3) Points of the object's limit surface, nearly."""
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 3
    bpy.context.view_layer.update()
    return points_of(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))


def _from_sphere(fit: bool) -> float:
    obj = add_sphere(quads=150)
    obj.modifiers.new("Round", "SUBSURF").levels = 2
    source = points_of(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    radius = np.linalg.norm(source, axis=1).mean()
    obj.hybrid_quad.fit_limit_surface = fit
    obj.hybrid_quad.use_sharp_angle = False
    return float(np.abs(np.linalg.norm(_subdivided(remesh()), axis=1) - radius).mean() / radius)


def test_a_subdivision_surface_on_a_fitted_sphere_is_the_sphere():
    unfitted, fitted = _from_sphere(False), _from_sphere(True)
    assert fitted < 0.3 * unfitted


def test_kept_edges_and_corners_stay_sharp_under_a_subdivision_surface():
    obj = add_cube()
    obj.hybrid_quad.fit_limit_surface = True
    points = _subdivided(remesh())
    sides = np.isclose(np.abs(points), 1, atol=1e-4)
    assert sides.any(axis=1).all(), "all of it lies on the cube"
    assert len(np.unique(np.round(points[sides.all(axis=1)]), axis=0)) == 8, "which has its corners"


def test_without_the_setting_nothing_is_creased():
    obj = add_cube()
    points = _subdivided(remesh())
    assert not np.isclose(np.abs(points), 1, atol=1e-4).all(axis=1).any()
    assert not prepare_task(obj, bpy.context.evaluated_depsgraph_get()).options.fit_limit_surface


def test_the_setting_from_arguments():
    obj = add_cube()
    words = "--object Cube --output o.blend --fit-limit"
    command_arguments.apply_settings(obj, command_arguments.command_parser().parse_args(words.split()))
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get()).options.fit_limit_surface is True
