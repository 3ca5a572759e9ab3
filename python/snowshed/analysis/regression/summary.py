"""The tables of a regression: scores, quartiles, errors, cost, and the linear expression."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from snowshed.analysis.regression.ensemble import Ensemble
from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.nested import Results
from snowshed.analysis.regression.rows import TARGETS, StackRows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.base.arrays import Floats

if TYPE_CHECKING:
    import pandas as pd

QUARTILES = ("Q1", "Q2", "Q3", "Q4")

Elected = Mapping[str, Sequence[FoldResult]]


def elected_models(results: Results, target: str) -> dict[str, list[FoldResult]]:
    """Return for each kind of model the results of its folds, in order."""
    by_kind: dict[str, list[FoldResult]] = {}
    for task, result in results.items():
        if task.target == target:
            by_kind.setdefault(task.kind, []).append(result)
    return by_kind


def score_table(results: Results) -> pd.DataFrame:
    """Return one row per outer fold: scores, hyper-parameters, fits and processor time."""
    import pandas as pd

    return pd.DataFrame(
        [
            {
                "target": task.target,
                "model": task.kind,
                "round": task.round + 1,
                "fold": task.fold + 1,
                "inner_score": result.inner_score,
                "development_score": result.development_score,
                "validation_score": result.validation_score,
                "fits": result.fits,
                "cpu_s": result.elapsed_s,
                **result.parameters,
            }
            for task, result in results.items()
        ]
    )


def mean_prediction(results: Sequence[FoldResult]) -> Floats:
    """Return the mean of the models' predictions for each row."""
    return np.asarray(np.mean([result.predictions for result in results], axis=0))


def held_out_errors(results: Sequence[FoldResult], values: Floats) -> Floats:
    """Return the errors of every model on the rows that it never saw."""
    return np.concatenate([result.held_out - values[result.validation] for result in results])


def quartile_table(elected: Elected, values: Floats) -> pd.DataFrame:
    """Return quartiles of the data and of mean predictions."""
    import pandas as pd

    rows = {"data": quartiles(values)}
    for kind, results in elected.items():
        rows[kind] = quartiles(mean_prediction(results))
    table = pd.DataFrame.from_dict(rows, orient="index", columns=list(QUARTILES))
    return table.rename_axis("model")


def quartiles(values: Floats) -> tuple[float, ...]:
    """Return the quartiles of numbers, the last one the largest.

    Examples
    --------
    >>> quartiles(np.arange(5.0))
    (1.0, 2.0, 3.0, 4.0)
    """
    return tuple(float(value) for value in np.quantile(values, (0.25, 0.5, 0.75, 1.0)))


def error_table(
    elected: Elected, data: StackRows, target: str, unseen: Mapping[str, Floats]
) -> pd.DataFrame:
    """Return the errors on all rows, on unseen rows and on unseen panels.

    Parameters
    ----------
    elected, data, target
        The folds' results by kind of model, and the data and the target of the folds.
    unseen
        Errors on unseen panels, by kind of model.
    """
    import pandas as pd

    values, scatter = data.targets[target], data.scatter(target)
    rows = []
    for kind, results in elected.items():
        errors = np.abs([result.predictions - values for result in results])
        panels = np.abs(unseen[kind]) if kind in unseen else None
        rows.append(
            {
                "model": kind,
                "mean_absolute_error": errors.mean(),
                "standard_deviation": errors.std(),
                "relative_error": errors.mean() / np.median(mean_prediction(results)),
                "most_seeds": data.most_seeds,
                "held_out_error": np.abs(held_out_errors(results, values)).mean(),
                "unseen_panel_error": np.nan if panels is None else panels.mean(),
                "seeding_scatter": scatter,
                "validation_score": np.mean([result.validation_score for result in results]),
                "fits": sum(result.fits for result in results),
                "cpu_s": sum(result.elapsed_s for result in results),
            }
        )
    return pd.DataFrame(rows).set_index("model")


def linear_expression(results: Sequence[FoldResult], rows: StackRows, target: str) -> str:
    """Return the mean linear model as a formula in the inputs' units."""
    ensemble = Ensemble.of(results)
    values = rows.targets[target]
    inputs = Scaling.of(rows.inputs)
    weights = (ensemble.coefficients @ ensemble.points).mean(axis=0) * values.std()
    slopes = weights / inputs.deviation
    offset = ensemble.intercepts.mean() * values.std() + values.mean() - slopes @ inputs.mean
    terms = " ".join(f"{slope:+.4g} {name}" for slope, name in zip(slopes, rows.names))
    unit = f", {TARGETS[target]}" if TARGETS[target] else ""
    return f"{target} = {offset:.4g} {terms}{unit}"
