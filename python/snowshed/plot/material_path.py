"""Picture of the states of snow along a path, as from `snowshed.snow.follow_path`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context

from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.plot.figure_style import COLOURS, INK, STYLE, blank_figure
from snowshed.scene.components import Snow

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 9.0, 4.0  # inches


@checked
def point_figure(table: pd.DataFrame, snow: Snow) -> Figure:
    """Draw the stresses over the first strain, and the path in the plane of p and q.

    Parameters
    ----------
    table
        As from `follow_path`.
    snow
        The snow of the path. Its yield surface is drawn at the start and at the end.
    """
    with rc_context(STYLE):
        figure = blank_figure(WIDTH, HEIGHT)
        left, right = figure.subplots(1, 2)
        directions = [name for name in table if str(name).startswith("stress_")]
        for name, colour in zip(directions, COLOURS):
            left.plot(table.strain_1, table[name] / 1e3, color=colour,
                      label=f"direction {str(name)[-1]}")  # fmt: skip
        left.set_xlabel("strain 1")
        left.set_ylabel("stress, kPa (tension positive)")
        left.legend()
        for place, line in ((0, ":"), (-1, "-")):
            p, q = _surface(snow, float(table.preconsolidation_pressure.iloc[place]))
            moment = "start" if place == 0 else "end"
            right.plot(p / 1e3, q / 1e3, line, color=INK, label=f"yield surface, {moment}")
        right.plot(table.pressure / 1e3, table.mises / 1e3, color=COLOURS[0], label="path")
        right.set_xlabel("pressure p, kPa")
        right.set_ylabel("Mises stress q, kPa")
        right.legend()
    return figure


def _surface(snow: Snow, strength: float) -> tuple[Floats, Floats]:
    """Return points of the yield surface (thesis 1.2.6) at a preconsolidation pressure, Pa."""
    cohesion, slope = float(snow.cohesion or 0.0), float(snow.critical_state_slope or 0.0)
    p = np.linspace(-cohesion * strength, strength, 200)
    square = slope**2 * (p + cohesion * strength) * (strength - p) / (1.0 + 2.0 * cohesion)
    return p, np.sqrt(np.maximum(square, 0.0))
