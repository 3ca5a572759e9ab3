"""The distribution of the highest value of a winter, as far as a few winters reveal it.

The highest value of a winter has a generalised extreme value distribution (Coles 2001, chapter 3).
Its parameters are uncertain, so they are a sample from their posterior distribution (Bayes). The
prior of location and scale is that of a family of location and scale: density 1/scale. With it,
intervals cover the truth as often as they say if the shape is known (Lawless 2003, appendix E). The
shape has a normal prior, wide enough for the shapes of yearly maxima of snow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

import numpy as np

from snowshed.base.arrays import Floats

#: Mean and standard deviation of the shape's prior. They were chosen among nine priors so that 90 %
#: intervals of 5 to 30 winters cover shapes of -0.2 to 0.2 in 86 to 95 % of samples.
SHAPE_MEAN, SHAPE_DEVIATION = 0.05, 0.25
#: Shapes of the grid on which the posterior is evaluated.
SHAPES = np.linspace(-0.5, 0.6, 12)
POINTS = 40  # of the grid for the location, and for the scale
#: Smallest scale of the grid, relative to the centre: seasons of one winter differ by more.
MIN_SCALE = 0.03


@dataclass(frozen=True)
class ExtremeValues:
    """A sample of generalised extreme value distributions.

    Attributes
    ----------
    location, scale, shape : (m,)
        Parameters of each distribution; a positive shape has a heavy upper tail.
    """

    location: Floats
    scale: Floats
    shape: Floats

    @classmethod
    def of_maxima(cls, maxima: Floats, count: int, random: np.random.Generator) -> ExtremeValues:
        """Return distributions from the posterior, given the highest values of some winters.

        Parameters
        ----------
        maxima : (n,)
            The highest value of each winter, at least two.
        count
            Number of distributions.
        random
            Source of random numbers.

        Examples
        --------
        >>> maxima = np.array([1.1, 1.5, 1.3, 1.8, 1.2, 1.6, 1.4, 1.9])
        >>> sample = ExtremeValues.of_maxima(maxima, 2000, np.random.default_rng(1))
        >>> bool(1.3 < np.median(sample.quantile(0.5)) < 1.6)
        True
        """
        ordered, winters = np.sort(maxima), len(maxima)
        centre = float(np.median(ordered))
        # Half the mean difference of two winters (the second L-moment) is 0.69 scales (Gumbel).
        weights = 2.0 * np.arange(winters) - winters + 1.0
        moment = float(ordered @ weights) / (winters * (winters - 1))
        unit = max(moment / np.log(2.0), MIN_SCALE * abs(centre), 1e-6)
        width = 1.0 / np.sqrt(winters)
        # The grid has the median less the centre, in scales, and the logarithm of the scale.
        medians = np.linspace(-8.0 * width, 8.0 * width, POINTS)
        logarithms = np.linspace(-0.4 - 4.0 * width, 9.0 * width, POINTS)
        log_density = np.array(
            [_log_density((ordered - centre) / unit, medians, logarithms, xi) for xi in SHAPES]
        )
        density = np.exp(log_density - log_density.max()).ravel()
        chosen = random.choice(density.size, count, p=density / density.sum())
        xi, u, v = np.unravel_index(chosen, log_density.shape)
        within_cell = random.random((2, count)) - 0.5
        scale = unit * np.exp(logarithms[v] + within_cell[0] * np.ptp(logarithms[:2]))
        median = centre + scale * (medians[u] + within_cell[1] * np.ptp(medians[:2]))
        shape = SHAPES[xi]
        return cls(median - scale * standard_quantile(0.5, shape), scale, shape)

    def quantile(self, probability: Union[float, Floats]) -> Floats:
        """Return the value that a winter stays below with a probability, of each distribution."""
        return self.location + self.scale * standard_quantile(probability, self.shape)

    def exceedance(self, value: Floats) -> Floats:
        """Return the probability that a winter exceeds a value (m,), for each distribution.

        Examples
        --------
        >>> one = ExtremeValues(np.array([1.0]), np.array([0.2]), np.array([0.1]))
        >>> one.exceedance(one.quantile(0.9)).round(6)
        array([0.1])
        """
        z = (value - self.location) / self.scale
        curved = np.abs(self.shape) > 1e-9
        shape = np.where(curved, self.shape, 1.0)
        # Beyond the end of the support, the power is 0 (no winter) or infinite (every winter).
        with np.errstate(divide="ignore", over="ignore"):
            power = np.maximum(1.0 + shape * z, 0.0) ** (-1.0 / shape)
            rate = np.where(curved, power, np.exp(-z))
        return np.asarray(-np.expm1(-rate))


def standard_quantile(probability: Union[float, Floats], shape: Floats) -> Floats:
    """Return quantiles of extreme value distributions with location 0 and scale 1.

    Examples
    --------
    >>> standard_quantile(0.98, np.array([-0.2, 0.0, 0.2])).round(2)
    array([2.71, 3.9 , 5.91])
    """
    rate = -np.log(probability)
    curved = np.abs(shape) > 1e-9
    divisor = np.where(curved, shape, 1.0)
    return np.asarray(np.where(curved, (rate**-divisor - 1.0) / divisor, -np.log(rate)))


def _log_density(values: Floats, medians: Floats, logarithms: Floats, shape: float) -> Floats:
    """Return the logarithm of the posterior density on the grid, for one shape.

    The density is that of `medians`, in scales, and `logarithms` of the scale.
    """
    scales = np.exp(logarithms)
    offset = float(standard_quantile(0.5, np.array(shape)))
    z = values / scales[:, None] - medians[:, None, None] + offset
    if abs(shape) < 1e-9:
        log_likelihood = -(z + np.exp(-z))
    else:
        inside = 1.0 + shape * z
        log_inside = np.log(np.where(inside > 0.0, inside, 1.0))
        log_likelihood = -(1.0 + 1.0 / shape) * log_inside - np.exp(-log_inside / shape)
        log_likelihood[inside <= 0.0] = -np.inf
    prior = -0.5 * ((shape - SHAPE_MEAN) / SHAPE_DEVIATION) ** 2
    # The prior 1/scale in the units of the grid is the scale.
    return np.asarray(log_likelihood.sum(axis=2) - (values.size - 1) * logarithms + prior)
