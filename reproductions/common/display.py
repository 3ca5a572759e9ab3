"""The output of the reproduction: one bar over all stages, and the verdicts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Optional

from reproductions.common.hypothesis_tests import CONTRADICTED, UNDECIDED, JudgedClaim
from snowshed.base.formatting import about
from snowshed.base.progress import Progress, Reporter
from snowshed.cli.output import progress as bar
from snowshed.cli.output.terminal import plain_table, wide_console

WIDTH = 140  # columns of output that is not a terminal
STYLES = {CONTRADICTED: "bold red", UNDECIDED: "dim"}


def progress_bar(*, quiet: bool) -> AbstractContextManager[Optional[Reporter]]:
    """Print the expected time, and show one bar over all stages, on stderr."""
    return bar.progress_bar(
        quiet=quiet, announce=_announcement, speed_period_s=bar.LONG_PERIOD_S, width=24
    )


def _announcement(progress: Progress) -> str:
    expected = about(progress.expected_s or 0.0)
    return f"{progress.count} stages; expected time: {expected}"


def print_claims(claims: Sequence[JudgedClaim], author: str) -> None:
    """Print the verdicts on an author's claims, and their numbers."""
    table = plain_table(f"Claims of {author}")
    for title in ("", "section", "claim", "finding"):
        table.add_column(title, no_wrap=not title)
    for claim in claims:
        finding = claim.finding
        style = STYLES.get(finding.verdict, "none")
        table.add_row(finding.verdict, claim.source, claim.text, finding.sentence, style=style)
    console = wide_console(WIDTH)
    console.print(table)
    counts = Counter(claim.finding.verdict for claim in claims)
    console.print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
