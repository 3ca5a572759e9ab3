"""All inputs of an answer on clearance, and its record: enough to compute the answer again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.analysis.clearance.answer import (
    ClearanceResult,
    expected_duration,
    required_clearance,
)
from snowshed.analysis.clearance.panel_design import PanelDesign, SnowRanges
from snowshed.analysis.clearance.winters import counted_winters
from snowshed.base.progress import Reporter
from snowshed.results.computed_record import CLEARANCE, record_data
from snowshed.season.rows import PanelRows
from snowshed.season.settings import SeasonSettings, settings_of
from snowshed.season.weather.rows_data import weather_data, weather_of
from snowshed.season.weather.season_record import SeasonRecord


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
        winters = counted_winters(self.weather.winters(self.coverage))
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
        winter_list = self.weather.winters(self.coverage)
        winters = counted_winters(winter_list)
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
                winter_list=winter_list,
                jobs=jobs,
                same_version=same_version,
                progress=progress,
            )
            for design in self.designs
        ]


def recorded_clearance(record: Mapping[str, Any], file: Path) -> ClearanceInputs:
    """Return the inputs of a recorded answer.

    Parameters
    ----------
    record, file
        The content of its clearance.json, and the file for messages.

    Raises
    ------
    InputError
        If the record is damaged.
    """
    try:
        inputs = record[CLEARANCE]
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
    except (AttributeError, KeyError, TypeError) as error:
        raise InputError(f"{file}: damaged: {error}") from None
