"""The slope from which snow slides over the lower edge: its length, and the snow on it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import snowshed._core as _core
from snowshed.scene.panel_edge import panel_edge
from snowshed.scene.scene import ResolvedScene

#: Snow up to this share of the panel's length beyond its upper edge lies on the panel.
ROUGHNESS = 0.03


@dataclass(frozen=True)
class SnowSlope:
    """The slope above the panel's lower edge when the first event begins.

    Attributes
    ----------
    length
        Length from the lower edge to the upper end of the snow, m.
    load
        Weight of the snow on it over its plan, Pa.
    """

    length: float
    load: float

    @classmethod
    def of(cls, scene: ResolvedScene) -> SnowSlope:
        """Lay the snow of a scene with a panel, and measure the snow in line with the panel.

        The modules of a table are parts of one slope; the far side of a gable roof is none.

        Examples
        --------
        >>> from snowshed.scene import panel_table
        >>> table = panel_table(2, 0.1, module_length=1, height=0.8, tilt=40, snow=0.25, dx=0.05)
        >>> slope = SnowSlope.of(table.resolve())
        >>> round(slope.length, 1), round(slope.load / (210 * 9.81 * 0.25 / 0.766), 2)
        (2.1, 1.0)
        """
        simulation = _core.Simulation(scene.core, scene.base_dir)
        simulation.begin_event()
        panel, edge = scene.data["panel"], panel_edge(scene.data)
        tilt = math.radians(panel["tilt"])
        away = np.asarray(simulation.positions())[:, [0, 2]] - (edge.x, edge.z)
        along = away @ (-math.cos(tilt), math.sin(tilt))
        above = away @ edge.normal
        thickness = float(above[(along > 0.0) & (along < panel["length"])].max(initial=0.0))
        # The far side of a roof reaches beyond the ridge only in the lower half of the snow.
        in_line = (along > 0.0) & (above > 0.5 * thickness) & (above < 1.05 * thickness)
        farthest = float(along[in_line].max(initial=0.0))
        length = (
            farthest if farthest > (1.0 + ROUGHNESS) * panel["length"] else float(panel["length"])
        )
        width = panel["width"] if scene.data["dimension"] == 3 else 1.0
        on_slope = (along > 0.0) & (along < length) & (above > 0.0) & (above < 1.05 * thickness)
        mass = float(np.asarray(simulation.masses())[on_slope].sum())
        plan = length * math.cos(tilt) * width
        return cls(length, mass * scene.data["gravity"] / plan)
