"""The spread of stacks around their prediction.

The 100 models differ, and the data scatter about any model. Both are measured on panels that a
model has never seen. Rows of the same panel are alike, so errors on single rows that are left out
would be too small.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from snowshed.analysis.regression.folds import ShuffledGroupKFold
from snowshed.analysis.regression.kinds import Kind, Parameters
from snowshed.analysis.regression.rows import StackRows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.base.arrays import Floats

SPREAD_SHARE = 0.68  # share of the cases within the spread
INTERVAL_SHARE = 0.90  # share of the cases within the interval
MIN_SCALE = 1e-9  # smallest scale, relative to the standard deviation of the predictions


@dataclass(frozen=True)
class Spread:
    """Half widths of intervals about a prediction.

    The scale of an error is sqrt(s^2 + (a + b |prediction|)^2), with s the standard deviation of
    the models. The number of scales that contains a share of the errors is counted on unseen
    panels (normalised conformal prediction), so that no distribution is assumed.

    Attributes
    ----------
    floor, slope
        a, in the target's unit, and b.
    factors
        Number of scales that contain a share of the cases, for each share.
    """

    floor: float
    slope: float
    factors: Mapping[float, float]

    @classmethod
    def of(cls, errors: Floats, predictions: Floats, deviations: Floats) -> Spread:
        """Measure the spread.

        Parameters
        ----------
        errors, predictions, deviations
            On rows of unseen panels, shape (n,): error, prediction, and standard deviation of the
            models.
        """
        noise = np.sqrt(np.maximum(errors**2 - deviations**2, 0.0))
        design = np.column_stack([np.ones_like(predictions), np.abs(predictions)])
        floor, slope = optimize.nnls(design, noise)[0]
        floor = max(float(floor), MIN_SCALE * float(np.std(predictions)), 1e-12)
        scales = _scales(floor, float(slope), predictions, deviations)
        ratios = np.sort(np.abs(errors) / scales)
        factors = {part: _quantile(ratios, part) for part in (SPREAD_SHARE, INTERVAL_SHARE)}
        return cls(floor, float(slope), factors)

    def half_width(
        self, predictions: Floats, deviations: Floats, part: float = SPREAD_SHARE
    ) -> Floats:
        """Return the half width around predictions that contains a share of the stacks."""
        return self.factors[part] * _scales(self.floor, self.slope, predictions, deviations)


def _scales(floor: float, slope: float, predictions: Floats, deviations: Floats) -> Floats:
    return np.asarray(np.hypot(deviations, floor + slope * np.abs(predictions)))


def _quantile(ratios: Floats, part: float) -> float:
    """Return the quantile of sorted ratios that holds for a new case, not only for the given."""
    rank = int(np.ceil(part * (len(ratios) + 1))) - 1
    return float(ratios[min(rank, len(ratios) - 1)])


def predict_unseen_panels(
    kind: Kind,
    elected: Sequence[Sequence[Parameters]],
    rows: StackRows,
    target: str,
    seed: int = 1,
) -> Floats:
    """Predict every row by models that have not seen its panel.

    Parameters
    ----------
    kind
        Kind of the models.
    elected
        For each round, the hyper-parameters that its outer folds elected.
    rows, target
        The data.
    seed
        Random seed of the splits into groups of panels.

    Returns
    -------
    numpy.ndarray
        Mean of the rounds' predictions in the target's unit, shape (n,).
    """
    inputs = Scaling.of(rows.inputs).scaled(rows.inputs)
    values = rows.targets[target]
    scaling = Scaling.of(values[:, None])
    scaled = scaling.scaled(values[:, None])[:, 0]
    predictions = np.empty((len(elected), len(rows)))
    for number, choices in enumerate(elected):
        folds = ShuffledGroupKFold(min(len(choices), rows.panel_count), (seed, number, 1))
        splits = folds.split(inputs, groups=rows.panels)
        for (train, held_out), parameters in zip(splits, choices):
            model = kind.estimator(parameters).fit(inputs[train], scaled[train])
            predictions[number, held_out] = model.predict(inputs[held_out])
    return np.asarray(predictions.mean(axis=0) * scaling.deviation[0] + scaling.mean[0])


def stack_spread(rows: StackRows, target: str, predictions: Floats, deviations: Floats) -> Spread:
    """Return the spread of single stacks, each of one seed, about predictions.

    Parameters
    ----------
    rows, target
        The data.
    predictions, deviations
        Predictions of models that have not seen the row's panel (`predict_unseen_panels`), and
        standard deviation of the models, for each row, shape (n,).
    """
    stacks = rows.stacks[target]
    row, repetition = np.nonzero(np.isfinite(stacks))
    errors = predictions[row] - stacks[row, repetition]
    return Spread.of(errors, predictions[row], deviations[row])
