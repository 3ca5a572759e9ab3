"""The heights that winters need: some winters shed no snow, the others have extreme values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from snowshed.analysis.clearance.extreme_values import ExtremeValues
from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class WinterHeights:
    """A sample of distributions of the height that a winter needs.

    Attributes
    ----------
    bare : (m,)
        Probability of a winter without snow below the panel.
    snowy
        Heights of the other winters, m.
    floor
        Height that a winter without snow needs, m.
    """

    bare: Floats
    snowy: ExtremeValues
    floor: float

    @classmethod
    def of_seasons(
        cls, seasons: Sequence[Floats], floor: float, choices: int, count: int
    ) -> WinterHeights:
        """Return distributions from the heights of the seasons of each winter, m.

        One season is chosen from each winter, because a winter has the chance of one season.

        Parameters
        ----------
        seasons : of (d,)
            Heights of the seasons of each winter; at least two winters need more than the floor.
        floor
            Height that a winter without snow needs, m.
        choices, count
            Number of choices of seasons, and of distributions for each.
        """
        random = np.random.default_rng(1)
        snowy = [heights for heights in seasons if is_snowy(heights, floor)]
        bare = np.zeros(choices * count)
        if len(snowy) < len(seasons):  # Jeffreys's prior for a share
            bare = random.beta(len(seasons) - len(snowy) + 0.5, len(snowy) + 0.5, choices * count)
        samples = [
            ExtremeValues.of_maxima(
                np.array([random.choice(heights) for heights in snowy]), count, random
            )
            for _ in range(choices)
        ]
        fields = ("location", "scale", "shape")
        joined = [np.concatenate([getattr(part, name) for part in samples]) for name in fields]
        return cls(bare, ExtremeValues(*joined), floor)

    def quantile(self, probability: float) -> Floats:
        """Return the height that a winter stays below with a probability, of each distribution."""
        among_snowy = np.clip((probability - self.bare) / (1.0 - self.bare), 1e-12, None)
        heights = np.maximum(self.snowy.quantile(among_snowy), self.floor)
        return np.where(probability > self.bare, heights, self.floor)

    def exceedance(self, height: Floats) -> Floats:
        """Return the probability that a winter needs more than a height (m,)."""
        exceeded = (1.0 - self.bare) * self.snowy.exceedance(height)
        return np.where(height < self.floor, 1.0, exceeded)


def is_snowy(heights: Floats, floor: float) -> bool:
    """Return whether a winter needs more than the floor."""
    return float(heights.mean()) > floor
