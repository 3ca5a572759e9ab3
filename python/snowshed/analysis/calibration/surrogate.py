"""Surrogate of the simulations: the measures of a stack as functions of the snow's parameters.

There is one Gaussian process for each measured quantity, tilt and event. It has a Matern 5/2
covariance with a length scale for each parameter, and white noise for the seeding (extra
``snowshed[calibration]``).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.comparison import SET, SimulatedStacks
from snowshed.base.arrays import Floats
from snowshed.base.extras import require

if TYPE_CHECKING:
    import pandas as pd

EXTRA = "calibration"
PURPOSE = "the surrogate of the simulations"
SMOOTHNESS = 2.5
#: Bounds of the hyper-parameters: parameters span 0 to 1, values have mean 0 and deviation 1.
LENGTHS = (0.1, 30.0)
AMPLITUDE = (1e-2, 1e2)
NOISE = (1e-5, 2.0)
MIN_POINTS = 6  # parameter sets

Output = tuple[str, float, int]  # quantity, tilt, event


@dataclass(frozen=True)
class Process:
    """The Gaussian process of one output, conditioned on the simulations.

    Attributes
    ----------
    kernel
        Covariance without noise, a function of two arrays of points.
    points, values
        Shapes (n, k), unit cube, and (n,), standardised.
    noise
        Variance of the seeding, standardised.
    mean, deviation
        Mean and standard deviation of the simulated values, m.
    """

    kernel: Any
    points: Floats
    values: Floats
    noise: float
    mean: float
    deviation: float
    inverse: Floats

    @classmethod
    def fitted(cls, points: Floats, values: Floats) -> Process:
        """Return the process whose hyper-parameters maximise the marginal likelihood."""
        gp = require("sklearn.gaussian_process", EXTRA, PURPOSE)
        kernels = gp.kernels
        mean, deviation = float(values.mean()), float(values.std()) or 1.0
        lengths = np.ones(points.shape[1])
        covariance = kernels.ConstantKernel(1.0, AMPLITUDE) * kernels.Matern(
            lengths, LENGTHS, nu=SMOOTHNESS
        )
        model = gp.GaussianProcessRegressor(
            covariance + kernels.WhiteKernel(0.1, NOISE),
            alpha=1e-10,
            random_state=0,
        )
        standard = (values - mean) / deviation
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a length at its bound: the input has no effect
            model.fit(points, standard)
        kernel, noise = model.kernel_.k1, float(model.kernel_.k2.noise_level)
        inverse = np.linalg.inv(kernel(points) + noise * np.eye(len(points)))
        return cls(kernel, points, standard, noise, mean, deviation, inverse)

    def predict(self, at: Floats) -> tuple[Floats, Floats]:
        """Return mean and variance of single runs at points of the unit cube, m and m²."""
        across = self.kernel(at, self.points)
        explained = ((across @ self.inverse) * across).sum(axis=1)
        variance = np.maximum(self.kernel.diag(at) - explained, 0.0) + self.noise
        mean = across @ (self.inverse @ self.values)
        return self.mean + self.deviation * mean, self.deviation**2 * variance

    def left_out(self) -> tuple[Floats, Floats]:
        """Return error and standard deviation of each run's prediction from all other runs, m.

        The closed form is used (Rasmussen and Williams, Gaussian Processes for Machine Learning,
        eqs. 5.10 to 5.12).
        """
        diagonal = np.diag(self.inverse)
        errors = (self.inverse @ self.values) / diagonal
        return self.deviation * errors, self.deviation / np.sqrt(diagonal)


@dataclass(frozen=True)
class Surrogate:
    """Predictions of stacks for any parameters within the box of the simulated ones.

    Attributes
    ----------
    parameters
        Dotted paths.
    low, high
        The box, shape (k,), in the parameters' units.
    outputs
        The outputs that are predicted: quantity, tilt in degrees, and event.
    processes
        One for each output.
    """

    parameters: Sequence[str]
    low: Floats
    high: Floats
    outputs: Sequence[Output]
    processes: Sequence[Process]

    @classmethod
    def fitted(cls, stacks: SimulatedStacks, outputs: Sequence[Output]) -> Surrogate:
        """Fit a surrogate to simulated stacks.

        Raises
        ------
        InputError
            If there are too few parameter sets, or scikit-learn is not installed.
        """
        sets = stacks.sets.to_numpy(float)
        low, high = sets.min(axis=0), sets.max(axis=0)
        unit = stacks.sets.copy()
        unit[:] = (sets - low) / (high - low)
        processes = []
        for quantity, tilt, event in outputs:
            rows = stacks.rows
            rows = rows[(rows["tilt"] == tilt) & (rows["event"] == event)]
            count = rows[SET].nunique()
            if count < MIN_POINTS:
                raise InputError(
                    f"{count} parameter sets have event {event} at tilt {tilt:g}; the surrogate "
                    f"needs at least {MIN_POINTS}"
                )
            points = unit.loc[rows[SET]].to_numpy(float)
            processes.append(Process.fitted(points, rows[quantity].to_numpy(float)))
        return cls(stacks.parameters, low, high, outputs, processes)

    def unit(self, parameters: Floats) -> Floats:
        """Return parameters, shape (n, k), as points of the unit cube."""
        return np.asarray((parameters - self.low) / (self.high - self.low))

    def physical(self, unit: Floats) -> Floats:
        """Return points of the unit cube as parameters."""
        return np.asarray(self.low + unit * (self.high - self.low))

    def predict(self, unit: Floats) -> tuple[Floats, Floats]:
        """Return mean and variance of single runs, shapes (outputs, n), m and m²."""
        predictions = [process.predict(unit) for process in self.processes]
        means, variances = zip(*predictions)
        return np.array(means), np.array(variances)

    def noises(self) -> Floats:
        """Return the variances of single runs by the seeding, shape (outputs,), m²."""
        return np.array([process.deviation**2 * process.noise for process in self.processes])

    def accuracy(self) -> pd.DataFrame:
        """Return the accuracy of every output for runs that it has not seen (leave one run out).

        Returns
        -------
        pandas.DataFrame
            ``quantity``, ``tilt``, ``event``; ``rmse_m``; ``noise_m``: the share of the RMSE that
            the surrogate attributes to the seeding; ``explained``: 1 - (RMSE / deviation of the
            runs)²; ``within_two``: share of the runs within two predicted standard deviations, 0.95
            if these are right.
        """
        import pandas as pd

        rows = []
        for (quantity, tilt, event), process in zip(self.outputs, self.processes):
            errors, deviations = process.left_out()
            rmse = float(np.sqrt(np.mean(errors**2)))
            rows.append(
                {
                    "quantity": quantity,
                    "tilt": tilt,
                    "event": event,
                    "rmse_m": rmse,
                    "noise_m": process.deviation * process.noise**0.5,
                    "explained": 1 - (rmse / process.deviation) ** 2,
                    "within_two": float(np.mean(np.abs(errors) <= 2 * deviations)),
                }
            )
        return pd.DataFrame(rows)
