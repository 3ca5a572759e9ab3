"""The output of the reproduction: one bar over all stages, and the verdicts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from snowshed.cli.display.study import SPEED_PERIOD_S, in_words
from snowshed.cli.terminal import one_bar, plain_table, wide_console
from thesis.claims.hypothesis_tests import CONTRADICTED, UNDECIDED, Judged
from thesis.reproduction import Progress, Reporter

WIDTH = 140  # columns, of what is not a terminal
STYLES = {CONTRADICTED: "bold red", UNDECIDED: "dim"}


@contextmanager
def progress_bar() -> Iterator[Reporter]:
    """Say how long all should take, and show one bar over all stages, on stderr."""
    with one_bar(width=24, speed_period_s=SPEED_PERIOD_S) as bar:

        def report(progress: Progress) -> None:
            if not bar.started:
                expected = in_words(progress.expected_s)
                bar.console.print(f"{progress.stages} stages; expected time: {expected}")
            bar.show(
                progress.fraction, f"stage {progress.stage}/{progress.stages}, {progress.doing}"
            )

        yield report


def print_claims(claims: Sequence[Judged]) -> None:
    """Print the verdicts, and how many there are of each."""
    table = plain_table("Claims of the thesis")
    for title in ("", "section", "claim", "finding"):
        table.add_column(title, no_wrap=not title)
    for one in claims:
        finding = one.finding
        style = STYLES.get(finding.verdict, "none")
        table.add_row(finding.verdict, one.source, one.text, finding.sentence, style=style)
    console = wide_console(WIDTH)
    console.print(table)
    counts = Counter(one.finding.verdict for one in claims)
    console.print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
