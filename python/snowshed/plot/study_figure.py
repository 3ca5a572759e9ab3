"""The picture of a study: the results of its runs over each varied parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from snowshed.base.formatting import plural
from snowshed.plot.figure_style import BODY, STACK, STYLE, blank_figure, headline
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

#: Quantities of each method's runs to draw: at most two that exist.
MEASURES = {
    "height_m": "height of the stack, m",
    "length_m": "length of the stack, m",
    "run_out_m": "run-out, m",
    "peak_thickness_m": "largest thickness, m",
    "strength_pa": "strength, Pa",
    "tangent_modulus_pa": "tangent modulus, Pa",
}
MAX_PARAMETERS = 8
COLUMN_WIDTH, ROW_HEIGHT = 3.0, 2.6  # inches


def study_figure(table: pd.DataFrame, axes: Sequence[str], title: str) -> Figure:
    """Draw the measures of a study's runs after their last event over the parameters that vary.

    Parameters
    ----------
    table
        From `read_table`.
    axes
        Paths of the parameters that vary; the first eight are drawn.
    title
        The study's name.

    Returns
    -------
    matplotlib.figure.Figure
        Dots are runs. If runs share values, a line joins the medians of equal values.

    Examples
    --------
    >>> import pandas as pd
    >>> runs = {"hash": ["a", "b"], "event": 1, "panel.tilt": [40, 50], "height_m": [0.2, 0.3]}
    >>> len(study_figure(pd.DataFrame(runs), ["panel.tilt"], "tilts").axes)
    1
    """
    done = table[table["error"].fillna("") == ""] if "error" in table else table
    last = done.sort_values("event", kind="stable").groupby("hash", sort=False).tail(1)
    measures = [name for name in MEASURES if name in last and last[name].notna().any()][:2]
    shown = [path for path in axes if path in last][:MAX_PARAMETERS]
    with rc_context(STYLE):
        rows, columns = max(len(measures), 1), max(len(shown), 1)
        figure = blank_figure(1.2 + COLUMN_WIDTH * columns, 0.9 + ROW_HEIGHT * rows)
        count = plural(len(last), "run")
        headline(figure, f"{title}: {count}, each after its last event")
        grid = figure.subplots(rows, columns, squeeze=False, sharey="row")
        for row, measure in enumerate(measures):
            for column, path in enumerate(shown):
                _draw(grid[row][column], last, path, measure)
            grid[row][0].set_ylabel(MEASURES[measure])
        for column, path in enumerate(shown):
            for above in grid[:-1, column]:
                above.tick_params(labelbottom=False)
            grid[-1][column].set_xlabel(label(path).axis)
        if not (measures and shown):
            grid[0][0].set_axis_off()
            grid[0][0].text(0.5, 0.5, "nothing to show", ha="center", va="center")
        return figure


def _draw(axes: Axes, runs: pd.DataFrame, path: str, measure: str) -> None:
    """Draw a measure over a parameter: numbers along an axis, other values side by side."""
    import pandas as pd

    values = pd.to_numeric(runs[path], errors="coerce")
    categories = runs[path].map(str)
    if values.notna().all() and runs[path].dtype != bool:
        positions = values / label(path).scale
        if positions.min() > 0 and positions.max() > 30 * positions.min():
            axes.set_xscale("log")
    else:
        names = list(dict.fromkeys(categories))
        positions = categories.map({name: float(place) for place, name in enumerate(names)})
        axes.set_xticks(range(len(names)), [_short(name) for name in names])
        axes.set_xlim(-0.5, len(names) - 0.5)
    results = runs[measure].astype(float)
    axes.scatter(positions, results, s=14, color=STACK, alpha=0.6, linewidths=0)
    medians = results.groupby(np.round(positions.astype(float), 12)).median()
    if 1 < len(medians) < len(runs):
        axes.plot(medians.index, medians, color=BODY, linewidth=1.2)
    axes.set_ylim(bottom=min(0.0, float(results.min())))


def _short(name: str) -> str:
    return name if len(name) <= 14 else f"…{name[-13:]}"
