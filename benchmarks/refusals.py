"""Which models are to be refused, and for what: any other refusal is a failure, and so is a result where one was due."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

from runs import Outcome

EXPECTED = Path(__file__).with_name("expected_refusals.csv")


def expected_refusals(path: Path = EXPECTED) -> dict[str, str]:
    """The code for each model that is to be refused."""
    with path.open(newline="") as file:
        return {row["model"]: row["code"] for row in csv.DictReader(file)}


def refusal_code(outcome: Outcome) -> str:
    """For what a model was refused."""
    return str(outcome.report.get("code") or "unreadable")


def as_expected(outcome: Outcome, code: str | None) -> Outcome:
    """An outcome with the status that it has beside what was expected; what is stored knows nothing of that, so that stored
    results are always held against the table as it is now.

    Parameters
    ----------
    code : str or None
        Of the refusal that is due, empty where none is; None where nothing is known of a model.
    """
    status = outcome.status
    if code is None:
        status = outcome.report.get("status", "input_error") if status == "refused" else status
    elif status in ("refused", "input_error", "unreadable_file"):
        status = status if refusal_code(outcome) == code else "wrongly refused"
    elif code and outcome.has_mesh:
        status = "not refused"
    return replace(outcome, status=status)
