"""The results folder of a season: its files.

================== ==========================================================================
season.csv         one row per row of the season file: `SEASON_COLUMNS`
season.png         the season: load on the panel, stack and clearance, outlines
season.json        settings, and the events at which the stack reached the panel
run/               the slide-offs: a results folder of ``snowshed run`` (missing without release)
================== ==========================================================================
"""

from __future__ import annotations

from pathlib import Path

from snowshed.base.paths import PathLike
from snowshed.results.folder import RunFolder

SEASON_COLUMNS = (
    "event",
    "date",
    "released",
    "snowfall_m",
    "snow_source",
    "density_kg_m3",
    "temperature_c",
    "panel_snow_m",
    "panel_load_kg_m2",
    "driving_pa",
    "resisting_pa",
    "stack_height_m",
    "stack_length_m",
    "clearance_m",
    "crest_clearance_m",
    "settled_height_m",
    "settled_clearance_m",
    "left_on_panel_kg",
    "cover_m",
    "joined",
)


class SeasonFolder:
    """The paths of a season's files."""

    def __init__(self, folder: PathLike) -> None:
        self.folder = Path(folder)
        self.table = self.folder / "season.csv"
        self.figure = self.folder / "season.png"
        self.summary = self.folder / "season.json"
        self.run = RunFolder(self.folder / "run")
