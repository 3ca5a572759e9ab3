"""The error of the grid in predictions, from stacks below panels on several grids.

Some panels of the data set were computed on coarser and finer grids, too (``data/README.md``). The
mean stacks on the grid of a model's rows differ from those on the finest grid by factors. The root
mean square of their logarithms over the panels is the error of the grid in a prediction. It
contains the noise of the few seeds. The snow was calibrated on a grid of its own, so a prediction
may be too large or too small by such a factor.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.analysis.accuracy.mechanisms import SCHEME, Mechanisms
from snowshed.analysis.regression.dataset import FOLDER, MODEL_BETWEEN
from snowshed.analysis.regression.rows import INPUTS, TARGETS
from snowshed.base.arrays import Floats
from snowshed.base.formatting import number

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.analysis.regression.model_file import StackModel

TABLE = FOLDER / "geometry-grids.csv"
CELLS, DAMPING, EVENT = "dx", "damping_rate", "event"
PANEL = ("panel.tilt", "panel.length")
#: Columns of the record.
COLUMNS = (SCHEME, DAMPING, CELLS, *PANEL, "seed", EVENT, "height_m", "length_m")
#: Settings of the recorded stacks that a model's rows must share.
RECORDED_WITH = {
    "dimension": "2",
    "events.between": MODEL_BETWEEN,
    "trimming": "outermost_first",
}
#: Largest ratio between a model's cells and the recorded ones, in either direction.
MAX_CELL_RATIO = 1.1
#: Half width of an interval that contains 90 % of a normal distribution, in standard deviations.
NORMAL_90 = 1.645


@dataclass(frozen=True)
class PanelGridError:
    """The error of the grid in stacks below panels.

    Attributes
    ----------
    mean, root_mean_square
        Mean and root mean square, over the panels, of the logarithm of a stack's ratio to that on
        the finest grid: for each target an array with a value after each event.
    cells, finest_cells
        Size of the cells, and of those of the finest recorded grid, m.
    panels
        Number of recorded panels.
    """

    mean: Mapping[str, Floats]
    root_mean_square: Mapping[str, Floats]
    cells: float
    finest_cells: float
    panels: int

    def factors(self, target: str, events: Floats) -> Floats:
        """Return the factors within which 90 % of the errors lie, if their logarithms are normal.

        Events after the last recorded one have its factor.
        """
        sizes = self.root_mean_square[target]
        return np.exp(NORMAL_90 * sizes[np.minimum(events.astype(int), len(sizes)) - 1])

    @property
    def sentence(self) -> str:
        """The error in a sentence, with its source."""
        return (
            f"below {self.panels} panels, stacks on these cells of {_cm(self.cells)} cm are "
            f"{self._span('height', ('higher', 'lower'))} and "
            f"{self._span('length', ('longer', 'shorter'))} on average than those on "
            f"{_cm(self.finest_cells)} cm, which are not converged either"
        )

    def _span(self, target: str, words: tuple[str, str]) -> str:
        ratios = np.exp(self.mean[target])
        low, high = 100 * (ratios.min() - 1), 100 * (ratios.max() - 1)
        if low < 0 < high:
            return f"{-low:.0f} % {words[1]} to {high:.0f} % {words[0]}"
        near, far = sorted((abs(low), abs(high)))
        return f"{near:.0f} to {far:.0f} % {words[0] if low >= 0 else words[1]}"


def recorded_grid_error(model: StackModel) -> Optional[PanelGridError]:
    """Return the error of the grid in the rows of a model.

    Parameters
    ----------
    model
        The model.

    Returns
    -------
    PanelGridError or None
        None if no stacks were recorded for the model's inputs and settings: the mechanisms of its
        scheme, `RECORDED_WITH`, and the size of the cells.

    Examples
    --------
    >>> from snowshed.analysis.regression.dataset import MODEL
    >>> from snowshed.analysis.regression.model_file import load_model
    >>> error = recorded_grid_error(load_model(MODEL))
    >>> error.cells, error.finest_cells, error.panels
    (0.015, 0.005, 8)
    """
    settings = model.settings
    common = {name: settings.get(name) for name in RECORDED_WITH}
    if tuple(model.names) != INPUTS or model.measure != "stack" or common != RECORDED_WITH:
        return None
    stacks = _recorded().get(Mechanisms.of_texts(settings).label)
    return None if stacks is None else _error(stacks, float(settings[CELLS]))


@cache
def _recorded() -> Mapping[str, pd.DataFrame]:
    """Return recorded mean stacks by the label of their mechanisms.

    A table has a row for each panel and event, and the columns (target, size of the cells).
    """
    import pandas as pd

    rows = pd.read_csv(TABLE)
    means = rows.groupby([SCHEME, DAMPING, *PANEL, EVENT, CELLS])[["height_m", "length_m"]].mean()
    means = means.rename(columns={"height_m": "height", "length_m": "length"})
    means["ratio"] = means["height"] / means["length"]
    by_scheme = means.unstack(CELLS).groupby([SCHEME, DAMPING])
    return {
        Mechanisms.of_settings({SCHEME: scheme, DAMPING: damping}).label: table.droplevel([0, 1])
        for (scheme, damping), table in by_scheme
    }


def _error(stacks: pd.DataFrame, cells: float) -> Optional[PanelGridError]:
    recorded = np.array(sorted(stacks.columns.unique(CELLS)))
    nearest = recorded[np.abs(np.log(recorded / cells)).argmin()]
    if nearest == recorded[0] or not 1 / MAX_CELL_RATIO < nearest / cells < MAX_CELL_RATIO:
        return None
    finest = recorded[0]
    stacks = stacks.dropna(subset=[("height", nearest), ("height", finest)])
    deviations: dict[str, Any] = {
        target: np.log(stacks[target, nearest] / stacks[target, finest]).groupby(EVENT)
        for target in TARGETS
    }
    return PanelGridError(
        mean={target: each.mean().to_numpy() for target, each in deviations.items()},
        root_mean_square={
            target: np.sqrt(each.agg(lambda values: np.mean(values**2)).to_numpy())
            for target, each in deviations.items()
        },
        cells=float(nearest),
        finest_cells=float(finest),
        panels=len(stacks.index.droplevel(EVENT).unique()),
    )


def _cm(length: float) -> str:
    return number(100 * length, 2)
