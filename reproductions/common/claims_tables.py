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
    JudgedClaim,
)
from snowshed._core import InputError
from snowshed.io.csv_table import csv_text, read_csv
from snowshed.plot.html_page import HtmlTable

VERDICTS = (CONTRADICTED, CONFIRMED, UNDECIDED)
COLUMNS = ("source", "claim", "confirmed_if", "verdict", "finding")


def claims_table(claims: Sequence[JudgedClaim], author: str) -> HtmlTable:
    """Return claims and findings, contradictions first; `author` is the heading of the claims."""
    ordered = sorted(claims, key=lambda claim: VERDICTS.index(claim.finding.verdict))
    rows = [
        [claim.finding.verdict, claim.source, claim.text, claim.finding.sentence]
        for claim in ordered
    ]
    return HtmlTable(["verdict", "section", author, "here"], rows, "llll")


def rules_table(claims: Sequence[Claim[Any]]) -> HtmlTable:
    """Return the rule of each claim."""
    rows = [[claim.source, claim.text, claim.rule] for claim in claims]
    return HtmlTable(["section", "claim", "confirmed if"], rows, "lll")


def claims_csv(claims: Sequence[JudgedClaim]) -> str:
    """Return claims and findings as CSV."""
    import pandas as pd

    rows = [
        (claim.source, claim.text, claim.rule, claim.finding.verdict, claim.finding.sentence)
        for claim in claims
    ]
    return csv_text(pd.DataFrame(rows, columns=list(COLUMNS)))


def read_claims(path: Path) -> list[JudgedClaim]:
    """Return claims and findings from a file that `claims_csv` made.

    Raises
    ------
    InputError
        If the file is not such a table.
    """
    table = read_csv(path, as_text=True)
    if tuple(table.columns) != COLUMNS or not table["verdict"].isin(VERDICTS).all():
        raise InputError(f"{path}: not a table of claims; the columns must be {', '.join(COLUMNS)}")
    return [
        JudgedClaim(source, claim, rule, Finding(verdict, finding))
        for source, claim, rule, verdict, finding in table.itertuples(index=False)
    ]
