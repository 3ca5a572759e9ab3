"""The output of ``snowshed sensitivity``: a line per parameter, a column per event."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from snowshed.analysis.sensitivity.stored import TARGETS
from snowshed.cli.terminal import plain_table, wide_console
from snowshed.plot.labels import label

if TYPE_CHECKING:
    import pandas as pd

WIDE = 0.25  # half of an interval that says little of an index between 0 and 1


def _local(row: Any) -> str:
    doubtful = row["distinct"] is not None and not row["distinct"]
    return f"{row['s']:+.3f} ± {row['standard_error']:.3f}{' ?' if doubtful else '  '}"


def _fixed(row: Any) -> str:
    return f"{row['mean_m']:.3f} ± {row['deviation_m']:.3f}"


def _shares(row: Any) -> str:
    return f"{row['first']:+.2f} / {row['total']:.2f}"


def _effects(row: Any) -> str:
    return f"{row['strength']:.3f} ± {row['strength_interval']:.3f}"


CELLS: Mapping[str, tuple[str, Callable[[Any], str]]] = {
    "s": ("Index S ± standard error by seeding noise", _local),
    "fixation": ("Mean ± standard deviation over the others, m", _fixed),
    "sobol": ("First order / total Sobol index", _shares),
    "morris": ("Strength μ* of effects ± 95 %, part of the mean", _effects),
}
NOTES = {
    "s": "? may be noise: zero lies within 1.96 standard errors",
    "fixation": "the seeding alone: see noise.csv",
    "sobol": "the total index of the seeding is what noise explains: no effect below it",
    "morris": "the strength of the seeding is noise: no effect below it",
}


def print_table(method: str, table: pd.DataFrame) -> None:
    """Print a method's table."""
    title, cell = CELLS[method]
    events = list(dict.fromkeys(table["event"]))
    console = wide_console()
    for target in TARGETS:
        shown = plain_table(f"{title}: {target}")
        shown.add_column("parameter", no_wrap=True)
        for event in events:
            shown.add_column(f"event {event}", justify="right", no_wrap=True)
        rows = table[table["target"] == target]
        keys = ["parameter", *(["value"] if "value" in table else [])]
        for key, of_key in rows.groupby(keys, sort=False):
            by_event = {row["event"]: cell(row) for _, row in of_key.iterrows()}
            shown.add_row(_name(key), *(by_event.get(event, "") for event in events))
        console.print(shown)
    console.print(f" {NOTES[method]}")
    if method == "sobol" and table["total_interval"].median() > WIDE:
        blocks = int(table["blocks"].min())
        console.print(
            f" {blocks} blocks are too few: the 95 % intervals are wider than the indices"
        )


def _name(key: Any) -> str:
    path, *value = key
    known = label(path)
    return " ".join([known.symbol, *(known.quantity(one) for one in value)])
