"""The posterior of the parameters, given the measurements, by MCMC on the surrogate.

The weighted mean over the rounds of a stack is normally distributed around the surrogate's mean,
with the variances of

- the rounds: the uncertainty of each measurement, and the seeding noise of a single run, because an
  experiment is a single slide-off, too. The weights are the inverse of these variances,
- the surrogate,
- the model: its error is an unknown fraction of the quantity's measured mean (one for heights, one
  for lengths, ...), a nuisance parameter with a half-normal prior of scale 0.1.

The last two are the same for all rounds.

The prior is uniform in the box of the parameters that were run (Kennedy and O'Hagan, Bayesian
calibration of computer models, J. R. Statist. Soc. B 63, 2001, with an independent discrepancy).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Union

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.calibration.surrogate import EXTRA, Output, Surrogate
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, Integers
from snowshed.base.extras import require

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

PURPOSE = "the posterior of the parameters"
WALKERS_PER_DIMENSION = 8
STEPS = 2000
MIN_STEPS = 100  # shorter chains do not even allow to estimate their correlation
BURN_IN = 0.33  # share of the steps that is discarded
MAX_SAMPLES = 4000  # samples, at most
PRIOR_POINTS = 4096  # points of the prior among which the walkers start
DISCREPANCY_SCALE = 0.1  # scale of its prior
MAX_DISCREPANCY = 1.0
END_SHARE = 0.05  # share of a range that counts as its end
OPEN_DENSITY_RATIO = (
    0.5  # share of the prior's density at an end, above which the range is open there
)
LEVELS = {
    "lower_95": 0.025,
    "lower_68": 0.16,
    "median": 0.5,
    "upper_68": 0.84,
    "upper_95": 0.975,
}
#: Convergence of the chains: number of independent samples that quantiles of 95 % need, and the
#: largest r_hat of chains that no longer depend on their starts.
MIN_EFFECTIVE_SAMPLES = 400
MAX_R_HAT = 1.1
DIAGNOSTICS = ("ess_bulk", "ess_tail", "r_hat")


@dataclass(frozen=True)
class Posterior:
    """Samples of the posterior.

    Attributes
    ----------
    surrogate
        The surrogate from which the samples were drawn.
    quantities
        The q measured quantities.
    draws
        All draws in the form of arviz, with the dimensions ``chain`` (walker) and ``draw``. There
        is a variable for each parameter, in its unit, and one for each quantity
        (``discrepancy_height``, ...), the model's error relative to the measured mean.
    """

    surrogate: Surrogate
    quantities: Sequence[str]
    draws: xr.Dataset

    @cached_property
    def samples(self) -> Floats:
        """Parameters in their units, shape (n, k), thinned if there are many draws."""
        return self._thinned(self.surrogate.parameters)

    @cached_property
    def discrepancy(self) -> Floats:
        """The model's error for each quantity, relative to its measured mean, shape (n, q)."""
        return self._thinned(_discrepancies(self.quantities))

    def _thinned(self, names: Sequence[str]) -> Floats:
        columns = [self.draws[name].transpose("draw", "chain").to_numpy().ravel() for name in names]
        return np.column_stack(columns)[:: max(1, self.draws[names[0]].size // MAX_SAMPLES)]

    @cached_property
    def diagnostics(self) -> pd.DataFrame:
        """Convergence of the chains by arviz, indexed by the variables of `draws`.

        ``ess_bulk`` and ``ess_tail`` are the effective numbers of independent samples for the
        median and for the ends of the ranges. ``r_hat`` is the deviation of all chains over the
        deviation within single chains, 1 if the chains agree (Vehtari et al., Rank-normalization,
        folding, and localization, Bayesian Analysis 16, 2021). The chains are those of the walkers,
        which are not independent; independent chains may differ a little more.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # arviz warns of its own next version
            arviz = require("arviz", EXTRA, PURPOSE)
            # A copy, because arviz 1 adds attributes that no NetCDF file can hold.
            summary = arviz.summary(self.draws.copy(), kind="diagnostics", round_to="none")
        columns: pd.DataFrame = summary[[*DIAGNOSTICS]]
        return columns

    def ranges(self) -> pd.DataFrame:
        """Return the range of each parameter that the measurements allow.

        Returns
        -------
        pandas.DataFrame
            ``parameter``; ``low`` and ``high``: the box that was searched; the quantiles
            ``lower_95``, ``lower_68``, ``median``, ``upper_68``, ``upper_95``; ``open``: "below",
            "above" or "both" if the density at an end of the box is more than half of the
            prior's, so that the range extends beyond the box; else empty; and the columns of
            `diagnostics`.
        """
        import pandas as pd

        rows = []
        for number, path in enumerate(self.surrogate.parameters):
            values = self.samples[:, number]
            low, high = self.surrogate.low[number], self.surrogate.high[number]
            row: dict[str, Union[str, float]] = {"parameter": path, "low": low, "high": high}
            row.update({name: np.quantile(values, level) for name, level in LEVELS.items()})
            row["open"] = _open_ends((values - low) / (high - low))
            rows.append({**row, **self.diagnostics.loc[path]})
        return pd.DataFrame(rows)

    def table(self) -> pd.DataFrame:
        """Return the samples: the parameters, and ``discrepancy_height``, ... as fractions."""
        import pandas as pd

        columns = [*self.surrogate.parameters, *_discrepancies(self.quantities)]
        return pd.DataFrame(np.hstack([self.samples, self.discrepancy]), columns=columns)

    @property
    def converged(self) -> bool:
        """True if the draws suffice for the quantiles of 95 % and the chains agree."""
        enough = self.effective_samples >= MIN_EFFECTIVE_SAMPLES
        return bool(enough and (self.diagnostics["r_hat"] <= MAX_R_HAT).all())

    @property
    def effective_samples(self) -> float:
        """The smallest effective sample size, in the bulk or the tails, of any parameter."""
        return float(self.diagnostics[["ess_bulk", "ess_tail"]].to_numpy(float).min())


def outputs_of(measurements: Sequence[Measurement]) -> list[Output]:
    """Return the outputs that a surrogate must predict for some measurements.

    Examples
    --------
    >>> outputs_of([Measurement(40, 1, round, "height", 0.05, 0.01) for round in (1, 2)])
    [('height', 40, 1)]
    """
    return list(
        dict.fromkeys(
            (measurement.quantity, measurement.tilt, measurement.event)
            for measurement in measurements
        )
    )


@checked
def sample_posterior(
    surrogate: Surrogate,
    measurements: Sequence[Measurement],
    *,
    steps: int = STEPS,
    seed: int = 1,
) -> Posterior:
    """Sample the posterior with emcee's ensemble of walkers, by differential evolution.

    Parameters
    ----------
    surrogate
        A surrogate that predicts at least the outputs of the measurements.
    measurements
        Measured stacks.
    steps
        Steps of every walker; the first third is dropped.
    seed
        Seed of the random numbers; the same seed gives the same samples.

    Raises
    ------
    InputError
        If there are too few steps, or a library of the extra ``calibration`` is not installed.
    """
    if steps < MIN_STEPS:
        raise InputError(f"steps: {steps} are too few; at least {MIN_STEPS} are needed")
    emcee, xarray = require("emcee", EXTRA, PURPOSE), require("xarray", EXTRA, PURPOSE)
    density = _Density.of(surrogate, measurements)
    dimensions = len(surrogate.parameters) + len(density.quantities)
    random = np.random.RandomState(seed)
    walkers = WALKERS_PER_DIMENSION * dimensions
    start = emcee.State(density.walker_starts(walkers, random), random_state=random.get_state())
    # Six times as many independent samples as emcee's default, the stretch move.
    moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    sampler = emcee.EnsembleSampler(walkers, dimensions, density, moves=moves, vectorize=True)
    sampler.run_mcmc(start, steps)
    burnt = int(BURN_IN * steps)
    chain = sampler.get_chain(discard=burnt)  # draws x walkers x dimensions
    count = len(surrogate.parameters)
    values = np.concatenate([surrogate.physical(chain[..., :count]), chain[..., count:]], axis=-1)
    names = [*surrogate.parameters, *_discrepancies(density.quantities)]
    columns = {name: (("chain", "draw"), values[..., i].T) for i, name in enumerate(names)}
    return Posterior(surrogate, density.quantities, xarray.Dataset(columns))


def _discrepancies(quantities: Sequence[str]) -> list[str]:
    """Return the names of the variables that hold the model's error for each quantity."""
    return [f"discrepancy_{quantity}" for quantity in quantities]


@dataclass(frozen=True)
class _Density:
    """Logarithm of the posterior density, up to a constant, at points (parameters, discrepancy).

    Attributes
    ----------
    surrogate
        Surrogate that predicts the outputs.
    quantities
        The measured quantities; each has a discrepancy.
    output, quantity
        Shape (m,): output and quantity of each mean of rounds.
    values, variances
        Shape (m,): the means, m, and their variances by measuring and seeding, m².
    seeding_variances
        Shape (m,): variance by the seeding of a single run, a part of the surrogate's, m².
    scales
        Shape (m,): mean of the quantity over the measurements, m.
    """

    surrogate: Surrogate
    quantities: Sequence[str]
    output: Integers
    quantity: Integers
    values: Floats
    variances: Floats
    seeding_variances: Floats
    scales: Floats

    @classmethod
    def of(cls, surrogate: Surrogate, measurements: Sequence[Measurement]) -> _Density:
        outputs = list(surrogate.outputs)
        quantities = list(dict.fromkeys(measurement.quantity for measurement in measurements))
        rounds: dict[Output, list[Measurement]] = {}
        for measurement in measurements:
            rounds.setdefault(
                (measurement.quantity, measurement.tilt, measurement.event), []
            ).append(measurement)
        output = np.array([outputs.index(key) for key in rounds])
        seeding_variances = surrogate.noises()[output]
        means = [
            _weighted_mean(one_stack, noise)
            for one_stack, noise in zip(rounds.values(), seeding_variances)
        ]
        values, variances = np.array(means).T
        scales = {
            name: np.mean(
                [
                    abs(measurement.value)
                    for measurement in measurements
                    if measurement.quantity == name
                ]
            )
            for name in quantities
        }
        return cls(
            surrogate,
            quantities,
            output,
            np.array([quantities.index(name) for name, _, _ in rounds]),
            values,
            variances,
            seeding_variances,
            np.array([scales[name] for name, _, _ in rounds]),
        )

    def __call__(self, points: Floats) -> Floats:
        count = len(self.surrogate.parameters)
        unit, discrepancy = points[:, :count], points[:, count:]
        inside = ((unit >= 0) & (unit <= 1)).all(axis=1)
        inside &= ((discrepancy >= 0) & (discrepancy <= MAX_DISCREPANCY)).all(axis=1)
        logarithms = np.full(len(points), -np.inf)
        if inside.any():
            logarithms[inside] = self._log_density(unit[inside], discrepancy[inside])
        return logarithms

    def _log_density(self, unit: Floats, discrepancy: Floats) -> Floats:
        means, variances = self.surrogate.predict(unit)
        model = discrepancy[:, self.quantity].T * self.scales[:, None]
        shared = variances[self.output] - self.seeding_variances[:, None] + model**2
        variance = shared + self.variances[:, None]
        residuals = self.values[:, None] - means[self.output]
        likelihood = -0.5 * (residuals**2 / variance + np.log(variance)).sum(axis=0)
        prior = -0.5 * ((discrepancy / DISCREPANCY_SCALE) ** 2).sum(axis=1)
        return np.asarray(likelihood + prior)

    def walker_starts(self, count: int, random: np.random.RandomState) -> Floats:
        """Return starts of the walkers, drawn from the prior with the likelihood as weight."""
        parameters = len(self.surrogate.parameters)
        unit = random.uniform(size=(PRIOR_POINTS, parameters))
        size = (PRIOR_POINTS, len(self.quantities))
        discrepancy = np.minimum(np.abs(random.normal(0, DISCREPANCY_SCALE, size)), MAX_DISCREPANCY)
        points = np.hstack([unit, discrepancy])
        likelihood = self._log_density(unit, discrepancy)
        likelihood += 0.5 * ((discrepancy / DISCREPANCY_SCALE) ** 2).sum(axis=1)
        best = np.argsort(likelihood + random.gumbel(size=PRIOR_POINTS))[-count:]
        return np.asarray(points[best])


def _weighted_mean(rounds: Sequence[Measurement], seeding: float) -> tuple[float, float]:
    """Return mean and variance of rounds, weighted by the inverse of their variances."""
    weights = 1 / (np.array([measurement.uncertainty for measurement in rounds]) ** 2 + seeding)
    mean = weights @ np.array([measurement.value for measurement in rounds]) / weights.sum()
    return float(mean), float(1 / weights.sum())


def _open_ends(fractions: Floats) -> str:
    """Return the ends of the range 0 to 1 at which the density of the samples stays high."""
    below = bool(np.mean(fractions < END_SHARE) >= OPEN_DENSITY_RATIO * END_SHARE)
    above = bool(np.mean(fractions > 1 - END_SHARE) >= OPEN_DENSITY_RATIO * END_SHARE)
    return {(True, True): "both", (True, False): "below", (False, True): "above"}.get(
        (below, above), ""
    )
