"""Settings of the reproduction: those of the thesis, or a trial within minutes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from snowshed.analysis.calibration.parameter_grid import COHESION, GRID, PRESSURE, SLOPE
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.methods.mpm.settings import Scheme
from snowshed.scene.components import Condition

#: Friction of the panel if a single value is used: the smallest static coefficient in the thesis.
MEASURED_FRICTION = 0.6


@dataclass(frozen=True)
class Settings:
    """The extent and the resolution of a reproduction.

    Attributes
    ----------
    dimension, dx
        Dimension of the simulations of snow in chapters 3 and 4, and their grid size (m), also for
        the laboratory.
    lab_dimensions
        Dimensions of the laboratory.
    frictions, release_frictions
        Friction of the panel in the laboratory, and at 30 degrees.
    lab_seeds, index_seeds, fixation_seeds, grid_seeds
        Random seeds per point of the stages.
    grid_events
        Events of the calibration.
    slopes, pressures, cohesions
        Values of M, p0 (Pa) and beta in the triplets of the calibration.
    steps
        Steps of the posterior's Markov chains.
    simulates_panels
        Whether the panels of chapter 5 are simulated (the thesis's 122, and those with more tilts);
        else the rows are those of the data set in snowshed.
    deviation_dx
        Sizes of the grid cells (m) in the runs that undo deviations one by one: ours, and one that
        stands for the thesis's. Their ratio is that of 1.5 cm to 1 cm.
    deviation_panels, deviation_max_length, deviation_seeds
        Every n-th panel of the data set is simulated, up to a length, m, with a number of seeds. (n
        has no factor in common with the numbers of lengths; otherwise lengths would repeat.)
    folds
        Folds of the nested cross-validation.
    one_seed_rounds
        Rounds of the folds for the rows of one seed, if rows are means over several seeds.
    condition
        Contact condition of the panel: "separate" (our default) or "slip" (the thesis's).
    scheme
        Scheme of the MPM. Deviations from the thesis are undone only with the scheme "thesis".
    """

    dimension: int
    dx: float
    frictions: Sequence[float]
    release_frictions: Sequence[float]
    lab_seeds: int
    index_seeds: int
    fixation_seeds: int
    grid_seeds: int
    grid_events: int
    slopes: Sequence[float]
    pressures: Sequence[float]
    cohesions: Sequence[float]
    steps: int
    simulates_panels: bool
    deviation_dx: tuple[float, float]
    deviation_panels: int
    deviation_max_length: float
    deviation_seeds: int
    folds: CrossValidation
    one_seed_rounds: int
    lab_dimensions: Sequence[int] = (2, 3)
    condition: Condition = "separate"
    scheme: Scheme = "thesis"


FULL = Settings(
    dimension=3,
    dx=0.01,
    frictions=(0.3, 0.6, 0.8),
    release_frictions=(0.3, 0.5, 0.6),
    lab_seeds=4,
    index_seeds=4,
    fixation_seeds=2,
    grid_seeds=2,
    grid_events=5,
    slopes=GRID[SLOPE],
    pressures=GRID[PRESSURE],
    cohesions=GRID[COHESION],
    steps=2000,
    simulates_panels=True,
    deviation_dx=(0.015, 0.01),
    deviation_panels=4,
    deviation_max_length=10.0,
    deviation_seeds=2,
    folds=CrossValidation(),
    one_seed_rounds=10,
)
#: The thesis's dimensions, cells and events, with the frictions that it measured, fewer seedings,
#: and the panels that come with snowshed.
MIDDLE = replace(
    FULL,
    frictions=(0.6, 0.8),
    release_frictions=(0.5, 0.6),
    lab_seeds=2,
    index_seeds=2,
    fixation_seeds=1,
    grid_seeds=1,
    simulates_panels=False,
    deviation_panels=7,
    deviation_max_length=2.0,
    deviation_seeds=1,
    folds=CrossValidation(rounds=3),
    one_seed_rounds=3,
)
#: The same in 2D.
PLANAR = replace(MIDDLE, dimension=2, lab_dimensions=(2,))
QUICK = Settings(
    dimension=2,
    dx=0.02,
    frictions=(0.3, 0.6),
    release_frictions=(0.3, 0.6),
    lab_seeds=2,
    index_seeds=2,
    fixation_seeds=1,
    grid_seeds=1,
    grid_events=3,
    slopes=(0.4, 0.5, 0.7),
    pressures=(4e3, 7e3),
    cohesions=(0.05, 0.2),
    steps=500,
    simulates_panels=False,
    deviation_dx=(0.03, 0.02),
    deviation_panels=7,
    deviation_max_length=1.0,
    deviation_seeds=1,
    folds=CrossValidation(rounds=2, folds=5, inner_folds=3),
    one_seed_rounds=1,
)
