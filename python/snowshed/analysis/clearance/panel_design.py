"""Inputs: the panel design and the ranges of uncertain snow parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.clearance.common_effects import MIN_FREE
from snowshed.analysis.clearance.grid_error import MIN_CELLS
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.callers import argument
from snowshed.base.notes import issue_note
from snowshed.scene.components import Ground, Panel, Slab
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.season.rows import SINGLE_ROW, PanelRows
from snowshed.season.settings import SeasonSettings

MIN_CELL, MAX_CELL = 0.04, 0.1  # m
CELLS = 60  # cells along the slope
USUAL_DRAWS = 3
#: Distance that an edge keeps from the highest snow, m. It does not depend on the grid.
MARGIN = 0.1

Span = tuple[float, float]


@dataclass(frozen=True)
class UncertainParameter:
    """A property of the snow that is not known, but the same in every winter.

    Attributes
    ----------
    name
        Name in a sentence, without an article.
    limits
        Smallest and largest allowed value.
    unit
        Unit, or the quantity of which it is a multiple; empty: a plain number.
    default
        Default range; None: the parameter does not vary by default.
    is_factor
        Whether it is a factor; its logarithm is then drawn evenly, not its value.
    usual
        Range of most values; others than 0 are noted.
    """

    name: str
    limits: Span
    unit: str = ""
    default: Optional[Span] = None
    is_factor: bool = False
    usual: Optional[Span] = None

    @property
    def label(self) -> str:
        """The name with the unit."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    def is_usual(self, value: float) -> bool:
        """Return whether a value has a usual magnitude; 0 has.

        Examples
        --------
        >>> UNCERTAIN["adhesion"].is_usual(150.0), UNCERTAIN["adhesion"].is_usual(0.15)
        (True, False)
        """
        return not self.usual or not value or self.usual[0] <= value <= self.usual[1]

    def check(self, name: str, span: Span) -> None:
        """Raise InputError if a range is not allowed; note unusual values."""
        low, high = span
        smallest, largest = self.limits
        if not (math.isfinite(low) and math.isfinite(high) and smallest <= low <= high <= largest):
            raise InputError(
                f"{name}: {low:g} to {high:g} is not allowed; needed: two values, the smaller "
                f"first, from {smallest:g} to {largest:g}"
            )
        for note in self.unusual(name, span):
            issue_note(note)

    def unusual(self, name: str, span: Span) -> list[str]:
        """Return a note if a range has unusual values."""
        if not self.usual or all(map(self.is_usual, span)):
            return []
        unit = f" ({self.unit})" if self.unit else ""
        return [
            f"{name}: {span[0]:g} to {span[1]:g} is unusual; most values are {self.usual[0]:g} to "
            f"{self.usual[1]:g}{unit}, so check the unit"
        ]


#: The uncertain parameters by name.
UNCERTAIN: Mapping[str, UncertainParameter] = {
    "friction": UncertainParameter(
        "static friction of snow on the panel", (0.0, 10.0), default=(0.3, 0.7), usual=(0.01, 2.0)
    ),
    "adhesion": UncertainParameter(
        "adhesion of snow to the panel", (0.0, 1e5), "Pa", default=(0.0, 150.0), usual=(0.2, 1e4)
    ),
    "sliding_friction": UncertainParameter(
        "friction of sliding snow", (0.0, 10.0), default=(0.1, 0.4), usual=(0.01, 2.0)
    ),
    "strength": UncertainParameter(
        "strength of the snow",
        (0.01, 100.0),
        "as a multiple of that for its density",
        default=(0.5, 2.0),
        is_factor=True,
        usual=(0.1, 10.0),
    ),
    "melt_factor": UncertainParameter(
        "melt of snow on panel, ground and stack",
        (0.01, 100.0),
        "mm of water per day and degree above 0 °C",
        default=(2.0, 8.0),
        is_factor=True,
        usual=(0.5, 20.0),
    ),
    "catch": UncertainParameter("share of the snowfall that the panel catches", (0.0, 1.0)),
}


def default_ranges() -> dict[str, Span]:
    """Return the ranges of the parameters that vary by default."""
    ranges = {name: parameter.default for name, parameter in UNCERTAIN.items()}
    return {name: span for name, span in ranges.items() if span is not None}


@checked
@dataclass(frozen=True)
class PanelDesign:
    """A panel whose lower edge needs a height.

    Attributes
    ----------
    slope_length
        Length along the slope, m.
    tilt
        Tilt from the horizontal, degrees; 90: a fence, on which no snow lies.
    rows
        Rows of such panels; by default a single one.
    """

    slope_length: float
    tilt: float
    rows: PanelRows = SINGLE_ROW

    def __post_init__(self) -> None:
        if not 0.1 <= self.slope_length <= 50.0:
            raise InputError(f"slope length: {self.slope_length:g} m; allowed: 0.1 to 50 m")
        if not 5.0 <= self.tilt <= 90.0:
            raise InputError(f"tilt: {self.tilt:g} degrees; allowed: 5 to 90")

    @property
    def default_dx(self) -> float:
        """Size of the grid cells, m, unless another is chosen."""
        return float(np.clip(self.slope_length / CELLS, MIN_CELL, MAX_CELL))


