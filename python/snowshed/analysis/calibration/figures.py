"""Figures of chapter 4 and of the posterior."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from snowshed.analysis.calibration.comparison import SET
from snowshed.analysis.calibration.misfit import RANKING_QUANTITIES
from snowshed.analysis.calibration.posterior import LEVELS, Posterior
from snowshed.analysis.calibration.surrogate import EXTRA
from snowshed.base.arrays import Booleans
from snowshed.base.extras import require
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, STYLE, blank_figure, headline
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

PLAIN, BEST, ALLOWED = "#9fb4c2", BODY, COLOURS[0]
MAX_NAMED_SETS = 60  # parameter sets that are named below their bars
BAND = (2.5, 16.0, 84.0, 97.5)  # percentiles
PREDICTION_SAMPLES = 400  # samples that predictions are drawn from


def relative_error_figure(ranked: pd.DataFrame, parameters: Sequence[str]) -> Figure:
    """Draw the mean relative error of every parameter set, as Figure 4.2.1.

    Parameters
    ----------
    ranked
        From `rank_sets`.
    parameters
        Dotted paths of the parameters.
    """
    panels = [
        (f"stack {quantity}", f"{quantity}_relative_error")
        for quantity in RANKING_QUANTITIES
        if f"{quantity}_relative_error" in ranked
    ]
    return _bars(
        ranked,
        parameters,
        panels,
        "Mean relative error, (measured - simulated) / measured",
        "mean relative error",
    )


def rmse_figure(ranked: pd.DataFrame, parameters: Sequence[str]) -> Figure:
    """Draw the RMSE of every parameter set, and the rescaled mean, as Figure 4.2.2.

    Parameters
    ----------
    ranked
        From `rank_sets`.
    parameters
        Dotted paths of the parameters.
    """
    panels = [
        (f"stack {quantity}: RMSE, m", f"{quantity}_rmse_m")
        for quantity in RANKING_QUANTITIES
        if f"{quantity}_rmse_m" in ranked
    ]
    panels.append(("mean of both, rescaled to 0 to 1", "rescaled_rmse"))
    return _bars(ranked, parameters, panels, "Root mean square error of every parameter set", "")


def _bars(
    ranked: pd.DataFrame,
    parameters: Sequence[str],
    panels: Sequence[tuple[str, str]],
    title: str,
    label: str,
) -> Figure:
    """Draw one bar per parameter set in each panel, the best set highlighted."""
    rows = ranked.sort_values(list(parameters))
    best = rows["rank"].to_numpy() == 1
    colours = np.where(best, BEST, PLAIN)
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(max(7.0, 1.5 + 0.17 * len(rows)), 1.2 + 2.0 * len(panels))
        headline(figure, title)
        grid = np.ravel(figure.subplots(len(panels), 1, sharex=True, squeeze=False))
        for axes, (name, column) in zip(grid, panels):
            axes.bar(range(len(rows)), rows[column], 0.8, color=colours)
            axes.axhline(0, color=INK, linewidth=0.8)
            axes.set_title(name)
            axes.set_ylabel(label)
            axes.grid(axis="x", visible=False)
        grid[-1].set_xlim(-0.8, len(rows) - 0.2)
        _name_sets(grid[-1], rows, parameters, best)
        keys = [Patch(color=BEST, label="lowest mean rescaled RMSE"), Patch(color=PLAIN)]
        keys[1].set_label("other parameter sets")
        figure.legend(handles=keys, loc="outside lower center", ncols=2)
    return figure


def _name_sets(axes: Axes, rows: pd.DataFrame, parameters: Sequence[str], best: Booleans) -> None:
    labels = [label(path) for path in parameters]
    axes.set_xlabel(
        " · ".join(f"{word.symbol} ({word.unit})" if word.unit else word.symbol for word in labels)
    )
    if len(rows) > MAX_NAMED_SETS:
        axes.set_xticks([])
        return
    names = [
        " · ".join(label(path).value(value) for path, value in zip(parameters, values))
        for values in rows[list(parameters)].to_numpy(float)
    ]
    axes.set_xticks(range(len(rows)), names, rotation=90, fontsize=9)
    for text, is_best in zip(axes.get_xticklabels(), best):
        if is_best:
            text.set(color=BEST, weight="bold")


def fit_figure(
    comparison: pd.DataFrame, best: int, posterior: Posterior, predictions: pd.DataFrame
) -> Figure:
    """Draw measured stacks, stacks of the best set, and stacks that the posterior allows.

    Parameters
    ----------
    comparison
        From `compare_stacks`.
    best
        Number of the best parameter set.
    posterior
        The posterior whose quantities are drawn.
    predictions
        From `predicted_bands`.
    """
    tilts = sorted(comparison["tilt"].unique())
    quantities = list(posterior.quantities)
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1.6 + 3.0 * len(tilts), 1.3 + 2.3 * len(quantities))
        headline(figure, "Measured and simulated stacks")
        grid = figure.subplots(
            len(quantities), len(tilts), sharex=True, sharey="row", squeeze=False
        )
        for row, quantity in zip(grid, quantities):
            for axes, tilt in zip(row, tilts):
                here = (comparison["quantity"] == quantity) & (comparison["tilt"] == tilt)
                of_best = comparison[here & (comparison[SET] == best)].sort_values("event")
                bands = predictions[
                    (predictions["quantity"] == quantity) & (predictions["tilt"] == tilt)
                ]
                _draw_fit(axes, of_best, bands)
                axes.set_title(f"{quantity}, tilt {tilt:g}°")
            row[0].set_ylabel(f"{quantity}, m")
        for axes in grid[-1]:
            axes.set_xlabel("event")
        keys: list[Any] = [
            Line2D([], [], color=INK, marker="o", ls="", label="measured ± 1 standard deviation"),
            Line2D([], [], color=BEST, label="best parameter set of the grid"),
            Patch(color=ALLOWED, alpha=0.35, label="posterior, 68 %"),
            Patch(color=ALLOWED, alpha=0.15, label="95 %"),
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=2)
    return figure


def _draw_fit(axes: Axes, of_best: pd.DataFrame, bands: pd.DataFrame) -> None:
    bands = bands.sort_values("event")
    events = bands["event"].to_numpy(float)
    for low, high, alpha in (("p2.5", "p97.5", 0.15), ("p16", "p84", 0.25)):
        axes.fill_between(events, bands[low], bands[high], color=ALLOWED, alpha=alpha, lw=0)
    axes.plot(of_best["event"], of_best["simulated"], color=BEST, linewidth=1.6)
    axes.errorbar(
        of_best["event"],
        of_best["value"],
        of_best["uncertainty"],
        fmt="o",
        color=INK,
        markersize=4,
        elinewidth=1,
        capsize=2,
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def predicted_bands(posterior: Posterior, *, seed: int = 1) -> pd.DataFrame:
    """Return predictions of single runs of the snow that the posterior allows.

    Returns
    -------
    pandas.DataFrame
        ``quantity``, ``tilt``, ``event``, and the percentiles ``p2.5``, ``p16``, ``p84`` and
        ``p97.5`` in m; they include the seeding noise and the surrogate's uncertainty.
    """
    import pandas as pd

    surrogate = posterior.surrogate
    every = max(1, len(posterior.samples) // PREDICTION_SAMPLES)
    means, variances = surrogate.predict(surrogate.unit(posterior.samples[::every]))
    noise = np.random.default_rng(seed).normal(size=means.shape)
    levels = np.percentile(means + noise * np.sqrt(variances), BAND, axis=1).T
    names = [f"p{level:g}" for level in BAND]
    return pd.DataFrame(
        [
            {"quantity": quantity, "tilt": tilt, "event": event, **dict(zip(names, row))}
            for (quantity, tilt, event), row in zip(surrogate.outputs, levels)
        ]
    )


def posterior_figure(posterior: Posterior, best: pd.Series[float]) -> Figure:
    """Draw the posterior of the parameters: one by one on the diagonal, in pairs below it.

    Parameters
    ----------
    posterior
        The posterior whose samples are drawn.
    best
        The parameters of the grid's best set, marked for comparison.

    Raises
    ------
    InputError
        If corner (extra ``calibration``) is not installed.
    """
    corner = require("corner", EXTRA, "the figure of the posterior")
    paths = list(posterior.surrogate.parameters)
    scales = np.array([label(path).scale for path in paths])
    low, high = posterior.surrogate.low / scales, posterior.surrogate.high / scales
    with matplotlib.rc_context({**STYLE, "axes.grid": False}):
        # Without a layout: corner places its diagrams itself.
        figure = Figure(figsize=(1.2 + 2.1 * len(paths), 1.4 + 2.0 * len(paths)))
        corner.corner(
            posterior.samples / scales,
            bins=30,
            range=list(zip(low, high)),
            labels=[label(path).axis for path in paths],
            truths=[float(best[path]) / scale for path, scale in zip(paths, scales)],
            truth_color=BEST,
            quantiles=[*LEVELS.values()],
            levels=(0.68, 0.95),
            smooth=1.0,
            color=ALLOWED,
            plot_datapoints=False,
            hist_kwargs={"density": True},
            fig=figure,
        )
        for number, axes in enumerate(figure.axes[:: len(paths) + 1]):
            axes.axhline(1 / (high[number] - low[number]), color=FAINT, linestyle=":")
        headline(figure, "Parameters that the measurements allow")
        keys = [
            Line2D([], [], color=ALLOWED, ls="--", label="median, 68 % and 95 %"),
            Line2D([], [], color=FAINT, ls=":", label="before measuring"),
            Line2D([], [], color=BEST, marker="s", label="best set of the grid"),
        ]
        figure.legend(handles=keys, loc="upper right")
    return figure
