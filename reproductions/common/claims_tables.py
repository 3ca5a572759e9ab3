"""Tables of claims with their findings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Finding,
    Judged,
)
from snowshed._core import InputError
from snowshed.io.csv_table import csv_text, read_csv
from snowshed.plot.html_page import Grid

VERDICTS = (CONTRADICTED, CONFIRMED, UNDECIDED)
COLUMNS = ("source", "claim", "confirmed_if", "verdict", "finding")


def claims_grid(claims: Sequence[Judged], author: str) -> Grid:
    """Return claims and findings, contradictions first; `author` heads what the claims say."""
    ordered = sorted(claims, key=lambda one: VERDICTS.index(one.finding.verdict))
    rows = [[one.finding.verdict, one.source, one.text, one.finding.sentence] for one in ordered]
    return Grid(["verdict", "section", author, "here"], rows, "llll")


def rules_grid(claims: Sequence[Claim[Any]]) -> Grid:
    """Return when each claim counts as confirmed."""
    rows = [[one.source, one.text, one.rule] for one in claims]
    return Grid(["section", "claim", "confirmed if"], rows, "lll")


def claims_csv(claims: Sequence[Judged]) -> str:
    """Return claims and findings as CSV."""
    import pandas as pd

    rows = [
        (one.source, one.text, one.rule, one.finding.verdict, one.finding.sentence)
        for one in claims
    ]
    return csv_text(pd.DataFrame(rows, columns=list(COLUMNS)))


def read_claims(path: Path) -> list[Judged]:
    """Return claims and findings from a file that `claims_csv` made.

    Raises
    ------
    InputError
        If the file is not such a table.
    """
    table = read_csv(path, as_text=True)
    if tuple(table.columns) != COLUMNS or not table["verdict"].isin(VERDICTS).all():
        raise InputError(f"{path}: no table of claims; its columns are {', '.join(COLUMNS)}")
    return [
        Judged(source, claim, rule, Finding(verdict, finding))
        for source, claim, rule, verdict, finding in table.itertuples(index=False)
    ]
