"""Prints a run's report for people."""

import json
import sys
from pathlib import Path

report = json.loads(Path(sys.argv[1]).read_text())
quality = report["scaled_jacobian"]
patches = report["patches"]
rows = [
    ("input", f"{report['input_faces']} faces, {report['input_vertices']} vertices"),
    ("result", f"{report['quads']} quads, {report['vertices']} vertices"),
    (
        "irregular vertices",
        f"{report['irregular_vertices']} (the field has {report['field_singularities']} singularities)",
    ),
    ("scaled Jacobian", f"mean {quality['mean']:.3f}, worst hundredth {quality['p1']:.3f}, worst {quality['min']:.3f}"),
    (
        "largest distance",
        f"{report['hausdorff_percent']:.3f} % of the diagonal; features {report['feature_hausdorff_percent']:.3f} %",
    ),
    (
        "singular patches",
        f"{patches['count']}: {patches['morse_smale']} Morse-Smale, {patches['combinatorial']} combinatorial",
    ),
    ("time", f"{sum(stage['seconds'] for stage in report['stages']):.2f} s"),
]
for name, text in rows:
    print(f"{name:>20}  {text}")
for stage in report["stages"]:
    print(f"{stage['name']:>36}  {stage['seconds']:7.3f} s  {stage['peak_mb']:6.0f} MB")
for warning in report["warnings"]:
    print(f"{'warning':>20}  {warning}")
