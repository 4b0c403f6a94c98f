"""The panels of the tab "Hybrid Quad" of the 3D view's sidebar, in their order.

What is set for every run comes first, then what some runs need, what is seen before and after a run, and what is rarely changed.
"""

from __future__ import annotations

from .check_panel import VIEW3D_PT_hybrid_quad_check
from .feature_panels import VIEW3D_PT_hybrid_quad_feature_sources, VIEW3D_PT_hybrid_quad_features
from .flow_panels import (
    VIEW3D_PT_hybrid_quad_flow,
    VIEW3D_PT_hybrid_quad_flow_advanced,
    VIEW3D_PT_hybrid_quad_guides,
    VIEW3D_PT_hybrid_quad_symmetry,
)
from .main_panel import VIEW3D_PT_hybrid_quad
from .painting.paint_panel import VIEW3D_PT_hybrid_quad_painting
from .part_panel import VIEW3D_PT_hybrid_quad_part
from .preview.panels import VIEW3D_PT_hybrid_quad_limit, VIEW3D_PT_hybrid_quad_preview
from .report_panel import VIEW3D_PT_hybrid_quad_report
from .run_panels import VIEW3D_PT_hybrid_quad_limits, VIEW3D_PT_hybrid_quad_transfer

CLASSES = (
    VIEW3D_PT_hybrid_quad,
    VIEW3D_PT_hybrid_quad_features,
    VIEW3D_PT_hybrid_quad_feature_sources,
    VIEW3D_PT_hybrid_quad_flow,
    VIEW3D_PT_hybrid_quad_flow_advanced,
    VIEW3D_PT_hybrid_quad_symmetry,
    VIEW3D_PT_hybrid_quad_guides,
    VIEW3D_PT_hybrid_quad_painting,
    VIEW3D_PT_hybrid_quad_part,
    VIEW3D_PT_hybrid_quad_preview,
    VIEW3D_PT_hybrid_quad_report,
    VIEW3D_PT_hybrid_quad_limit,
    VIEW3D_PT_hybrid_quad_check,
    VIEW3D_PT_hybrid_quad_transfer,
    VIEW3D_PT_hybrid_quad_limits,
)
