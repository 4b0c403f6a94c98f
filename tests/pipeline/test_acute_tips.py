"""Flat triangles with a right angle: rows of quads go around their tips, and do not end along them."""

import numpy as np
import pytest

from hybrid_quad import remesh


@pytest.mark.parametrize("degrees", [25.0, 30.0, 40.0, 45.0])
def test_a_right_triangle_needs_a_few_irregular_vertices(degrees: float) -> None:
    rise = np.tan(np.radians(degrees))
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, rise, 0.0]])
    result = remesh(corners, np.array([[0, 1, 2]]), quads=1000)
    report = result.report
    assert abs(report["quads"] / 1000 - 1) < 0.05
    assert report["irregular_vertices"] <= 4  # before tips were opened: 20 to 40
    assert report["scaled_jacobian"]["min"] > 0.95 * np.sin(np.radians(degrees))
