"""Maps of the probability that snow reaches a cell, and of its intensity, from many slides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.callers import argument
from snowshed.base.paths import PathLike
from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.maps import PeakMaps
from snowshed.scene.scene import ResolvedScene
from snowshed.scene.terrain_grid import slide_terrain
from snowshed.study.store import Store

if TYPE_CHECKING:
    import pandas as pd

#: Mapped quantities, with their units and AvaFrame's names of the rasters.
QUANTITIES: Mapping[str, tuple[str, str]] = {
    "thickness": ("m", "pft"),
    "speed": ("m/s", "pfv"),
    "pressure": ("kPa", "ppr"),
}
REACHED_THICKNESS = 0.1  # m of snow
PRESSURES = (1.0, 3.0, 10.0)  # kPa
PERCENTILES = (50, 95)
LEVELS = (0.05, 0.5, 0.95)  # probabilities whose areas are reported
NORMAL_95 = 1.959963984540054  # two-sided 95 % quantile of the normal distribution
BAND_BYTES = 100_000_000  # memory for one band of the maps of all runs


@dataclass(frozen=True)
class Exceedance:
    """Probability that a quantity exceeds a value, by position.

    Attributes
    ----------
    quantity, threshold
        Such as "thickness", and the value in its unit.
    probability, lower, upper : (rows, columns)
        Share of the runs, and the ends of its 95 % interval (`wilson_interval`).
    """

    quantity: str
    threshold: float
    probability: Floats
    lower: Floats
    upper: Floats

    @property
    def name(self) -> str:
        """A name for files, such as "pft_above_0.1m"."""
        unit, short = QUANTITIES[self.quantity]
        return f"{short}_above_{self.threshold:g}{unit.replace('/', '_')}"

    @property
    def label(self) -> str:
        """Label of the exceedance, such as "thickness above 0.1 m"."""
        return f"{self.quantity} above {self.threshold:g} {QUANTITIES[self.quantity][0]}"


@dataclass(frozen=True)
class HazardMaps:
    """Results of many slides on the same terrain, node by node, the southernmost row first.

    Attributes
    ----------
    terrain
        Elevations with their place.
    runs, failed
        Number of slides in the maps, and number of failed ones.
    exceedances
        Maps of exceedance; the first is that of being reached.
    percentiles
        Maps by quantity and percentile: this percentage of the runs stays below the values. Runs
        that do not reach a node count there with 0.
    """

    terrain: Raster
    runs: int
    failed: int
    exceedances: Sequence[Exceedance]
    percentiles: Mapping[tuple[str, int], Floats]

    def area(self, exceedance: Exceedance, probability: float) -> float:
        """Return the area on the map with at least this probability of exceedance, m2."""
        return float((exceedance.probability >= probability).sum()) * self.terrain.cell**2

    def raster(self, values: Floats) -> Raster:
        """Return one of the maps with its place."""
        place = self.terrain
        return Raster(values, place.east, place.north, place.cell, crs=place.crs)


@checked
def hazard_maps(
    folder: PathLike,
    study: Optional[str] = None,
    *,
    reached: float = REACHED_THICKNESS,
    pressures: Sequence[float] = PRESSURES,
    percentiles: Sequence[int] = PERCENTILES,
) -> HazardMaps:
    """Return the maps of the computed runs of a study of slides.

    Maps are processed in row bands, so memory does not grow with the number of runs.

    Parameters
    ----------
    folder, study
        Folder of the store, and name of the study; not needed if the store holds only one. The
        study was computed with ``keep_particles``.
    reached
        Thickness above which snow has reached a node, m.
    pressures
        Pressures whose exceedance is mapped, kPa.
    percentiles
        Percentiles of peak thickness, speed and pressure to map, 0 to 100.

    Raises
    ------
    InputError
        If there is no such study, none of its slides is done, maps are missing, or they have
        different grids.
    """
    _check(reached, pressures, percentiles)
    with Store.open(folder) as store:
        runs = store.runs(store.named(study))
        done = [run.hash for run in runs if run.status == "done"]
        if not done:
            raise InputError(f"{folder}: no run of the study is done yet")
        terrain = slide_terrain(ResolvedScene.parse(runs[0].scene))
        sums = _Sums(terrain.heights.shape, len(done), reached, pressures, percentiles)
        for begin, end in _bands(terrain.heights.shape, len(done)):
            sums.add(begin, end, (stored_maps(store, hash_) for hash_ in done))
    failed = sum(run.status == "failed" for run in runs)
    return HazardMaps(terrain, len(done), failed, sums.exceedances(), sums.percentiles)


def wilson_interval(count: Any, runs: int) -> tuple[Floats, Floats]:
    """Return the ends of Wilson's 95 % interval of a probability.

    It holds for independent draws; the scatter of a Latin hypercube or of Sobol's sequence is
    smaller. Wilson (1927), doi:10.1080/01621459.1927.10502953.

    Parameters
    ----------
    count
        Number of runs in which the event occurred; a number or an array.
    runs
        Number of all runs.

    Examples
    --------
    >>> low, high = wilson_interval(0, 50)
    >>> round(float(low), 3), round(float(high), 3)
    (0.0, 0.071)
    """
    share = np.asarray(count, dtype=float) / runs
    square = NORMAL_95**2 / runs
    middle = (share + 0.5 * square) / (1.0 + square)
    half = np.sqrt(share * (1.0 - share) * square + 0.25 * square**2) / (1.0 + square)
    low: Floats = np.clip(middle - half, 0.0, 1.0)
    high: Floats = np.clip(middle + half, 0.0, 1.0)
    return low, high


class _Sums:
    """Maps that are filled band by band."""

    def __init__(
        self,
        shape: tuple[int, ...],
        runs: int,
        reached: float,
        pressures: Sequence[float],
        percentiles: Sequence[int],
    ) -> None:
        self.shape = shape
        self.runs = runs
        thresholds = [("thickness", reached), *(("pressure", value) for value in pressures)]
        self.counts = {key: np.zeros(shape, dtype=np.int32) for key in thresholds}
        self.percentiles: dict[tuple[str, int], Floats] = {
            (quantity, percentile): np.zeros(shape)
            for quantity in QUANTITIES
            for percentile in percentiles
        }

    def add(self, begin: int, end: int, maps: Iterator[PeakMaps]) -> None:
        """Fill the rows from `begin` to before `end` from the maps of all runs."""
        values = np.empty((len(QUANTITIES), self.runs, end - begin, self.shape[1]), np.float32)
        for run, run_maps in enumerate(maps):
            if run_maps.shape != self.shape:
                raise InputError("the slides of the study are on different grids")
            for place, quantity in enumerate(QUANTITIES):
                values[place, run] = run_maps.window(quantity, begin, end)
        for place, quantity in enumerate(QUANTITIES):
            for key in self.counts:
                if key[0] == quantity:
                    self.counts[key][begin:end] = (values[place] > key[1]).sum(axis=0)
            wanted = [percentile for name, percentile in self.percentiles if name == quantity]
            found_values = np.percentile(values[place], wanted, axis=0)
            for share, cut in zip(wanted, found_values):
                self.percentiles[quantity, share][begin:end] = cut

    def exceedances(self) -> list[Exceedance]:
        return [
            Exceedance(*key, count / self.runs, *wilson_interval(count, self.runs))
            for key, count in self.counts.items()
        ]


def _bands(shape: tuple[int, ...], runs: int) -> Iterator[tuple[int, int]]:
    """Yield ranges of rows that fit into the memory for all runs."""
    rows, columns = shape
    height = max(1, math.floor(BAND_BYTES / (4 * len(QUANTITIES) * runs * columns)))
    for begin in range(0, rows, height):
        yield begin, min(begin + height, rows)


def stored_maps(store: Store, hash_: str) -> PeakMaps:
    """Return the peak maps of a run.

    Raises
    ------
    InputError
        If the store has none, or they are damaged.
    """
    for data in store.particles(hash_).values():
        try:
            return PeakMaps.unpacked(data)
        except InputError as error:
            raise store.damaged(f"run {hash_}: {error}") from None
    raise InputError(
        f"{store.folder}: run {hash_} kept no maps; compute it with "
        f"{argument('keep_particles', True)}"
    )


def moving_notes(table: pd.DataFrame, runs: int) -> list[str]:
    """Return a note on the slides that were still moving at the time limit, if there are any.

    Parameters
    ----------
    table
        The table of the study, as from `read_table`.
    runs
        Number of computed slides.
    """
    moving = int((table["ended"] == "time_limit").sum())
    if not moving:
        return []
    return [f"In {moving} of {runs} runs the slide had not come to rest at the time limit."]


def _check(reached: float, pressures: Sequence[float], percentiles: Sequence[int]) -> None:
    for value in (reached, *pressures):
        if not 0.0 <= value < math.inf:
            raise InputError(f"{value:g} is not a threshold; allowed: finite numbers from 0")
    for value in percentiles:
        if not 0 <= value <= 100:
            raise InputError(f"{value:g} is not a percentile; allowed: 0 to 100")


def hazard_facts(maps: HazardMaps) -> dict[str, Any]:
    """Return the numbers of the maps as JSON data: areas by probability, and their uncertainty."""
    return {
        "runs": maps.runs,
        "failed": maps.failed,
        "cell_m": maps.terrain.cell,
        "exceedances": [
            {
                "quantity": exceedance.quantity,
                "threshold": exceedance.threshold,
                "unit": QUANTITIES[exceedance.quantity][0],
                "largest_probability": float(exceedance.probability.max()),
                "area_m2": {f"{level:g}": maps.area(exceedance, level) for level in LEVELS},
            }
            for exceedance in maps.exceedances
        ],
        "largest_values": {
            f"{quantity}_p{percentile}": float(values.max())
            for (quantity, percentile), values in maps.percentiles.items()
        },
        "interval": {
            "method": "Wilson, 95 %",
            "of_never": [float(end) for end in wilson_interval(0, maps.runs)],
            "of_half": [float(end) for end in wilson_interval(maps.runs / 2, maps.runs)],
        },
    }


def uncertainty(runs: int) -> str:
    """Return a sentence on the uncertainty of probabilities from a number of runs.

    Examples
    --------
    >>> uncertainty(50)[:60]
    'With 50 runs a probability of 50 % is 37 to 63 % (95 % inter'
    """
    low, high = (100.0 * float(end) for end in wilson_interval(runs / 2, runs))
    rare = 100.0 * float(wilson_interval(0, runs)[1])
    return (
        f"With {runs} runs a probability of 50 % is {low:.0f} to {high:.0f} % (95 % interval, "
        f"Wilson), and a place that no run reached has a probability of at most {rare:.1f} %."
    )
