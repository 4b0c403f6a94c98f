"""Brushes: what a stroke over a surface does to directions, densities and lines. No Blender."""
