"""Ranking, parameter ranges and figures from measurements and a stored study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.calibration.comparison import (
    SimulatedStacks,
    compare_stacks,
    read_simulated_stacks,
)
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.calibration.misfit import RANKING_QUANTITIES, rank_sets, statistics
from snowshed.analysis.calibration.posterior import STEPS, Posterior, outputs_of, sample_posterior
from snowshed.analysis.calibration.surrogate import EXTRA, Surrogate
from snowshed.base.arguments import checked
from snowshed.base.callers import STUDY_RESUME, either
from snowshed.base.extras import require
from snowshed.base.notes import ResultNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.csv_table import write_csv
from snowshed.snow.stack.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas as pd

#: Share of the runs' variance that a surrogate should explain.
MIN_EXPLAINED_VARIANCE = 0.5


@dataclass(frozen=True)
class Calibration:
    """The result of a calibration.

    Attributes
    ----------
    stacks
        The simulated stacks.
    comparison
        Simulated beside measured values; see `compare_stacks`.
    ranked
        The parameter sets, the best first; see `rank_sets`.
    posterior
        The posterior of the parameters.
    """

    stacks: SimulatedStacks
    comparison: pd.DataFrame
    ranked: pd.DataFrame
    posterior: Posterior

    @property
    def best(self) -> pd.Series[float]:
        """The row of `ranked` with the lowest mean rescaled RMSE."""
        return self.ranked.iloc[0]

    @property
    def ranges(self) -> pd.DataFrame:
        """The ranges of the parameters, with the best set beside them; see `Posterior.ranges`."""
        ranges = self.posterior.ranges()
        ranges["best_set"] = [float(self.best[path]) for path in ranges["parameter"]]
        return ranges

    @property
    def notes(self) -> list[str]:
        """Notes on the limits of the result, a sentence each."""
        notes = []
        if self.stacks.pending:
            notes.append(
                f"{self.stacks.pending} runs of the study are not computed yet: ranks and "
                f"ranges omit them ({either(*STUDY_RESUME)} computes them)"
            )
        missing = len(self.stacks.sets) - len(self.ranked)
        if missing:
            notes.append(f"{missing} parameter sets lack measured stacks and are not ranked")
        if not self.posterior.converged:
            notes.append(
                "the Markov chains have not converged: the ends of the ranges are uncertain"
            )
        accuracy = self.posterior.surrogate.accuracy()
        poor = accuracy[accuracy["explained"] < MIN_EXPLAINED_VARIANCE]
        if len(poor):
            notes.append(
                f"the surrogate explains less than half of the variance of {len(poor)} of "
                f"{len(accuracy)} measured stacks, so they constrain the snow weakly "
                "(surrogate.csv)"
            )
        for number, quantity in enumerate(self.posterior.quantities):
            median = float(np.median(self.posterior.discrepancy[:, number]))
            notes.append(f"error of the model in {quantity}: about {100 * median:.0f} % (median)")
        return notes


@checked
def calibrate(
    measurements: Sequence[Measurement],
    stacks: SimulatedStacks,
    *,
    quantities: Sequence[str] = RANKING_QUANTITIES,
    steps: int = STEPS,
    seed: int = 1,
) -> Calibration:
    """Rank parameter sets as chapter 4 does, and sample the posterior of the parameters.

    Parameters
    ----------
    measurements
        From `read_measurements`.
    stacks
        From `read_simulated_stacks`.
    quantities
        Quantities that the posterior uses, if they were measured. Length is tail - head, so it must
        not be used together with both of them.
    steps
        Steps of the Markov chains.
    seed
        Seed of their random numbers.

    Raises
    ------
    InputError
        If no quantity was measured, a measured stack was not simulated, or a library is missing.
    """
    used = _select_measurements(measurements, quantities)
    comparison = compare_stacks(stacks, measurements)
    ranked = rank_sets(stacks, comparison)
    surrogate = Surrogate.fitted(stacks, outputs_of(used))
    calibration = Calibration(
        stacks, comparison, ranked, sample_posterior(surrogate, used, steps=steps, seed=seed)
    )
    for note in calibration.notes:
        issue_note(note, ResultNote)
    return calibration


def _select_measurements(
    measurements: Sequence[Measurement], quantities: Sequence[str]
) -> list[Measurement]:
    for quantity in quantities:
        if quantity not in QUANTITIES:
            allowed = ", ".join(QUANTITIES)
            raise InputError(f"quantity: {quantity!r} is unknown; allowed: {allowed}")
    if {"length", "head", "tail"} <= set(quantities):
        raise InputError("quantity: length is tail - head; give two of length, head and tail")
    used = [measurement for measurement in measurements if measurement.quantity in quantities]
    if not used:
        raise InputError(f"none of {', '.join(quantities)} was measured")
    return used


def check_libraries() -> None:
    """Raise InputError if a library that the evaluation needs is missing, before runs start."""
    require("sklearn.gaussian_process", EXTRA, "calibration")
    require("emcee", EXTRA, "calibration")
    require("xarray", EXTRA, "calibration")
    require("arviz", EXTRA, "calibration")
    require("corner", EXTRA, "calibration")


@checked
def evaluate_calibration(
    measurements: Sequence[Measurement],
    stored: PathLike,
    folder: PathLike,
    *,
    study: Optional[str] = None,
    measure: str = "stack",
    quantities: Sequence[str] = RANKING_QUANTITIES,
) -> Calibration:
    """Calibrate with the computed runs of a stored study, and write tables and figures.

    Parameters
    ----------
    measurements, quantities
        As for `calibrate`.
    stored
        Folder of the store.
    folder
        Folder for the files, which the docs list.
    study
        Name of the study; not needed if the store holds only one.
    measure
        "stack" or "body"; see `read_simulated_stacks`.

    Raises
    ------
    InputError
        As for `read_simulated_stacks` and `calibrate`.
    """
    calibration = calibrate(
        measurements, read_simulated_stacks(stored, study, measure), quantities=quantities
    )
    write(calibration, Path(folder))
    return calibration


def write(calibration: Calibration, folder: Path) -> None:
    """Write the tables and figures of a calibration into a folder."""
    from snowshed.analysis.calibration import figures
    from snowshed.plot.figure_style import save_figure

    posterior, parameters = calibration.posterior, calibration.stacks.parameters
    bands = figures.predicted_bands(posterior)
    tables = {
        "ranking": calibration.ranked,
        "rmse-statistics": statistics(calibration.ranked).reset_index(),
        "comparison": calibration.comparison,
        "ranges": calibration.ranges,
        "posterior": posterior.table(),
        "surrogate": posterior.surrogate.accuracy(),
    }
    drawings = {
        "relative-error": figures.relative_error_figure(calibration.ranked, parameters),
        "rmse": figures.rmse_figure(calibration.ranked, parameters),
        "fit": figures.fit_figure(
            calibration.comparison, int(calibration.best["set"]), posterior, bands
        ),
        "posterior": figures.posterior_figure(posterior, calibration.best),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables.items():
        write_csv(table, folder / f"{name}.csv")
    with replacing(folder / "posterior.nc") as beside:
        posterior.draws.to_netcdf(beside, engine="scipy")
    for name, figure in drawings.items():
        save_figure(figure, folder / f"{name}.png")
