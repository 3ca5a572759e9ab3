"""Claims of section 5.3, about the two support vector regressions of H/L."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Estimate,
    Finding,
    all_of,
    is_near,
    is_positive,
    widening,
)
from reproductions.frischholz2023.printed import THESIS_ERRORS, THESIS_QUARTILES, THESIS_ROWS
from snowshed.base.arrays import Floats
from snowshed.base.formatting import percent

if TYPE_CHECKING:
    import pandas as pd

#: "Sub-centimetre": H/L has no unit, so its error is compared with the plain number.
SUB_CENTIMETRE = 0.01
#: Validation score of the RBF kernel in section 5.3.1.
VALIDATION_SCORE = 0.005
#: The linear kernel's validation score over that of the RBF kernel in section 5.3.1.
LINEAR_OVER_RBF = 2.5
#: Quartiles of predictions agree up to this relative difference.
MAX_QUARTILE_DEVIATION = 0.20
#: Two numbers are about equal up to this relative difference.
RELATIVE_TOLERANCE = 0.25


@dataclass(frozen=True)
class RegressionResults:
    """The results of the nested cross-validation for H/L.

    Attributes
    ----------
    rows, panels
        Number of rows of the data, and of panels.
    scores
        One row per outer fold: ``model``, ``round``, ``fold``, ``development_score``,
        ``validation_score``, ``C``.
    errors
        Table 5.3.2, by model: ``mean_absolute_error``, ``standard_deviation``.
    quartiles
        Table 5.3.1, by model: ``Q1`` to ``Q4``.
    """

    rows: int
    panels: int
    scores: pd.DataFrame
    errors: pd.DataFrame
    quartiles: pd.DataFrame


def validation(data: RegressionResults, model: str) -> Estimate:
    """Return the mean validation score of a model, with its standard error over the folds."""
    of_model = _folds(data, model)
    return _mean_over_folds(of_model, of_model["validation_score"].to_numpy(float))


def _folds(data: RegressionResults, model: str) -> pd.DataFrame:
    of_model = data.scores[data.scores["model"] == model]
    if of_model.empty:
        raise LookupError(f"the model {model}")
    return of_model


def _mean_over_folds(of_model: pd.DataFrame, values: Floats) -> Estimate:
    """Return a mean over outer folds, with its standard error.

    Every round splits the same rows again, so only the folds of one round are independent.
    """
    spread = float(values.std(ddof=1)) if len(values) > 1 else math.nan
    folds = len(values) / of_model["round"].nunique()
    return Estimate(float(values.mean()), spread / math.sqrt(folds) * widening(folds - 1))


def overfitting(data: RegressionResults, model: str) -> Estimate:
    """Return the excess of validation scores over those on the development sets."""
    folds = _folds(data, model)
    excess = folds["validation_score"] - folds["development_score"]
    return _mean_over_folds(folds, excess.to_numpy(float))


def mean_error(data: RegressionResults, model: str) -> Estimate:
    """Return the mean absolute error of a model; panels are independent, their events are not."""
    deviation = float(data.errors["standard_deviation"][model])
    error = float(data.errors["mean_absolute_error"][model])
    return Estimate(error, deviation / math.sqrt(data.panels))


def rbf_is_better(data: RegressionResults) -> Finding:
    """Test whether the RBF kernel's median absolute error on validation sets is smaller."""
    lead = validation(data, "linear") - validation(data, "rbf")
    return is_positive(lead, "validation score, linear minus RBF")


def rbf_is_better_by_ratio(data: RegressionResults) -> Finding:
    """Test whether the linear kernel's validation score is about 2.5 times the RBF kernel's."""
    linear, rbf = validation(data, "linear"), validation(data, "rbf")
    ratio = linear.value / rbf.value
    noise = ratio * math.hypot(linear.noise / linear.value, rbf.noise / rbf.value)
    text = "validation score, linear over RBF"
    return is_near(
        Estimate(ratio, noise), LINEAR_OVER_RBF, RELATIVE_TOLERANCE * LINEAR_OVER_RBF, text
    )


def score_agrees(data: RegressionResults) -> Finding:
    """Test whether the RBF kernel's validation score is about 0.005."""
    finding = is_near(
        validation(data, "rbf"),
        VALIDATION_SCORE,
        RELATIVE_TOLERANCE * VALIDATION_SCORE,
        "validation score, RBF",
    )
    return _undecided_unless_all_rows(finding, data)


def rbf_overfits_more(data: RegressionResults) -> Finding:
    """Test whether the RBF kernel loses more from the development sets to the validation sets."""
    more = overfitting(data, "rbf") - overfitting(data, "linear")
    return is_positive(more, "validation minus development score, RBF minus linear")


