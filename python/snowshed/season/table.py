"""The table of a season: the weather, the snow on the panel, and the stack of the slide-offs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from snowshed.results.season_folder import SEASON_COLUMNS
from snowshed.season.accumulation import WinterDay
from snowshed.season.cover import cover_depths
from snowshed.season.panel_contact import below_panel, clearance
from snowshed.season.settings import SeasonSettings
from snowshed.season.slabs import cover_below_slides
from snowshed.season.stack_settling import SettlingStack

if TYPE_CHECKING:
    import pandas as pd

Row = Mapping[str, Union[str, float, int]]


def season_table(
    scene: Mapping[str, Any],
    days: Sequence[WinterDay],
    settings: SeasonSettings,
    events: pd.DataFrame,
    outlines: pd.DataFrame,
) -> pd.DataFrame:
    """Return one row per row of the season file, with the stack after it.

    Parameters
    ----------
    scene
        The complete scene, with the panel at its height above the ground.
    days
        From `accumulate`.
    settings
        The settings of settling and the cover.
    events, outlines
        The tables of the slide-offs, as in events.csv and outline.csv.
    """
    import pandas as pd

    cover = cover_depths([day.weather for day in days], settings, scene["gravity"])
    below = cover_below_slides(scene, days, cover)
    lowered = {**scene, "panel": {**scene["panel"], "height": scene["panel"]["height"] - below}}
    stack = _Stack(lowered, below, settings, events, outlines)
    rows = []
    for day, earlier, depth, depth_before in zip(days, [None, *days], cover, [0.0, *cover]):
        if earlier is not None:
            elapsed = (day.weather.date - earlier.weather.date).total_seconds()
            stack.settling.settle(elapsed, earlier.weather.temperature)
            if settings.cover != "weather" or depth_before == 0.0:
                stack.settling.melt(settings.melt(earlier.weather.temperature, elapsed))
        if day.event is not None:
            stack.set_after_event(day.event)
        rows.append({**_panel_columns(day), **stack.columns(depth)})
    return pd.DataFrame(rows, columns=list(SEASON_COLUMNS)).astype({"event": "Int64"})


def _panel_columns(day: WinterDay) -> dict[str, Any]:
    weather = day.weather
    midnight = not (weather.date.hour or weather.date.minute or weather.date.second)
    return {
        "event": day.event,
        "date": weather.date.date().isoformat() if midnight else weather.date.isoformat(),
        "released": "yes" if day.released else "no",
        "snowfall_m": weather.snowfall,
        "snow_source": weather.source.label,
        "density_kg_m3": math.nan if day.density is None else day.density,
        "temperature_c": weather.temperature,
        "panel_snow_m": day.thickness,
        "panel_load_kg_m2": day.load,
        "driving_pa": day.balance.driving,
        "resisting_pa": day.balance.resisting,
    }


class _Stack:
    """The stack after the last event.

    The scene is that of the slide-offs: its ground is the cover `below` them, m deep.
    """

    def __init__(
        self,
        scene: Mapping[str, Any],
        below: float,
        settings: SeasonSettings,
        events: pd.DataFrame,
        outlines: pd.DataFrame,
    ) -> None:
        self.scene, self.below = scene, below
        self.events = {int(row["event"]): row for row in events.to_dict("records")}
        self.outlines = outlines
        self.rows = settings.rows.distances(scene)
        self.settling = SettlingStack(settings.settling_law, scene["gravity"])
        self.height, self.length, self.left, self.joined = 0.0, 0.0, 0.0, 0
        self.outline = np.zeros((0, 2))

    def set_after_event(self, event: int) -> None:
        """Set the stack to its state after an event."""
        row = self.events[event]
        self.height, self.length = float(row["height_m"]), float(row["length_m"])
        self.left = float(row["on_panel_kg"])
        self.joined = int(row.get("joined") or 0)
        self.outline = self.outlines.loc[self.outlines["event"] == event, ["x", "z"]].to_numpy()
        below = below_panel(self.scene, self.outline, self.rows)
        if 0 < len(below) < len(self.outline):
            self.height = min(self.height, float(below[:, 1].max()))
        self.settling.set_stack(self.height, float(row["density_kg_m3"]))

    def columns(self, cover: float) -> dict[str, float]:
        """Return the table's columns on the stack, above a cover of the depth `cover`, m."""
        higher = cover - self.below
        ratio = self.settling.ratio
        sunk = self.outline * [1.0, ratio]
        now = clearance(self.scene, self.outline, self.height, higher, self.rows)
        settled = clearance(self.scene, sunk, ratio * self.height, higher, self.rows)
        return {
            "stack_height_m": self.height,
            "stack_length_m": self.length,
            "clearance_m": now.below,
            "crest_clearance_m": now.crest,
            "settled_height_m": ratio * self.height,
            "settled_clearance_m": settled.below,
            "left_on_panel_kg": self.left,
            "cover_m": cover,
            "joined": self.joined,
        }
