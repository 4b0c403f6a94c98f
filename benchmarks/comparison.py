"""Results of this package and of peers side by side: a table, and what of the targets is reached."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from runs import Outcome
from stored_peers import StoredResult

BEST_PEER = "QuadWild-BiMDF"


@dataclass(frozen=True)
class Result:
    """What a program made of a model, by the judge. Distances in percent of the diagonal."""

    program: str
    status: str  # "valid", "invalid" or why there is no mesh
    here: bool  # run on this machine, not taken from the stored figures
    failed: tuple[str, ...] = ()
    quads: int | None = None
    irregular: int | None = None
    jacobian_mean: float | None = None
    jacobian_p1: float | None = None
    jacobian_min: float | None = None
    distance: float | None = None  # mean of both directions
    largest: float | None = None  # of both directions
    feature: float | None = None
    seconds: float | None = None
    singularities: int | None = None  # of the field, where the program says

    @property
    def is_valid(self) -> bool:
        return self.status == "valid"


@dataclass(frozen=True)
class Case:
    """A model at a number of quads; the first result is this package's."""

    model: str
    quads: int
    is_cad: bool
    chord: float  # error of even quads' edges on curved features, in percent of the diagonal
    results: Sequence[Result]
    as_many: Result | None = None  # this package's for as many quads as the best peer's result has

    @property
    def ours(self) -> Result:
        return self.results[0]

    @property
    def name(self) -> str:
        return f"{self.model} {self.quads}"

    def best_peer(self) -> Result | None:
        """The stored result that irregular vertices and features are measured by, where it is valid."""
        found = [r for r in self.results if r.program == BEST_PEER and r.is_valid]
        return found[0] if found else None


def from_outcome(program: str, outcome: Outcome) -> Result:
    """A result of a run on this machine."""
    said = outcome.judgement
    if "scaled_jacobian" not in said:
        return Result(program, outcome.status, True, tuple(outcome.failed), seconds=outcome.seconds)
    jacobian = said["scaled_jacobian"]
    distance = said.get("distance_pct", {})
    return Result(
        program,
        outcome.status,
        True,
        tuple(outcome.failed),
        quads=said["faces"],
        irregular=said["irregular"],
        jacobian_mean=jacobian["mean"],
        jacobian_p1=jacobian["p1"],
        jacobian_min=jacobian["min"],
        distance=distance.get("mean"),
        largest=max(distance["out_to_in_max"], distance["in_to_out_max"]) if distance else None,
        feature=said.get("feature_pct", {}).get("max"),
        seconds=outcome.seconds,
        singularities=outcome.report.get("field_singularities"),
    )


def from_stored(program: str, stored: StoredResult) -> Result:
    """One of the stored figures."""
    return Result(
        program,
        "valid" if stored.valid else "invalid",
        False,
        quads=stored.quads,
        irregular=stored.irregular,
        jacobian_p1=stored.jacobian_p1,
        jacobian_min=stored.jacobian_min,
        distance=stored.distance,
        feature=stored.feature,
        seconds=stored.seconds,
    )


@dataclass(frozen=True)
class Target:
    """One line of what must be reached."""

    text: str
    reached: str
    is_met: bool
    misses: Sequence[str]


def page(cases: Sequence[Case]) -> tuple[str, bool]:
    """The page, and whether all targets are met."""
    targets = [target for make in _TARGETS for target in make(cases)]
    lines = ["| target | reached | met | missed by |", "|---|---|---|---|"]
    for t in targets:
        lines.append(f"| {t.text} | {t.reached} | {'yes' if t.is_met else '**no**'} | {', '.join(t.misses) or '-'} |")
    lines += ["", *_table(cases)]
    return "\n".join(lines) + "\n", all(t.is_met for t in targets)


def _table(cases: Sequence[Case]) -> list[str]:
    programs = list(dict.fromkeys(result.program for case in cases for result in case.results))
    lines = [
        "A cell: valid? · quads · irregular vertices (S: singularities of the field) · scaled Jacobian mean/p1/min · "
        "mean distance % · f largest feature distance % · seconds. *Chord*: error of even quads' edges on curved features, %.",
        "",
        "| model | CAD | asked | chord | " + " | ".join(programs) + " |",
        "|---|---|--:|--:|" + "---|" * len(programs),
    ]
    for case in cases:
        by_program = {result.program: result for result in case.results}
        cells = [_cell(by_program[name]) if name in by_program else "" for name in programs]
        cad = "yes" if case.is_cad else ""
        lines.append(f"| {case.model} | {cad} | {case.quads} | {case.chord:.2f} | " + " | ".join(cells) + " |")
    return lines


def _cell(result: Result) -> str:
    if result.quads is None:
        return result.status
    head = (
        "" if result.is_valid else "**invalid**" + (f" ({', '.join(result.failed)})" if result.failed else "") + " · "
    )
    field = "" if result.singularities is None else f" (S {result.singularities})"
    jacobian = "/".join(_number(x, ".2f") for x in (result.jacobian_mean, result.jacobian_p1, result.jacobian_min))
    feature = "" if result.feature is None else f" · f {result.feature:.2f}"
    return (
        f"{head}{result.quads} · {result.irregular}{field} · {jacobian} · {_number(result.distance, '.3f')}{feature}"
        f" · {_number(result.seconds, '.1f')} s"
    )


def _number(value: float | None, kind: str) -> str:
    return "-" if value is None else format(value, kind)


