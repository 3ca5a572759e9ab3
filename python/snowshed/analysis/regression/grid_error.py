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
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed.analysis.regression.dataset import FOLDER, MODEL_BETWEEN
from snowshed.analysis.regression.rows import INPUTS, TARGETS
from snowshed.base.arrays import Floats
from snowshed.base.formatting import number, percent_span
from snowshed.snow.accuracy.mechanisms import SCHEME, Mechanisms
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING

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
    "trimming": DEFAULT_TRIMMING,
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
    others
        Mean, as `mean`, of the logarithm of a stack's ratio by another scheme on the same cells to
        that by this one, for each scheme.
    """

    mean: Mapping[str, Floats]
    root_mean_square: Mapping[str, Floats]
    cells: float
    finest_cells: float
    panels: int
    others: Mapping[str, Mapping[str, Floats]]

    def factors(self, target: str, events: Floats) -> Floats:
        """Return the factors within which 90 % of the errors lie, if their logarithms are normal.

        Events after the last recorded one have its factor.
        """
        sizes = self.root_mean_square[target]
        return np.asarray(np.exp(NORMAL_90 * sizes[np.minimum(events.astype(int), len(sizes)) - 1]))

    @property
    def sentence(self) -> str:
        """The error in a sentence, with its source."""
        schemes = "".join(
            f"; with {scheme} on the same cells they are {_span(mean)}"
            for scheme, mean in self.others.items()
        )
        return (
            f"below {self.panels} panels, stacks on these cells of {_cm(self.cells)} cm are "
            f"{_span(self.mean)} on average than those on {_cm(self.finest_cells)} cm, which are "
            f"not converged either{schemes}"
        )


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
    >>> from snowshed.analysis.regression.dataset import model_file
    >>> from snowshed.analysis.regression.model_file import load_model
    >>> error = recorded_grid_error(load_model(model_file()))
    >>> error.cells, error.finest_cells, error.panels
    (0.015, 0.005, 8)
    """
    settings = model.settings
    common = {name: settings.get(name) for name in RECORDED_WITH}
    if tuple(model.names) != INPUTS or model.measure != "stack" or common != RECORDED_WITH:
        return None
    return _error(Mechanisms.of_texts(settings).label, float(settings[CELLS]))


@cache
def _recorded() -> Mapping[str, pd.DataFrame]:
    """Return recorded mean stacks by the label of their mechanisms.

    A table has a row for each panel and event, and the columns (target, size of the cells) for the
    grids on which the mechanisms were computed.
    """
    import pandas as pd

    rows = pd.read_csv(TABLE)
    means = rows.groupby([SCHEME, DAMPING, *PANEL, EVENT, CELLS])[["height_m", "length_m"]].mean()
    means = means.rename(columns={"height_m": "height", "length_m": "length"})
    means["ratio"] = means["height"] / means["length"]
    wide = pd.DataFrame(means.unstack(CELLS))
    return {
        Mechanisms.of_settings({SCHEME: scheme, DAMPING: damping}).label: (
            table.droplevel([0, 1]).dropna(axis="columns", how="all")
        )
        for (scheme, damping), table in wide.groupby([SCHEME, DAMPING])
    }


def _error(label: str, cells: float) -> Optional[PanelGridError]:
    if label not in _recorded():
        return None
    stacks = _recorded()[label]
    recorded = sorted(map(float, stacks.columns.unique(CELLS)))
    finest, nearest = recorded[0], min(recorded, key=lambda other: abs(np.log(other / cells)))
    if nearest == finest or not 1 / MAX_CELL_RATIO < nearest / cells < MAX_CELL_RATIO:
        return None
    logs = _log_ratio(_on_grid(stacks, nearest), _on_grid(stacks, finest))
    others = {
        other: _means(_log_ratio(_on_grid(table, nearest), _on_grid(stacks, nearest)))
        for other, table in _recorded().items()
        if other != label and nearest in table.columns.unique(CELLS)
    }
    return PanelGridError(
        mean=_means(logs),
        root_mean_square={name: np.sqrt(values) for name, values in _means(logs**2).items()},
        cells=nearest,
        finest_cells=finest,
        panels=len(logs.groupby(list(PANEL))),
        others=others,
    )


def _on_grid(stacks: pd.DataFrame, cells: float) -> pd.DataFrame:
    return stacks[[(target, cells) for target in TARGETS]].droplevel(CELLS, axis=1)


def _log_ratio(over: pd.DataFrame, under: pd.DataFrame) -> pd.DataFrame:
    """Return the logarithms of the ratios of the stacks that are in both tables."""
    return (over / under).dropna().apply(np.log)


def _means(table: pd.DataFrame) -> dict[str, Floats]:
    """Return the means over panels after each event, for each target."""
    means = table.groupby(EVENT).mean()
    return {target: means[target].to_numpy() for target in TARGETS}


def _span(logs: Mapping[str, Floats]) -> str:
    """Return the ratios of heights and lengths over the events as text."""
    words = {"height": ("higher", "lower"), "length": ("longer", "shorter")}
    spans = []
    for name, (more, less) in words.items():
        changes = 100 * (np.exp(logs[name]) - 1)
        spans.append(percent_span(changes.min(), changes.max(), more, less))
    return " and ".join(spans)


def _cm(length: float) -> str:
    return number(100 * length, 2)
