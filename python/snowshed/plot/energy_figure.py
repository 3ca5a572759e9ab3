"""The energies of a run over time: the energy of the snow, and its losses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from snowshed.plot.caption import scene_caption
from snowshed.plot.figure_style import COLOURS, FAINT, INK, STYLE, blank_figure, describe

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

#: Energies stored in the snow.
STORED = ("kinetic_j", "elastic_j", "bonds_j")
#: Energies of height, whose zero is arbitrary.
POTENTIAL = ("gravitational_j", "potential_j")
#: The other columns that are not losses.
SUMS = ("added_j", "residual_j")
MIN_DRAWN_SHARE = 1e-3  # smaller shares of the largest energy are not drawn
SCALES = ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ"))
WIDTH, HEIGHT = 9.0, 6.4  # inches
MAX_MARKED_EVENTS = 40  # events whose ends are marked


def energy_figure(table: pd.DataFrame, scene: Mapping[str, Any]) -> Figure:
    """Draw the energy balance of a run over time.

    Above: the energy of the snow, kinetic and elastic. Below: the cumulative energy from height and
    new snow, and its sinks. Thin vertical lines mark the beginnings of events.

    Parameters
    ----------
    table
        Rows of energies in J with ``event`` and ``time_s``, as in ``energy_history.csv``.
    scene
        Complete scene data, as in scene.json.

    Examples
    --------
    >>> import pandas as pd
    >>> from snowshed import Scene
    >>> rows = {"event": [1, 1], "time_s": [0.0, 1.0], "kinetic_j": [0, 2e-3],
    ...         "gravitational_j": [0.01, 0.005], "friction_j": [0, 3e-3], "added_j": [0.01, 0.01]}
    >>> figure = energy_figure(pd.DataFrame(rows), Scene.preset("lab-50").resolve().data)
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['energy, mJ', 'energy, mJ']
    """
    energies = [str(name) for name in table if str(name).endswith("_j")]
    stored = [name for name in STORED if name in energies]
    taken = [name for name in energies if name not in (*STORED, *POTENTIAL, *SUMS)]
    height = sum(table[name] for name in energies if name in POTENTIAL)
    released = (table["added_j"] - height).rename("released")
    with rc_context(STYLE):
        figure = blank_figure(WIDTH, HEIGHT)
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 3))
        per_width = " per m of width" if scene.get("dimension") == 2 else ""
        _draw(above, table, {name: table[name] for name in stored}, per_width)
        above.set_title("In the snow")
        lines = {name: table[name] for name in taken}
        largest = max((np.abs(line).max() for line in (released, *lines.values())), default=0.0)
        visible = {
            n: line for n, line in lines.items() if np.abs(line).max() > MIN_DRAWN_SHARE * largest
        }
        shown = {"released from height and added": released, **visible}
        if "residual_j" in table:
            shown["gained (+) or lost by time integration"] = table["residual_j"]
        _draw(below, table, shown, per_width)
        below.set_title("Cumulative released energy and its sinks")
        below.set_xlabel("time through all events, s")
        describe(figure, f"Energy balance\n{_caption(scene)}")
    return figure


def _caption(scene: Mapping[str, Any]) -> str:
    if scene.get("terrain") or scene.get("sample"):
        return str(scene.get("title", ""))
    return scene_caption(dict(scene))


def _draw(
    axes: Axes, table: pd.DataFrame, lines: Mapping[str, pd.Series[float]], per_width: str
) -> None:
    """Draw energies against time, each with its name and its own colour."""
    scale, unit = _scale(max((float(np.abs(line).max()) for line in lines.values()), default=1.0))
    times = table["time_s"]
    colours = iter((*COLOURS, "#5b4b8a", "#7a2e3a", "#22747c"))
    for name, line in lines.items():
        look: dict[str, Any] = {"color": next(colours), "lw": 1.5}
        if name.startswith("released"):
            look = {"color": INK, "lw": 2.0}
        elif name.startswith("gained"):
            look = {"color": FAINT, "lw": 1.3, "ls": "--"}
        axes.plot(times, line / scale, label=_energy_name(name), **look)
    for begun in _beginnings(table):
        axes.axvline(begun, color=FAINT, lw=0.6, ls=":", zorder=0)
    axes.set_ylabel(f"energy, {unit}{per_width}")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _beginnings(table: pd.DataFrame) -> Sequence[float]:
    """Return the times at which events after the first began; empty if there are too many."""
    begun = table.groupby("event")["time_s"].min().tolist()[1:]
    return begun if len(begun) <= MAX_MARKED_EVENTS else []


def _energy_name(name: str) -> str:
    return name[: -len("_j")].replace("_", " ") if name.endswith("_j") else name


def _scale(largest: float) -> tuple[float, str]:
    """Return the largest unit in which an energy is at least 1, else the smallest unit."""
    return next((scale for scale in SCALES if largest >= scale[0]), SCALES[-1])