def _made(cases: Sequence[Case]) -> list[Case]:
    return [case for case in cases if case.ours.quads is not None]


def _share(text: str, cases: Sequence[Case], is_good: Callable[[Case], bool], least: float) -> Target:
    """That of some cases a part is good."""
    bad = [case.name for case in cases if not is_good(case)]
    share = 1 - len(bad) / len(cases) if cases else 1.0
    return Target(text, f"{len(cases) - len(bad)} of {len(cases)} ({share:.0%})", share >= least, bad)


def _validity(cases: Sequence[Case]) -> list[Target]:
    return [_share("valid in every run", cases, lambda c: c.ours.is_valid, 1.0)]


def _irregular(cases: Sequence[Case]) -> list[Target]:
    beside = [(case, peer) for case in _made(cases) if (peer := case.best_peer()) is not None]
    allowed = {case.name: peer.irregular or 0 for case, peer in beside}
    compared = [case for case, _ in beside]
    of_field = [case for case in _made(cases) if case.ours.singularities is not None]
    targets = [
        _share(
            f"irregular vertices ≤ {BEST_PEER}'s on 70 % of its valid models",
            compared,
            lambda c: (c.ours.irregular or 0) <= allowed[c.name],
            0.7,
        ),
        _share(
            f"irregular vertices never > 1.5 × {BEST_PEER}'s",
            compared,
            lambda c: (c.ours.irregular or 0) <= 1.5 * allowed[c.name],
            1.0,
        ),
    ]

    def excess(case: Case) -> float:
        return (case.ours.irregular or 0) - (1.1 * (case.ours.singularities or 0) + 2)

    if of_field:
        middle = median(excess(case) for case in of_field)
        misses = [case.name for case in of_field if excess(case) > 0]
        text = "irregular vertices ≤ 1.1 × field singularities + 2 in the median"
        targets.append(
            Target(text, f"median excess {middle:.1f}, {len(misses)} of {len(of_field)} above", middle <= 0, misses)
        )
    return targets


def _shape(cases: Sequence[Case]) -> list[Target]:
    made = _made(cases)
    if not made:
        return []
    targets = []
    for name, least in (("mean", 0.97), ("p1", 0.75), ("min", 0.3)):
        values = {case.name: float(getattr(case.ours, f"jacobian_{name}")) for case in made}
        middle = median(values.values())
        misses = [f"{case} ({value:.2f})" for case, value in values.items() if value < least]
        text = f"scaled Jacobian {name} ≥ {least} in the median model"
        targets.append(Target(text, f"{middle:.3f}", middle >= least, misses))
    return [
        *targets,
        _share("scaled Jacobian min > 0 in every model", made, lambda c: (c.ours.jacobian_min or 0) > 0, 1.0),
    ]


def _features(cases: Sequence[Case]) -> list[Target]:
    cad = [case for case in _made(cases) if case.is_cad and case.ours.feature is not None]
    beside = [case for case in cad if (peer := case.best_peer()) is not None and peer.feature is not None]

    def its(case: Case) -> Any:
        peer = case.best_peer()
        return peer.feature if peer else None

    def is_as_near(case: Case, ours: Result) -> bool:
        # The stored figures have two digits.
        return ours.is_valid and (ours.feature or 0) <= its(case) + 0.005

    text = f"feature Hausdorff ≤ {BEST_PEER}'s on 80 % of the CAD models"
    against_peer = [_share(text, beside, lambda c: is_as_near(c, c.ours), 0.8)]
    as_many = [case for case in beside if case.as_many is not None]
    if as_many:  # more quads have shorter chords
        text += ", ours with as many quads"
        against_peer.append(_share(text, as_many, lambda c: is_as_near(c, c.as_many or c.ours), 0.8))
    far = [f"{c.name} ({c.ours.feature:.2f} > 1.5 × {c.chord:.2f})" for c in cad if (c.ours.feature or 0) > _most(c)]
    reached = f"{len(cad) - len(far)} of {len(cad)}"
    return [*against_peer, Target("feature Hausdorff ≤ 1.5 × chord error everywhere", reached, not far, far)]


def _most(case: Case) -> float:
    """1.5 times the chord error; a hundredth of a percent where features are straight, for the judge's samples."""
    return max(1.5 * case.chord, 0.01)


def _distance(cases: Sequence[Case]) -> list[Target]:
    """Of both directions' means, and the largest (which the stored figures lack)."""

    def least(case: Case, what: str, among: Callable[[Result], bool]) -> float | None:
        found = [getattr(r, what) for r in case.results[1:] if getattr(r, what) is not None and among(r)]
        return min(found) if found else None

    targets = []
    for name, what, kind, among in (
        ("mean", "distance", "valid mesh", lambda r: r.is_valid),
        ("mean", "distance", "mesh, valid or not,", lambda r: True),
        ("largest", "largest", "valid mesh", lambda r: r.is_valid),
    ):
        compared = {case.name: least(case, what, among) for case in _made(cases)}
        beside = [case for case in _made(cases) if compared[case.name] is not None]
        targets.append(
            _share(
                f"{name} distance ≤ that of every peer's {kind} on 80 % of the models",
                beside,
                lambda c, what=what, compared=compared: (
                    (getattr(c.ours, what) or 0) <= (compared[c.name] or 0) + 0.0005
                ),
                0.8,
            )
        )
    return targets


_TARGETS = (_validity, _irregular, _shape, _features, _distance)
