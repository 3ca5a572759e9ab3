"""The tables of section 5.3: scores, quartiles, errors, cost, and the linear model's expression."""

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

#: Table 5.3.1: quartiles of the predicted ratio, the last one the largest value.
THESIS_QUARTILES: Mapping[str, tuple[float, ...]] = {
    "rbf": (0.057, 0.092, 0.142, 0.240),
    "linear": (0.064, 0.101, 0.139, 0.255),
}
#: Table 5.3.2: mean absolute error of the ratio, and its standard deviation.
THESIS_ERRORS: Mapping[str, tuple[float, float]] = {
    "rbf": (0.004, 0.005),
    "linear": (0.015, 0.013),
}
QUARTILES = ("Q1", "Q2", "Q3", "Q4")
#: The thesis's claims as bounds: the largest mean absolute error of the RBF kernel, the smallest
#: ratio of the linear kernel's error to it, and the largest relative error of quartiles. They hold
#: for a data set with this number of rows only.
THESIS_ROWS = 610
LARGEST_RBF_ERROR, LINEAR_WORSE, QUARTILES_OFF = 0.004, 2.5, 0.20

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


def quartile_table(elected: Elected, values: Floats, target: str) -> pd.DataFrame:
    """Return Table 5.3.1: quartiles of the mean predictions, of the data, and the thesis's."""
    import pandas as pd

    rows = {"data": quartiles(values)}
    for kind, results in elected.items():
        rows[kind] = quartiles(mean_prediction(results))
        if target == "ratio" and kind in THESIS_QUARTILES:
            rows[f"{kind}, thesis"] = THESIS_QUARTILES[kind]
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
    """Return Table 5.3.2 with additions: errors on rows and panels that were not trained on.

    Parameters
    ----------
    elected, data, target
        The folds' results by kind of model, and their task.
    unseen
        Errors on unseen panels, by kind of model.
    """
    import pandas as pd

    values, scatter = data.targets[target], data.scatter(target)
    rows = []
    for kind, results in elected.items():
        errors = np.abs([result.predictions - values for result in results])
        thesis = THESIS_ERRORS.get(kind) if target == "ratio" else None
        panels = np.abs(unseen[kind]) if kind in unseen else None
        rows.append(
            {
                "model": kind,
                "mean_absolute_error": errors.mean(),
                "standard_deviation": errors.std(),
                "thesis_error": np.nan if thesis is None else thesis[0],
                "thesis_deviation": np.nan if thesis is None else thesis[1],
                "relative_error": errors.mean() / np.median(mean_prediction(results)),
                "thesis_relative_error": np.nan if thesis is None else thesis_relative_error(kind),
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


def thesis_relative_error(kind: str) -> float:
    """Return the thesis's mean absolute error over its median prediction.

    Examples
    --------
    >>> round(thesis_relative_error("rbf"), 3)
    0.043
    """
    return THESIS_ERRORS[kind][0] / THESIS_QUARTILES[kind][1]


def thesis_checks(quartiles: pd.DataFrame, errors: pd.DataFrame) -> list[str]:
    """Return verdicts on the claims of section 5.3.2 about the ratio.

    Parameters
    ----------
    quartiles, errors
        Tables of the ratio from `quartile_table` and `error_table`.
    """
    checks = []
    error = errors["mean_absolute_error"]
    if "rbf" in error:
        rbf = float(error["rbf"])
        checks.append((rbf <= LARGEST_RBF_ERROR, f"RBF error {rbf:.4f}, "
                       f"at most {LARGEST_RBF_ERROR}"))  # fmt: skip
        part, most = float(errors["relative_error"]["rbf"]), thesis_relative_error("rbf")
        checks.append((part <= most, f"RBF error {part:.1%} of the median prediction, "
                       f"at most {most:.1%}"))  # fmt: skip
        if "linear" in error:
            times = float(error["linear"]) / rbf
            checks.append((times >= LINEAR_WORSE, f"linear error {times:.1f} times the RBF's, "
                           f"at least {LINEAR_WORSE}"))  # fmt: skip
    for kind in (kind for kind in THESIS_QUARTILES if kind in quartiles.index):
        ours = quartiles.loc[kind].to_numpy(dtype=float)
        off = float(np.abs(ours / np.array(THESIS_QUARTILES[kind]) - 1).max())
        checks.append((off <= QUARTILES_OFF, f"{kind} quartiles off by up to {off:.0%} from "
                       f"Table 5.3.1, at most {QUARTILES_OFF:.0%}"))  # fmt: skip
    lines = [f"{'holds' if good else 'DOES NOT HOLD'}: {claim}" for good, claim in checks]
    most = int(errors["most_seeds"].max())
    if most > 1:
        lines.append(
            f"note: the rows are means of up to {most} stacks, the thesis's are single stacks, "
            "which scatter more; --one-seed compares like with like"
        )
    return lines


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
