"""The output of ``snowshed calibrate``: the best parameter sets, and ranges of the parameters."""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.table import Table

from snowshed.analysis.calibration.misfit import RANKED
from snowshed.analysis.calibration.report import Calibration
from snowshed.cli.terminal import plain_table, wide_console
from snowshed.plot.labels import label

SHOWN = 5  # parameter sets
POOR = 0.5  # part of the runs' variance that a surrogate should explain
OPEN = {
    "below": "open below",
    "above": "open above",
    "both": "undecided",
    "": "",
}


def print_calibration(found: Calibration) -> None:
    """Print the ranking, the ranges, and notes on their limits."""
    console = wide_console()
    console.print(_ranking(found))
    console.print(_ranges(found))
    worst, worth = found.posterior.diagnostics["r_hat"].max(), found.posterior.effective
    console.print(f" chains: ESS {worth:.0f} or more, r_hat {worst:.3f} or less")
    if any(found.ranges["open"]):
        console.print(" open, undecided: the range goes on beyond the grid")
    for warning in warnings(found):
        console.print(f" note: {warning}")


def _ranking(found: Calibration) -> Table:
    paths = found.stacks.parameters
    measured = [q for q in RANKED if f"{q}_rmse_m" in found.ranked]
    headings = ["rank", *(label(path).axis for path in paths)]
    headings += [f"{q}\nRMSE, m" for q in measured] + [f"{q}\nerror" for q in measured]
    shown = plain_table(
        "Parameter sets by mean rescaled RMSE", [*headings, "rescaled\nRMSE"], padding=(0, 1)
    )
    for _, row in found.ranked.head(SHOWN).iterrows():
        cells = [f"{row['rank']:.0f}", *(label(path).value(row[path]) for path in paths)]
        cells += [f"{row[f'{q}_rmse_m']:.4f}" for q in measured]
        cells += [f"{100 * row[f'{q}_relative_error']:+.1f} %" for q in measured]
        shown.add_row(*cells, f"{row['rescaled_rmse']:.3f}")
    return shown


def _ranges(found: Calibration) -> Table:
    headings = ["parameter", "best set", "median", "68 %", "95 %"]
    shown = plain_table("Parameters that the measurements allow", headings, padding=(0, 1))
    shown.add_column("", no_wrap=True)
    for _, row in found.ranges.iterrows():
        known = label(str(row["parameter"]))
        cells = [known.axis, known.value(row["best_set"]), known.value(row["median"])]
        cells += [_interval(row, level) for level in ("68", "95")]
        shown.add_row(*cells, OPEN[str(row["open"])])
    return shown


def _interval(row: Any, level: str) -> str:
    known = label(str(row["parameter"]))
    ends = (row[f"{end}_{level}"] / known.scale for end in ("lower", "upper"))
    return " to ".join(f"{end:.3g}" for end in ends)


def warnings(found: Calibration) -> list[str]:
    """Return notes on the limits of a calibration."""
    said = []
    if found.stacks.pending:
        said.append(
            f"{found.stacks.pending} runs of the study are not computed yet: ranks and ranges are "
            "those of the others (`snowshed study resume` computes them)"
        )
    missing = len(found.stacks.sets) - len(found.ranked)
    if missing:
        said.append(f"{missing} parameter sets lack measured stacks and are not ranked")
    if not found.posterior.converged:
        said.append("the Markov chains have not converged: the ends of the ranges are uncertain")
    accuracy = found.posterior.surrogate.accuracy()
    poor = accuracy[accuracy["explained"] < POOR]
    if len(poor):
        said.append(
            f"the surrogate explains less than half of the variance of {len(poor)} of "
            f"{len(accuracy)} measured stacks, which says little of the snow (surrogate.csv)"
        )
    for number, quantity in enumerate(found.posterior.quantities):
        median = float(np.median(found.posterior.discrepancy[:, number]))
        said.append(f"error of the model in {quantity}: about {100 * median:.0f} % (median)")
    return said
