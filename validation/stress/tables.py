"""Tables of the report: parameters, outcomes, errors of the balances, and costs."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
import pandas as pd

from validation.stress.judge import (
    ENERGY_BOUND,
    GAIN_BOUND,
    MASS_BOUND,
    OUTCOMES,
    SWING_BOUND,
)
from validation.stress.space import KINDS, PARAMETERS, Parameter, Range

#: Largest number of failures that are printed in full.
MAX_FAILURES = 50


@dataclass(frozen=True)
class SummaryTable:
    """Table for the report.

    Parameters
    ----------
    name, title:
        Key and heading.
    remark:
        A paragraph on the columns and their meaning.
    frame:
        The table, with units in the names of its columns.
    """

    name: str
    title: str
    remark: str
    frame: pd.DataFrame


def summarise(frame: pd.DataFrame) -> list[SummaryTable]:
    """Return the tables of the report from the table of `measure.run`."""
    return [
        _parameters(frame),
        _outcomes(frame),
        _errors(frame),
        _balances(frame),
        _cost(frame),
        _savings(frame),
        _failures(frame),
    ]


def _parameters(frame: pd.DataFrame) -> SummaryTable:
    rows = [_parameter_row(p, frame) for p in PARAMETERS]
    remark = (
        "Each parameter is set to its extremes about the reference scene, all pairs of extremes "
        "occur in the covering array, and random runs draw from the whole range (log-uniform "
        "where it spans decades). Scenes: "
        + "; ".join(f"{kind}, {what}" for kind, what in KINDS.items())
        + "."
    )
    return SummaryTable("parameters", "What was varied", remark, pd.DataFrame(rows))


def _parameter_row(parameter: Parameter, frame: pd.DataFrame) -> dict[str, object]:
    failed = frame[frame.outcome == "failed"]
    reference = parameter.levels[0]
    row: dict[str, object] = {"parameter": parameter.title}
    if isinstance(parameter, Range):
        low, high = frame[parameter.name].min(), frame[parameter.name].max()
        row["range tried"] = f"{low:.4g} to {high:.4g} {parameter.unit}".strip()
        row["drawn"] = "log-uniform" if parameter.log else "uniform"
    else:
        row["range tried"] = ", ".join(str(level) for level in parameter.levels)
        row["drawn"] = "each alike"
    row["reference"] = f"{reference:.4g}" if isinstance(reference, float) else str(reference)
    row["runs off the reference"] = int((frame[parameter.name] != reference).sum())
    row["failed of those"] = int((failed[parameter.name] != reference).sum())
    return row


def _outcomes(frame: pd.DataFrame) -> SummaryTable:
    counts = pd.crosstab(frame.outcome, frame.design)
    counts = counts.reindex(list(OUTCOMES), fill_value=0)
    designs = [d for d in ("reference", "single", "pairwise", "random") if d in counts]
    counts = counts[designs]
    counts["all"] = counts.sum(axis=1)
    counts.insert(0, "meaning", [OUTCOMES[name] for name in counts.index])
    remark = "Every run ends in one of these ways; none may fail."
    return SummaryTable("outcomes", "How runs ended", remark, counts.reset_index())


def _errors(frame: pd.DataFrame) -> SummaryTable:
    """Return a table of messages and their counts; messages may differ in numbers."""
    wrong = frame[frame.outcome.isin(["refused", "stopped"])]
    kinds = wrong.message.str.replace(r"-?\d+(\.\d+)?(e[+-]?\d+)?", "#", regex=True)
    grouped = wrong.groupby([wrong.outcome, kinds.rename("kind")])
    table = grouped.message.agg(["size", "first"]).reset_index().drop(columns="kind")
    table = table.rename(columns={"size": "runs", "first": "message (first of its kind)"})
    remark = "Messages of runs that stopped early."
    return SummaryTable("errors", "Errors", remark, table.sort_values("runs", ascending=False))


def _balances(frame: pd.DataFrame) -> SummaryTable:
    ran = frame[frame.outcome.isin(["rest", "time_limit", "step_limit", "stopped"])]
    measures = {
        "mass_error": ("mass, change", f"{MASS_BOUND:g}"),
        "momentum_error": ("momentum in free flight, error", "rounding x steps"),
        "energy_error": ("energy, stored + spent - brought in", f"{ENERGY_BOUND:g}"),
        "energy_gain": ("the same where positive", ""),
        "stored_excess": ("motion and elastic strain above what came in", f"{SWING_BOUND:g}"),
        "final_excess": ("the same at the end", f"{GAIN_BOUND:g}"),
    }
    rows = []
    for name, (title, bound) in measures.items():
        for transfer, group in ran.groupby("transfer"):
            values = group[name].dropna()
            if values.empty:
                continue
            row: dict[str, object] = {"balance": title, "transfer": transfer, "runs": len(values)}
            for label, q in (("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("largest", 1.0)):
                row[label] = f"{max(float(values.quantile(q)), 0.0):.2g}"
            rows.append({**row, "bound": bound})
    remark = (
        "Largest error of each run, measured every 16 steps. Energy is relative to the whole input "
        "by thrown snow and work of gravity, momentum to the sum of all momenta. The last "
        "rows matter most: they show energy without a source. The error of the balance is of first "
        "order in the time step; it is largest where few steps cover the whole motion, in soft "
        "snow, and in blows at many times the speed of sound in the snow."
    )
    return SummaryTable("balances", "Mass, momentum and energy", remark, pd.DataFrame(rows))


def _cost(frame: pd.DataFrame) -> SummaryTable:
    ran = frame[frame.outcome.isin(["rest", "time_limit", "step_limit"])]
    decade = np.floor(np.log10(ran.youngs_modulus.clip(upper=9.999e8))).astype(int)
    rows = []
    for power, group in ran.groupby(decade):
        rows.append(
            {
                "E, Pa": f"1e{power} to 1e{power + 1}",
                "runs": len(group),
                "steps": int(group.steps.sum()),
                "rejected steps": int(group.rejected.sum()),
                "smallest step, s": f"{group.smallest_dt_s.min():.2g}",
                "smallest over first step": f"{_shortening(group).min():.2g}",
                "energy error, median": f"{group.energy_error.median():.2g}",
                "wall time, s": round(float(group.wall_s.sum()), 1),
                "us per update": round(1e6 * group.wall_s.sum() / group.updates.sum(), 2),
            }
        )
    remark = (
        "Rows by Young's modulus. The elastic wave and the initial speed of the snow limit the "
        "first step. Steps become shorter if snow gets faster, or if a step is rejected because it "
        "would strain a particle beyond the limit. Wall times are those of tiny scenes, in which "
        "the fixed cost of a step dominates."
    )
    return SummaryTable("cost", "Time steps and cost", remark, pd.DataFrame(rows))


def _shortening(frame: pd.DataFrame) -> pd.Series[float]:
    return frame.smallest_dt_s / frame.first_dt_s


def _savings(frame: pd.DataFrame) -> SummaryTable:
    ran = frame[frame.outcome.isin(["rest", "time_limit", "step_limit"])]
    fixed = np.ceil(ran.time_s / ran.smallest_dt_s)
    speed = pd.cut(ran.speed, [0, 1, 10, 101], labels=["below 1", "1 to 10", "10 to 100"])
    rows = []
    for label, group in ran.groupby(speed, observed=True):
        steps, needed = group.steps, fixed[group.index]
        rows.append(
            {
                "speed, m/s": label,
                "runs": len(group),
                "with a rejected step": int((group.rejected > 0).sum()),
                "rejections per step": f"{group.rejected.sum() / steps.sum():.2g}",
                "steps taken": int(steps.sum()),
                "steps at the smallest of each run": int(needed.sum()),
                "saved": f"{1 - steps.sum() / needed.sum():.0%}",
                "saved, best run": f"{1 - (steps / needed).min():.0%}",
            }
        )
    remark = (
        "A fixed step that is safe must be the smallest that a run needs anywhere; the table "
        "compares the steps taken with the steps such a run would have taken for the same time, "
        "had one known that step beforehand. A rejected step costs the grid's part only: "
        "particles have not moved yet. At rest the step is back at the limit of the elastic wave, "
        "which explicit integration cannot exceed; the cost of rest itself is saved by ending the "
        "event."
    )
    return SummaryTable(
        "savings", "What adaptive and rejected steps save", remark, pd.DataFrame(rows)
    )


def _failures(frame: pd.DataFrame) -> SummaryTable:
    failed = frame[frame.outcome == "failed"].head(MAX_FAILURES)
    names = [p.name for p in PARAMETERS]
    rows = pd.DataFrame(
        {
            "design": failed.design,
            "reason": failed.reason,
            "point": [json.dumps(_plain(row)) for _, row in failed[names].iterrows()],
        }
    )
    remark = "Failed runs, with the point from which `solve` repeats each; empty if all is well."
    return SummaryTable("failures", "Failures", remark, rows)


def _plain(row: pd.Series[float]) -> dict[str, object]:
    return {str(k): v.item() if isinstance(v, np.generic) else v for k, v in row.items()}
