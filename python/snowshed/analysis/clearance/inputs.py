"""All inputs of an answer on clearance, and its record: enough to compute the answer again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Optional

from snowshed.analysis.clearance.answer import (
    ClearanceResult,
    expected_duration,
    required_clearance,
)
from snowshed.analysis.clearance.panel_design import PanelDesign, SnowRanges
from snowshed.analysis.clearance.winters import counted_winters
from snowshed.base.progress import Reporter
from snowshed.io.atomic import write_text
from snowshed.io.json_file import sealed
from snowshed.results.computed_record import CLEARANCE, record_data, recorded_inputs
from snowshed.season.rows import PanelRows
from snowshed.season.settings import SeasonSettings, settings_of
from snowshed.season.weather.rows_data import weather_data, weather_of
from snowshed.season.weather.season_record import SeasonRecord, WinterList

#: The record of an answer, in its results folder.
FILE = "clearance.json"


@dataclass(frozen=True)
class ClearanceInputs:
    """The inputs of the answer for one panel or several.

    Attributes
    ----------
    designs
        The panels.
    weather, coverage
        The weather, and the share of days on which the snow of a winter must have been observed.
    heights
        Candidates for the height of the lower edge, m.
    ranges, settings, scene
        As for `required_clearance`.
    price
        Price of a metre of height; None: no costs.
    files
        The files of the weather, whose checksums are recorded.
    """

    designs: Sequence[PanelDesign]
    weather: SeasonRecord
    coverage: float
    heights: Sequence[float]
    ranges: SnowRanges
    settings: SeasonSettings
    scene: Mapping[str, Any]
    price: Optional[float] = None
    files: Sequence[str] = ()

    @cached_property
    def winter_list(self) -> WinterList:
        """The winters of the weather."""
        return self.weather.winters(self.coverage)

    def write_record(self, folder: Path) -> None:
        """Write the record into a results folder."""
        write_text(folder / FILE, sealed(self.record_data()))

    def record_data(self) -> dict[str, Any]:
        """Return the record as JSON data."""
        inputs = {
            "panels": [asdict(design) for design in self.designs],
            "heights": [float(height) for height in self.heights],
            "spans": {name: list(span) for name, span in self.ranges.spans.items()},
            "draws": self.ranges.draws,
            "seed": self.ranges.seed,
            "settings": asdict(self.settings),
            "scene": dict(self.scene),
            "price": self.price,
            "coverage": self.coverage,
            "weather": weather_data(self.weather),
        }
        return record_data(CLEARANCE, inputs, self.files)

    def expected_duration(self, *, jobs: Optional[int] = None) -> tuple[float, int]:
        """Return the expected time of all answers, s, and their number of seasons."""
        winters = counted_winters(self.winter_list)
        costs = [
            expected_duration(
                design, winters, self.heights, ranges=self.ranges, settings=self.settings,
                scene=self.scene, jobs=jobs,
            )
            for design in self.designs
        ]  # fmt: skip
        return sum(seconds for seconds, _ in costs), sum(seasons for _, seasons in costs)

    def answers(
        self,
        folder: Path,
        *,
        jobs: Optional[int] = None,
        same_version: bool = False,
        progress: Optional[Reporter] = None,
    ) -> list[ClearanceResult]:
        """Compute the answer for each panel, with a store of runs for each in the folder.

        Parameters and errors are those of `required_clearance`.
        """
        winters = counted_winters(self.winter_list)
        folder.mkdir(parents=True, exist_ok=True)
        return [
            required_clearance(
                design,
                winters,
                self.heights,
                folder / f"runs-{design.slope_length:g}-{design.tilt:g}",
                ranges=self.ranges,
                settings=self.settings,
                scene=self.scene,
                winter_list=self.winter_list,
                jobs=jobs,
                same_version=same_version,
                progress=progress,
            )
            for design in self.designs
        ]


def recorded_clearance(file: Path) -> ClearanceInputs:
    """Return the inputs of a recorded answer, from its clearance.json.

    Raises
    ------
    InputError
        If the record is damaged.
    """
    with recorded_inputs(file, CLEARANCE) as inputs:
        return ClearanceInputs(
            [
                PanelDesign(**{**panel, "rows": PanelRows(**panel["rows"])})
                for panel in inputs["panels"]
            ],
            weather_of(inputs["weather"], f"{file}: weather"),
            inputs["coverage"],
            inputs["heights"],
            SnowRanges(
                {name: (low, high) for name, (low, high) in inputs["spans"].items()},
                inputs["draws"],
                inputs["seed"],
            ),
            settings_of(inputs["settings"]),
            inputs["scene"],
            inputs["price"],
        )
