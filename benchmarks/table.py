"""Results of many runs as CSV and Markdown."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from refusals import refusal_code
from runs import OWN, Outcome


def _found(outcome: Outcome, *keys: str) -> Any:
    value: Any = outcome.judgement or outcome.report
    for key in keys:
        value = value.get(key) if isinstance(value, dict) else None
    return value


def _own_checks(outcome: Outcome) -> Any:
    if not outcome.has_mesh:
        return None
    return "failed" if any(check.startswith(OWN) for check in outcome.failed) else "ok"


def _judge(outcome: Outcome) -> str:
    """What the independent judge alone said; "samples" as in "valid but for samples"."""
    if not outcome.judged:
        return "not asked"
    if outcome.status == "valid but for samples":
        return "samples"
    return "ok" if all(check.startswith(OWN) for check in outcome.failed) else "failed"


def _distance(outcome: Outcome) -> Any:
    distances = outcome.judgement.get("distance_pct")
    if distances:
        return max(distances["out_to_in_max"], distances["in_to_out_max"])
    return outcome.report.get("hausdorff_percent")


def _feature_distance(outcome: Outcome) -> Any:
    if outcome.setting == "no_sharp":
        return None
    if "feature_pct" in outcome.judgement:
        return outcome.judgement["feature_pct"]["max"]
    return outcome.report.get("feature_hausdorff_percent")


def _singular_area(outcome: Outcome) -> Any:
    fraction = outcome.report.get("singular_area_fraction")
    return None if fraction is None else 100 * fraction


Column = tuple[str, str, Callable[[Outcome], Any]]
COLUMNS: Sequence[Column] = (
    ("model", "", lambda o: o.model),
    ("setting", "", lambda o: o.setting),
    ("variant", "", lambda o: o.variant),
    ("asked", "d", lambda o: o.quads),
    ("quads", "d", lambda o: o.report.get("quads")),
    ("valid", "", lambda o: "yes" if o.status == "valid" else o.status),
    ("own checks", "", _own_checks),
    ("judge", "", _judge),
    ("failed checks", "", lambda o: ", ".join(o.failed)),
    ("irregular", "d", lambda o: _found(o, "irregular") if o.judgement else o.report.get("irregular_vertices")),
    ("S(F)", "d", lambda o: o.report.get("field_singularities")),
    ("SJ mean", ".4f", lambda o: _found(o, "scaled_jacobian", "mean")),
    ("SJ 1 %", ".3f", lambda o: _found(o, "scaled_jacobian", "p1")),
    ("SJ min", ".3f", lambda o: _found(o, "scaled_jacobian", "min")),
    ("distance %", ".3f", _distance),
    ("feature distance %", ".3f", _feature_distance),
    ("singular area %", ".1f", _singular_area),
    ("patches", "d", lambda o: o.report.get("patches", {}).get("count")),
    ("fills", "d", lambda o: o.report.get("patches", {}).get("combinatorial")),
    ("threads", "d", lambda o: o.threads),
    ("seconds", ".2f", lambda o: o.seconds),
    ("CPU s", ".2f", lambda o: o.cpu_seconds),
    ("peak MB", ".0f", lambda o: o.peak_mb),
)


def as_csv(outcomes: Sequence[Outcome]) -> str:
    """All columns, and the message of a run that failed."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*(name for name, _, _ in COLUMNS), "message"])
    for outcome in outcomes:
        writer.writerow([*(_cell(outcome, column) for column in COLUMNS), outcome.message])
    return text.getvalue()


def as_markdown(outcomes: Sequence[Outcome]) -> str:
    """A summary, a row for each number and kind of wishes, then one for each run."""
    lines = [*summary(outcomes), "", *_by_number(outcomes), ""]
    lines += ["| " + " | ".join(name for name, _, _ in COLUMNS) + " |"]
    lines += ["|" + "|".join("---" if kind == "" else "--:" for _, kind, _ in COLUMNS) + "|"]
    lines += ["| " + " | ".join(_cell(outcome, column) for column in COLUMNS) + " |" for outcome in outcomes]
    return "\n".join(lines) + "\n"


def as_short_markdown(outcomes: Sequence[Outcome]) -> str:
    """A row for each run that tells only what it came to and what it took, for a page."""
    lines = ["| model | outcome | quads | CPU s | peak MB |", "|---|---|--:|--:|--:|"]
    for outcome in outcomes:
        code = refusal_code(outcome) if outcome.status in ("refused", "wrongly refused") else ""
        told = f"{outcome.status}: `{code}`" if code else outcome.status
        quads = outcome.report.get("quads", "") if outcome.has_mesh else ""
        lines.append(f"| {outcome.model} | {told} | {quads} | {outcome.cpu_seconds:.1f} | {outcome.peak_mb:.0f} |")
    return "\n".join(lines) + "\n"


def summary(outcomes: Sequence[Outcome]) -> list[str]:
    """A few lines for a person: how many are valid, and what is wrong with the others."""
    valid = sum(outcome.status == "valid" for outcome in outcomes)
    lines = [f"{valid} of {len(outcomes)} runs are valid."]
    others = Counter(outcome.status for outcome in outcomes if outcome.status != "valid")
    for status, count in others.most_common():
        lines.append(f"- {status}: {count}")
        if status in ("refused", "wrongly refused"):
            codes = Counter(refusal_code(outcome) for outcome in outcomes if outcome.status == status)
            lines += [f"  - for {code}: {count}" for code, count in codes.most_common()]
    unjudged = sum(outcome.has_mesh and not outcome.judged for outcome in outcomes)
    if unjudged:
        lines.append(f"- by our own validation only, the judge was not asked: {unjudged}")
    checks = Counter(check.split(":")[0] for outcome in outcomes for check in outcome.failed)
    lines += [f"- failed check {check}: {count}" for check, count in checks.most_common()]
    counted = [o for o in outcomes if o.quads >= 1000 and o.report.get("quads")]
    off = [o for o in counted if abs(o.report["quads"] / o.quads - 1) > 0.1]
    silent = [o for o in off if not o.report.get("warnings")]
    if counted:
        lines.append(
            f"- count off by more than 10 % at 1000 quads or more: {len(off)} of {len(counted)}, "
            f"{len(silent)} of them without a warning"
        )
    return lines


def _by_number(outcomes: Sequence[Outcome]) -> list[str]:
    told = ("valid", "valid but for samples", "refused", "wrongly refused", "not refused")
    names = ("asked", "variant", "runs", *told, "other", "CPU s, mean", "longest")
    lines = ["| " + " | ".join(names) + " |", "|--:|---|" + "--:|" * (len(names) - 2)]
    for quads, variant in sorted({(o.quads, o.variant) for o in outcomes}):
        of_kind = [o for o in outcomes if (o.quads, o.variant) == (quads, variant)]
        states = Counter(o.status if o.status in told else "other" for o in of_kind)
        seconds = [o.cpu_seconds for o in of_kind]
        row = [quads, variant, len(of_kind), *(states[name] for name in (*told, "other"))]
        lines.append(f"| {' | '.join(map(str, row))} | {sum(seconds) / len(seconds):.1f} | {max(seconds):.0f} |")
    return lines


def _cell(outcome: Outcome, column: Column) -> str:
    _, kind, value_of = column
    value = value_of(outcome)
    return "" if value is None else format(value, kind)
