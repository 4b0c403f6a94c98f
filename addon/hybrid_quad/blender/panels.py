"""The panels of the tab "Hybrid Quad" of the 3D view's sidebar that are about one run, in their order."""

from __future__ import annotations

from .check_panel import VIEW3D_PT_hybrid_quad_check
from .feature_panels import VIEW3D_PT_hybrid_quad_feature_sources, VIEW3D_PT_hybrid_quad_features
from .flow_panels import VIEW3D_PT_hybrid_quad_flow, VIEW3D_PT_hybrid_quad_guides, VIEW3D_PT_hybrid_quad_symmetry
from .main_panel import VIEW3D_PT_hybrid_quad
from .report_panel import VIEW3D_PT_hybrid_quad_report
from .run_panels import VIEW3D_PT_hybrid_quad_limits, VIEW3D_PT_hybrid_quad_transfer

CLASSES = (
    VIEW3D_PT_hybrid_quad,
    VIEW3D_PT_hybrid_quad_features,
    VIEW3D_PT_hybrid_quad_feature_sources,
    VIEW3D_PT_hybrid_quad_guides,
    VIEW3D_PT_hybrid_quad_flow,
    VIEW3D_PT_hybrid_quad_symmetry,
    VIEW3D_PT_hybrid_quad_transfer,
    VIEW3D_PT_hybrid_quad_limits,
    VIEW3D_PT_hybrid_quad_check,
    VIEW3D_PT_hybrid_quad_report,
)
