"""Seasons of a panel as runs of a study, and the margin of their snow to the lower edge.

The slide-offs of a season are a scene, and are computed and kept by the engine of studies. Between
them the simulated stack ages as in a season. The natural snow cover is added to it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.analysis.clearance.panel_design import (
    MARGIN,
    PanelDesign,
    panel_scene,
    season_settings,
)
from snowshed.analysis.clearance.winters import Winter
from snowshed.scene.panel_edge import ground_tilt, panel_edge
from snowshed.scene.scene import ResolvedScene
from snowshed.season.accumulation import WinterDay, snow_on_panel, stack_ageing
from snowshed.season.panel_contact import PanelContact, first_contact
from snowshed.season.settings import SeasonSettings
from snowshed.season.slabs import season_scene
from snowshed.season.table import season_table
from snowshed.study.scene_hash import RunKey

if TYPE_CHECKING:
    import pandas as pd


height_key = attrgetter("height")


@dataclass(frozen=True)
class SeasonOutcome:
    """The margin between the snow of a season and the lower edge of a panel.

    Attributes
    ----------
    height
        Height of the edge above the ground, m.
    margin
        Vertical distance from the highest snow to the edge, less the distance that it must keep, m;
        at most 0 after a contact.
    contact
        The first contact, if any.
    cover
        Depth of the natural snow cover when the snow was highest, m.
    reach
        Horizontal distance from the lower edge to the far end of the stack, the largest over the
        winter, m; 0 without a stack.
    """

    height: float
    margin: float
    contact: Optional[PanelContact]
    cover: float = 0.0
    reach: float = 0.0

    @property
    def is_censored(self) -> bool:
        """Whether a contact does not tell by how much the height is too small."""
        return self.contact is not None and self.margin == 0.0


def required_height(outcomes: Sequence[SeasonOutcome]) -> float:
    """Return the lowest height of the lower edge that the snow does not reach, m.

    The height is interpolated between the highest edge that the snow reaches and the next one. It
    is the middle between them if the snow touches the panel although its crest is lower than the
    edge. Beyond the simulated heights, it follows from the margin at the nearest of them.

    Examples
    --------
    >>> from snowshed.season.panel_contact import PanelContact
    >>> touched = PanelContact("2024-12-24", 1, "crest")
    >>> required_height([SeasonOutcome(1.0, -0.1, touched), SeasonOutcome(2.0, 0.9, None)])
    1.1
    >>> lying = PanelContact("2024-12-24", 1, "slab")
    >>> required_height([SeasonOutcome(1.0, 0.0, lying), SeasonOutcome(2.0, 0.9, None)])
    1.5
    """
    reached = [outcome for outcome in outcomes if outcome.contact is not None]
    clear = [outcome for outcome in outcomes if outcome.contact is None]
    if not clear:
        return max(reached, key=height_key).height - reached[-1].margin
    above = min(clear, key=height_key)
    if not reached:
        return max(above.height - above.margin, 0.0)
    below = max(reached, key=height_key)
    if below.is_censored:
        return 0.5 * (below.height + above.height)
    part = -below.margin / (above.margin - below.margin)
    return below.height + part * (above.height - below.height)


@dataclass(frozen=True)
class SeasonCase:
    """A panel in a winter, with drawn values of the uncertain parameters.

    Attributes
    ----------
    design, winter
        The panel and the winter.
    values
        The drawn values.
    seed
        Random seed of the particles' positions.
    base_settings
        Settings of the season, before the drawn values replace some.
    base
        Values of the scene that replace the defaults.
    """

    design: PanelDesign
    winter: Winter
    values: Mapping[str, float]
    seed: int
    base_settings: SeasonSettings
    base: Mapping[str, Any]

    @property
    def dx(self) -> float:
        """Size of the grid cells, m."""
        return float(self.base.get("numerics.dx", self.design.default_dx))

    @property
    def cells_across(self) -> float:
        """Number of cells across the thinnest slab."""
        return self.settings.pool_below / self.dx

    @cached_property
    def settings(self) -> SeasonSettings:
        """The settings of the season."""
        return season_settings(self.design, self.base_settings, self.values, self.dx)

    @cached_property
    def days(self) -> list[WinterDay]:
        """The snow on the panel, row after row."""
        return snow_on_panel(self.winter.days, self.settings, self.design.tilt)

    @property
    def has_releases(self) -> bool:
        """True if any snow is released."""
        return any(day.released for day in self.days)

    @property
    def slide_offs(self) -> int:
        """Number of slide-offs of the season."""
        return sum(day.event is not None for day in self.days)

    def panel_scene(self, height: float) -> ResolvedScene:
        """Return the scene of the panel at a height, without slabs."""
        return panel_scene(self.design, height, self.values, self.seed, self.base)

    def run_key(self, height: float) -> RunKey:
        """Return the slide-offs of the season as a run of a study."""
        scene = season_scene(self.panel_scene(height), self.days, self.settings)
        return RunKey.of(scene, stack_ageing(self.days, self.settings))

    def outcome(self, height: float, events: pd.DataFrame) -> SeasonOutcome:
        """Return the outcome at a height.

        Parameters
        ----------
        height
            Height of the lower edge, m.
        events
            The rows of the run's slide-offs; empty if nothing slides.
        """
        import pandas as pd

        outlines = pd.DataFrame({"event": [], "x": [], "z": []})
        scene = self.panel_scene(height).data
        table = season_table(scene, self.days, self.settings, events, outlines)
        contact = first_contact(table, MARGIN)
        upright = math.cos(math.radians(ground_tilt(scene)))
        normal = table["crest_clearance_m"] + table["stack_height_m"] - table["settled_height_m"]
        distance = normal / upright
        margin = float(distance.min()) - MARGIN
        cover = float(table["cover_m"].iloc[int(distance.argmin())])
        reach = max((float(events["tail_m"].max()) - panel_edge(scene).x) if len(events) else 0.0,
                    0.0)  # fmt: skip
        return SeasonOutcome(height, min(margin, 0.0) if contact else margin, contact, cover, reach)

    def outcome_of_lying_snow(self, height: float) -> SeasonOutcome:
        """Return the outcome if snow stays on a lower row, because the stack reaches it.

        Such a season ends, because no further snow can be laid there. By how much the height is too
        small is not known.
        """
        last = self.days[-1].weather.date.date().isoformat()
        return SeasonOutcome(height, 0.0, PanelContact(last, None, "slab"))


def cases_of(
    design: PanelDesign,
    winters: Sequence[Winter],
    values: Sequence[Mapping[str, float]],
    settings: SeasonSettings,
    base: Mapping[str, Any],
) -> list[SeasonCase]:
    """Return the cases of a panel: every winter with its draws, in order."""
    draws = len(values) // len(winters)
    seeds = np.random.default_rng(len(values)).integers(1, 2**31, len(values))
    return [
        SeasonCase(design, winters[number // draws], drawn, int(seed), settings, base)
        for number, (drawn, seed) in enumerate(zip(values, seeds))
    ]
