"""Inputs: the panel design and the ranges of uncertain snow parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.scene.components import Ground, Panel, Slab
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.season.settings import SeasonSettings

MIN_CELL, MAX_CELL, CELLS = 0.04, 0.1, 40  # m, m, cells along the slope

Span = tuple[float, float]

#: The uncertain snow parameters, and their default ranges.
DEFAULT_RANGES: Mapping[str, Span] = {
    "friction": (0.3, 0.7),
    "adhesion": (0.0, 150.0),
    "sliding": (0.1, 0.4),
    "strength": (0.5, 2.0),
}
MEANING: Mapping[str, str] = {
    "friction": "static friction of snow on the panel",
    "adhesion": "adhesion of snow to the panel, Pa",
    "sliding": "friction of sliding snow",
    "strength": "strength of the snow, as a multiple of that for its density",
    "catch": "share of the snowfall that the panel catches",
}
LIMITS: Mapping[str, Span] = {
    "friction": (0.0, 10.0),
    "adhesion": (0.0, 1e5),
    "sliding": (0.0, 10.0),
    "strength": (0.01, 100.0),
    "catch": (0.0, 1.0),
}


@dataclass(frozen=True)
class Design:
    """A panel whose lower edge needs a height.

    Attributes
    ----------
    slope_length
        Length along the slope, m.
    tilt
        Tilt from the horizontal, degrees.
    """

    slope_length: float
    tilt: float

    def __post_init__(self) -> None:
        if not 0.1 <= self.slope_length <= 50.0:
            raise InputError(f"slope length: {self.slope_length:g} m; allowed: 0.1 to 50 m")
        if not 5.0 <= self.tilt <= 85.0:
            raise InputError(f"tilt: {self.tilt:g} degrees; allowed: 5 to 85")

    @property
    def dx(self) -> float:
        """Size of the grid cells, m."""
        return float(np.clip(self.slope_length / CELLS, MIN_CELL, MAX_CELL))


@dataclass(frozen=True)
class Ranges:
    """Ranges of the uncertain snow parameters.

    Attributes
    ----------
    spans
        Smallest and largest value by names in `MEANING`; the same value twice if it is known.
    draws
        Number of simulations of each winter, each with other values.
    seed
        Random seed of the values.

    Examples
    --------
    >>> ranges = Ranges({"friction": (0.4, 0.4), "adhesion": (0.0, 0.0)}, draws=1)
    >>> ranges.draw(2)[0]["friction"], len(ranges.draw(3))
    (0.4, 3)
    """

    spans: Mapping[str, Span] = field(default_factory=lambda: dict(DEFAULT_RANGES))
    draws: int = 3
    seed: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.draws <= 1000:
            raise InputError(f"draws: {self.draws}; allowed: 1 to 1000")
        for name, (low, high) in self.spans.items():
            if name not in MEANING:
                raise InputError(f"range of {name!r}; allowed: {', '.join(MEANING)}")
            least, most = LIMITS[name]
            if not (math.isfinite(low) and math.isfinite(high) and least <= low <= high <= most):
                raise InputError(
                    f"{name}: {low:g} to {high:g} is not allowed; needed: two values, the smaller "
                    f"first, from {least:g} to {most:g}"
                )

    def draw(self, winters: int) -> list[dict[str, float]]:
        """Return the values for all draws of each winter, winter after winter.

        They are a Latin hypercube over all runs (McKay et al. 1979), so that few runs cover the
        ranges evenly.
        """
        count = winters * self.draws
        random = np.random.default_rng(self.seed)
        values: list[dict[str, float]] = [{} for _ in range(count)]
        for name, (low, high) in sorted(self.spans.items()):
            shares = (random.permutation(count) + random.random(count)) / count
            for draw, share in zip(values, shares):
                if name == "strength":  # a factor: as many below one as above
                    draw[name] = float(low * (high / low) ** share)
                else:
                    draw[name] = float(low + (high - low) * share)
        return values


def season_settings(base: SeasonSettings, values: Mapping[str, float], dx: float) -> SeasonSettings:
    """Return a season's settings with drawn values; releases below 1.5 cells slide together."""
    drawn: dict[str, Any] = {
        name: values[name] for name in ("friction", "adhesion", "catch") if name in values
    }
    return replace(base, **drawn, pool_below=max(base.pool_below, 1.5 * dx))


def scene_of(
    design: Design, height: float, values: Mapping[str, float], seed: int, base: Mapping[str, Any]
) -> ResolvedScene:
    """Return the scene of a panel at a height, without its slabs.

    Parameters
    ----------
    design, height
        The panel, and its lower edge above the ground, m.
    values
        Drawn values of the uncertain parameters.
    seed
        Random seed of the particles' positions.
    base
        Values of the scene by dotted path, which replace the defaults.
    """
    scene = Scene(dimension=2, panel=Panel(), slab=Slab(thickness=0.1), ground=Ground())
    scene.update(
        {
            "panel.height": height,
            "panel.length": design.slope_length,
            "panel.tilt": design.tilt,
            "panel.friction": values.get("sliding", 0.3),
            "numerics.dx": design.dx,
            "seeding.particles_per_voxel": 4,
            "seeding.seed": seed,
            "events.max_time": 6.0,
            **base,
        }
    )
    strength = values.get("strength", 1.0)
    data = scene.resolve().data
    snow = data["snow"]
    if "preconsolidation_pressure" in snow:
        scene.set("snow.preconsolidation_pressure", strength * snow["preconsolidation_pressure"])
    return scene.resolve()