def linear_chooses_more_widely(data: RegressionResults) -> Finding:
    """Test whether the chosen C varies more for the linear kernel than for the RBF kernel."""
    linear, rbf = (float(np.log10(_folds(data, kernel)["C"]).std()) for kernel in ("linear", "rbf"))
    text = f"deviation of log₁₀ C: {linear:.2f} for the linear kernel, {rbf:.2f} for RBF"
    if linear == rbf or math.isnan(linear + rbf):
        return Finding(UNDECIDED, text)
    return Finding(CONFIRMED if linear > rbf else CONTRADICTED, text)


def is_sub_centimetre(data: RegressionResults) -> Finding:
    """Test whether the RBF models' mean absolute error is below 0.01."""
    error = mean_error(data, "rbf")
    left = Estimate(SUB_CENTIMETRE, 0.0) - error
    return Finding(is_positive(left, "").verdict, f"mean absolute error of H/L: {error.text()}")


def error_agrees(data: RegressionResults, model: str) -> Finding:
    """Test whether a model's mean absolute error is about that of Table 5.3.2."""
    thesis_error = THESIS_ERRORS[model][0]
    text = f"mean absolute error (thesis {thesis_error})"
    finding = is_near(
        mean_error(data, model), thesis_error, RELATIVE_TOLERANCE * thesis_error, text
    )
    return _undecided_unless_all_rows(finding, data)


def quartiles_agree(data: RegressionResults) -> Finding:
    """Test whether the quartiles of the predictions are those of Table 5.3.1."""
    findings = []
    for model, printed in THESIS_QUARTILES.items():
        ours = data.quartiles.loc[model, ["Q1", "Q2", "Q3", "Q4"]].to_numpy(float)
        deviations = np.abs(ours / np.array(printed) - 1)
        scatter = math.hypot(
            data.errors["mean_absolute_error"][model], data.errors["standard_deviation"][model]
        )
        # The largest prediction, Q4, belongs to a single panel, the other quartiles to many.
        noise = scatter / np.array([*[math.sqrt(data.panels)] * 3, 1.0]) / np.array(printed)
        worst = Estimate(float(deviations.max()), float(noise[deviations.argmax()]))
        findings.append(
            is_near(worst, 0.0, MAX_QUARTILE_DEVIATION, f"{model}, worst quartile off by", "%")
        )
    finding = all_of(findings)
    return _undecided_unless_all_rows(finding, data)


def _undecided_unless_all_rows(finding: Finding, data: RegressionResults) -> Finding:
    """Return the finding, or "undecided" if the data do not have as many rows as the thesis's."""
    if data.rows == THESIS_ROWS:
        return finding
    text = f"{finding.sentence}, but of {data.rows} rows, not the thesis's {THESIS_ROWS}"
    return Finding(UNDECIDED, text)


REGRESSION: tuple[Claim[RegressionResults], ...] = (
    Claim(
        "5.3.1",
        "The RBF kernel predicts better than the linear one.",
        "smaller median absolute error on validation sets",
        rbf_is_better,
    ),
    Claim(
        "5.3.1",
        f"The RBF kernel is about {LINEAR_OVER_RBF} times better.",
        f"ratio of validation scores within {percent(RELATIVE_TOLERANCE)} of {LINEAR_OVER_RBF}",
        rbf_is_better_by_ratio,
    ),
    Claim(
        "5.3.1",
        f"The RBF kernel's validation score is about {VALIDATION_SCORE}.",
        f"within {percent(RELATIVE_TOLERANCE)}, for a data set of {THESIS_ROWS} rows",
        score_agrees,
    ),
    Claim(
        "5.3.1",
        "The RBF kernel overfits more.",
        "validation score minus development score larger than for the linear kernel",
        rbf_overfits_more,
    ),
    Claim(
        "Figure 5.3.2",
        "The C that is chosen for the linear kernel varies more.",
        "deviation of log₁₀ C over all folds above that of the RBF kernel (no noise)",
        linear_chooses_more_widely,
    ),
    Claim(
        "5.3",
        "The RBF kernel predicts with sub-centimetre accuracy.",
        f"mean absolute error of H/L below {SUB_CENTIMETRE}",
        is_sub_centimetre,
    ),
    Claim(
        "Table 5.3.2",
        f"The RBF kernel's mean absolute error is {THESIS_ERRORS['rbf'][0]}.",
        f"within {percent(RELATIVE_TOLERANCE)}, for a data set of {THESIS_ROWS} rows",
        lambda data: error_agrees(data, "rbf"),
    ),
    Claim(
        "Table 5.3.2",
        f"The linear kernel's mean absolute error is {THESIS_ERRORS['linear'][0]}.",
        f"within {percent(RELATIVE_TOLERANCE)}, for a data set of {THESIS_ROWS} rows",
        lambda data: error_agrees(data, "linear"),
    ),
    Claim(
        "Table 5.3.1",
        "The quartiles of the predicted H/L.",
        f"all within {percent(MAX_QUARTILE_DEVIATION)}, for a data set of {THESIS_ROWS} rows",
        quartiles_agree,
    ),
)