@checked
@dataclass(frozen=True)
class SnowRanges:
    """Ranges of the uncertain snow parameters.

    Attributes
    ----------
    spans
        Smallest and largest value of ``friction``, ``adhesion`` [Pa], ``sliding_friction``,
        ``strength`` (a factor), ``melt_factor`` (mm of water per day and degree above 0 degrees C)
        and ``catch`` (a share); the same value twice if it is known.
    draws
        Number of simulations of each winter, each with other values. [default: 3, and more if
        there are fewer than seven winters]
    seed
        Random seed of the values.

    Examples
    --------
    >>> ranges = SnowRanges({"friction": (0.4, 0.4), "adhesion": (0.0, 0.0)}, draws=1)
    >>> ranges.draw(2)[0]["friction"], len(ranges.draw(3))
    (0.4, 3)
    """

    spans: Mapping[str, Span] = field(default_factory=default_ranges)
    draws: Optional[int] = None
    seed: int = 1

    def __post_init__(self) -> None:
        if self.draws is not None and not 1 <= self.draws <= 1000:
            raise InputError(f"draws: {self.draws}; allowed: 1 to 1000")
        for name, (low, high) in self.spans.items():
            if name not in UNCERTAIN:
                raise InputError(f"range of {name!r}; allowed: {', '.join(UNCERTAIN)}")
            UNCERTAIN[name].check(name, (low, high))

    @property
    def notes(self) -> list[str]:
        """Notes on unusual values, which results repeat.

        Examples
        --------
        >>> SnowRanges({"friction": (0.4, 0.4)}).notes
        []
        """
        return [
            note
            for name, span in self.spans.items()
            for note in UNCERTAIN[name].unusual(name, span)
        ]

    def draws_of(self, winters: int) -> int:
        """Return the number of simulations of each winter.

        Examples
        --------
        >>> SnowRanges().draws_of(10), SnowRanges().draws_of(1), SnowRanges(draws=2).draws_of(1)
        (3, 14, 2)
        """
        uncertain = sum(low < high for low, high in self.spans.values())
        needed = 1 + math.ceil((uncertain + MIN_FREE) / winters)
        return self.draws or max(USUAL_DRAWS, needed if uncertain else 1)

    def draw(self, winters: int) -> list[dict[str, float]]:
        """Return the values for all draws of each winter, winter after winter.

        They are a Latin hypercube over all runs (McKay et al. 1979), so that few runs cover the
        ranges evenly.
        """
        count = winters * self.draws_of(winters)
        random = np.random.default_rng(self.seed)
        values: list[dict[str, float]] = [{} for _ in range(count)]
        for name, (low, high) in sorted(self.spans.items()):
            shares = (random.permutation(count) + random.random(count)) / count
            for draw, share in zip(values, shares):
                if UNCERTAIN[name].is_factor:
                    draw[name] = float(low * (high / low) ** share)
                else:
                    draw[name] = float(low + (high - low) * share)
        return values

    def positions(self, values: Sequence[Mapping[str, float]]) -> dict[str, Floats]:
        """Return the position of drawn values in their ranges, from -0.5 to 0.5, by name.

        Known values are left out.

        Examples
        --------
        >>> SnowRanges({"strength": (0.5, 2.0)}).positions([{"strength": 1.0}])
        {'strength': array([0.])}
        """
        positions = {}
        for name, (low, high) in self.spans.items():
            drawn = np.array([value[name] for value in values])
            if not low < high:
                continue
            if UNCERTAIN[name].is_factor:
                positions[name] = np.log(drawn / low) / np.log(high / low) - 0.5
            else:
                positions[name] = (drawn - low) / (high - low) - 0.5
        return positions


def check_base(base: Mapping[str, Any]) -> None:
    """Raise InputError at values of the scene that the search or the ranges set.

    Examples
    --------
    >>> check_base({"numerics.dx": 0.05})
    >>> check_base({"panel.height": 2.0})
    Traceback (most recent call last):
    snowshed._core.InputError: scene: panel.height: the search sets it; leave it out
    """
    set_by_search = {
        "panel.height": "the search sets it",
        "panel.length": f"{argument('slope_length')} sets it",
        "panel.tilt": f"{argument('tilt')} sets it",
        "panel.friction": f"it is drawn from {argument('ranges', option='range')}",
        "seeding.seed": "it is drawn",
    }
    for path, value in base.items():
        if isinstance(value, Mapping):
            inner = next(iter(value), "dx")
            raise InputError(f"scene: {path}: give dotted paths, such as {path}.{inner}")
        if path in set_by_search:
            raise InputError(f"scene: {path}: {set_by_search[path]}; leave it out")


def season_settings(
    design: PanelDesign, base: SeasonSettings, values: Mapping[str, float], dx: float
) -> SeasonSettings:
    """Return a season's settings with drawn values; releases thinner than 2 cells are pooled."""
    of_season = ("friction", "adhesion", "catch", "melt_factor")
    drawn: dict[str, Any] = {name: values[name] for name in of_season if name in values}
    pooled = max(base.pool_below, MIN_CELLS * dx)
    return replace(base, **drawn, pool_below=pooled, rows=design.rows)


def panel_scene(
    design: PanelDesign,
    height: float,
    values: Mapping[str, float],
    seed: int,
    base: Mapping[str, Any],
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
            "panel.friction": values.get("sliding_friction", 0.3),
            "numerics.dx": design.default_dx,
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
