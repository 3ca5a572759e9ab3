"""The page of maps of probability of snow slides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from snowshed.base.arrays import Floats
from snowshed.io.atomic import write_text
from snowshed.io.raster.raster import Raster
from snowshed.plot.hazard_figure import part_shown, percentiles_figure, probability_figure
from snowshed.plot.html_page import HtmlTable, Picture, template
from snowshed.plot.terrain_map import Outline

#: Titles of the summary's quantities on the page.
NAMES = {
    "run_out_m": "run-out, m",
    "drop_m": "drop, m",
    "reached_m2": "area reached, m²",
    "peak_speed_m_s": "peak speed, m/s",
    "peak_thickness_m": "peak thickness, m",
    "peak_pressure_kpa": "peak pressure, kPa",
    "bonds_broken": "bonds broken",
}


@dataclass(frozen=True)
class HazardPage:
    """Content of the page of maps of probability.

    Attributes
    ----------
    title, sentence, uncertainty
        Title of the page; a sentence about the maps, and one about their uncertainty.
    ground, outlines
        The terrain, and corners of the release areas, in map coordinates, m.
    probabilities
        Maps by their event; the first is the probability of being reached.
    percentiles
        Rasters by percentile and quantity.
    areas
        The area by probability.
    ranges, figures
        Ranges of the varied parameters, and percentiles (5, 50, 95) of the slides' results.
    runs, failed
        Number of slides in the maps, and number of failed ones.
    notes
        Warnings where slides violate the method's assumptions.
    """

    title: str
    sentence: str
    uncertainty: str
    ground: Raster
    outlines: Sequence[Outline]
    probabilities: Mapping[str, Floats]
    percentiles: Mapping[int, Mapping[str, Floats]]
    areas: HtmlTable
    ranges: Mapping[str, Sequence[float]]
    figures: Mapping[str, Mapping[str, float]]
    runs: int
    failed: int
    notes: Sequence[str]

    def write(self, file: Path) -> None:
        """Write the page, a single file that needs no network; whole or not at all."""
        page = template("snowshed.plot", "hazard.html.j2")
        text = page.render(
            title=self.title,
            sentence=self.sentence,
            uncertainty=self.uncertainty,
            notes=self.notes,
            ranges=self._range_table(),
            runs=self.runs,
            failed=self.failed,
            areas=self.areas,
            probabilities=self._probabilities(),
            percentiles=list(self.percentiles),
            pictures=self._percentiles(),
            figures=self._figure_table(),
            cell=self.ground.cell,
            crs=self.ground.crs or "not given",
        )
        write_text(file, text)

    def _probabilities(self) -> list[Picture]:
        part = part_shown(self.ground, next(iter(self.probabilities.values())), self.outlines)
        return [
            Picture.drawn(
                probability_figure(
                    self.ground, values, self.outlines, part, label=label, area=38.0
                ),
                f"probability_{number}",
                f"Probability of {label}",
                "The lines are of 5, 50 and 95 %.",
            )
            for number, (label, values) in enumerate(self.probabilities.items())
            if values.max() > 0.0
        ]

    def _percentiles(self) -> list[Picture]:
        part = part_shown(self.ground, next(iter(self.probabilities.values())), self.outlines)
        titles = {
            "thickness": "peak thickness, m",
            "speed": "peak speed, m/s",
            "pressure": "peak pressure, kPa",
        }
        return [
            Picture.drawn(
                percentiles_figure(self.ground, maps, self.outlines, part, titles=titles),
                f"percentile_{percentile}",
                f"{percentile}th percentile",
                f"{percentile} % of the runs stay below these values.",
            )
            for percentile, maps in self.percentiles.items()
        ]

    def _range_table(self) -> HtmlTable:
        rows = [(name, f"{ends[0]:.4g}", f"{ends[-1]:.4g}") for name, ends in self.ranges.items()]
        return HtmlTable(("setting", "smallest value", "largest value"), rows, "lrr")

    def _figure_table(self) -> HtmlTable:
        rows = [
            (NAMES.get(name, name), *(f"{quantiles[share]:,.4g}" for share in ("p5", "p50", "p95")))
            for name, quantiles in self.figures.items()
        ]
        return HtmlTable(("figure", "5 %", "50 %", "95 %"), rows, "lrrr")
