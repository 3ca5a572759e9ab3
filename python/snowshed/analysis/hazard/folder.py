"""The folder of a study of slides: rasters, a picture, a page and the numbers of its maps.

================ ============================================================================
probability/     share of the runs in which a value is exceeded, and the ends of its 95 % interval
                 (``_low``, ``_high``), as ESRI ASCII grids, with their coordinate system in a .prj
                 where it is known, or as GeoTIFF
percentiles/     percentiles of peak thickness (pft, m), speed (pfv, m/s), pressure (ppr, kPa)
hazard.json      runs, areas by probability, intervals, percentiles of the figures of the slides
hazard.png       the probability of being reached, on the terrain
hazard.html      the page
table.csv        the table of the study, one row per slide
runs/            the store of the study (`snowshed study status`)
study.toml       the study
================ ============================================================================
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from snowshed.analysis.hazard.maps import (
    LEVELS,
    PRESSURES,
    QUANTITIES,
    REACHED_THICKNESS,
    HazardMaps,
    hazard_facts,
    hazard_maps,
    moving_notes,
    uncertainty,
)
from snowshed.base.arrays import Floats
from snowshed.base.paths import PathLike
from snowshed.io.atomic import write_text
from snowshed.io.raster.output import ENDINGS, MapFormat, write_raster
from snowshed.methods.registry import SETTINGS_KEY
from snowshed.methods.slide.validity import MAX_BROKEN_SHARE, release_areas, validity_notes
from snowshed.plot.figure_style import save_figure
from snowshed.plot.hazard_figure import part_shown, probability_figure
from snowshed.plot.hazard_page import HazardPage
from snowshed.plot.html_page import HtmlTable
from snowshed.scene.resolved import scene_data
from snowshed.scene.terrain_grid import release_outlines
from snowshed.study.formats import export
from snowshed.study.store import Store
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

FIGURES = ("run_out_m", "drop_m", "reached_m2", "peak_speed_m_s", "peak_thickness_m",
           "peak_pressure_kpa", "bonds_broken")  # fmt: skip


def write_hazard(
    folder: PathLike,
    store: PathLike,
    study: str,
    *,
    reached: float = REACHED_THICKNESS,
    pressures: Sequence[float] = PRESSURES,
    map_format: MapFormat = "ascii",
) -> HazardMaps:
    """Write the maps of a study of slides into a folder, and return them.

    Parameters
    ----------
    folder
        Folder of the files.
    store, study, reached, pressures
        As for `hazard_maps`, which raises the same errors.
    map_format
        Format of the rasters.
    """
    place, suffix = Path(folder), ENDINGS[map_format]
    maps = hazard_maps(store, study, reached=reached, pressures=pressures)
    for exceedance in maps.exceedances:
        for ending, values in (
            ("", exceedance.probability),
            ("_low", exceedance.lower),
            ("_high", exceedance.upper),
        ):
            _write(place / "probability" / f"{exceedance.name}{ending}{suffix}", maps, values)
    for (quantity, percentile), values in maps.percentiles.items():
        _write(
            place / "percentiles" / f"{QUANTITIES[quantity][1]}_p{percentile}{suffix}", maps, values
        )
    table = read_table(store, study)
    with Store.open(store) as opened:
        scene = scene_data(opened.runs(study)[0].scene)
        axes = opened.axes(study)
    ranges = _ends(table, axes)
    facts = {
        **hazard_facts(maps),
        "ranges": ranges,
        "figures": _figures(table),
        "notes": [*_notes_of_files(scene, ranges), *_notes(maps, scene, table)],
    }
    write_text(place / "hazard.json", json.dumps(facts, indent=2) + "\n")
    export(store, place / "table.csv", study=study)
    page = _page(maps, scene, facts)
    first, probability = next(iter(page.probabilities.items()))
    part = part_shown(maps.terrain, probability, page.outlines)
    label = f"{first}, of {maps.runs} slides"
    figure = probability_figure(maps.terrain, probability, page.outlines, part, label=label)
    save_figure(figure, place / "hazard.png")
    page.write(place / "hazard.html")
    return maps


def _page(maps: HazardMaps, scene: Mapping[str, Any], facts: Mapping[str, Any]) -> HazardPage:
    reached = maps.exceedances[0]
    likely, possible = (maps.area(reached, level) for level in (0.5, 0.05))
    speed = facts["largest_values"]["speed_p95"]
    pressure = facts["largest_values"]["pressure_p95"]
    percentiles: dict[int, dict[str, Floats]] = {}
    for (quantity, percentile), values in maps.percentiles.items():
        percentiles.setdefault(percentile, {})[quantity] = values
    head = (
        "area, m², with a probability of",
        *(f"at least {100 * level:.0f} %" for level in LEVELS),
    )
    rows = [
        (exceedance.label, *(f"{maps.area(exceedance, level):,.0f}" for level in LEVELS))
        for exceedance in maps.exceedances
    ]
    return HazardPage(
        title=scene.get("title") or "Snow slides",
        sentence=(
            f"Of {maps.runs} slides at least half reach {likely:,.0f} m², and at least one in "
            f"twenty {possible:,.0f} m²; at every position, 95\N{NO-BREAK SPACE}% of them stay "
            "below "
            f"{speed:.1f} m/s and {pressure:.1f} kPa."
        ),
        uncertainty=uncertainty(maps.runs),
        ground=maps.terrain,
        outlines=release_outlines(scene),
        probabilities={exceedance.label: exceedance.probability for exceedance in maps.exceedances},
        percentiles=percentiles,
        areas=HtmlTable(head, rows, "l" + "r" * len(LEVELS)),
        ranges=facts["ranges"],
        figures=facts["figures"],
        runs=maps.runs,
        failed=maps.failed,
        notes=facts["notes"],
    )


def _notes_of_files(scene: Mapping[str, Any], ranges: Collection[str]) -> list[str]:
    """Return the notes from reading the files of the slides.

    Parameters
    ----------
    scene
        Any of the slides.
    ranges
        Paths of the parameters that vary.
    """
    notes = str(scene["terrain"].get("notes") or "").splitlines()
    if notes and any(path.endswith(".thickness") for path in ranges):
        notes.append("the thickness of the release varies between the runs, whatever its file says")
    return notes


def _notes(maps: HazardMaps, scene: Mapping[str, Any], table: pd.DataFrame) -> list[str]:
    """Return warnings where most slides violate the method's assumptions, by their medians."""
    areas = release_areas(maps.terrain, scene["terrain"]["release"])
    medians = table.select_dtypes("number").median()
    figures = {
        **{str(name): value for name, value in medians.items()},
        "ended": "rest",
        "bonds_broken": 0.0,
    }
    notes = validity_notes(areas, scene[SETTINGS_KEY], figures)
    broken = int((table["bonds_broken"] > MAX_BROKEN_SHARE * table["bonds_made"]).sum())
    if broken:
        notes.append(
            f"In {broken} of {maps.runs} runs more than a tenth of the bonds broke: they did not "
            "move as a unit."
        )
    return [*notes, *moving_notes(table, maps.runs)]


def _write(file: Path, maps: HazardMaps, values: Any) -> None:
    file.parent.mkdir(exist_ok=True)
    write_raster(file, maps.raster(values))


def _ends(table: pd.DataFrame, axes: Sequence[str]) -> dict[str, list[float]]:
    """Return the smallest and the largest value of each varied parameter."""
    return {path: [float(table[path].min()), float(table[path].max())] for path in axes}


def _figures(table: pd.DataFrame) -> Mapping[str, Mapping[str, float]]:
    """Return percentiles of the figures of the slides."""
    shares = {"p5": 0.05, "p50": 0.5, "p95": 0.95}
    return {
        name: {
            label: float(table[name].dropna().quantile(share)) for label, share in shares.items()
        }
        for name in FIGURES
        if name in table
    }
