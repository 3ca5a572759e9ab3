"""The folder of a study of slides: rasters, a picture, a page and the numbers of its maps.

================ ============================================================================
probability/     share of the runs in which a value is exceeded, and the ends of its 95 % interval
                 (``_low``, ``_high``), as ESRI ASCII grids
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
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from snowshed.analysis.hazard_maps import (
    PRESSURES,
    QUANTITIES,
    REACHED,
    HazardMaps,
    hazard_facts,
    hazard_maps,
)
from snowshed.io.atomic import write_text
from snowshed.io.raster import write_ascii_grid
from snowshed.plot.figure_style import save
from snowshed.plot.hazard_figure import part_shown, probability_figure
from snowshed.run.slides import release_outlines
from snowshed.scene.scene import PathLike
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
    reached: float = REACHED,
    pressures: Sequence[float] = PRESSURES,
) -> HazardMaps:
    """Write the maps of a study of slides into a folder, and return them.

    Parameters
    ----------
    folder
        Where the files go.
    store, study, reached, pressures
        As for `hazard_maps`, which raises the same errors.
    """
    place = Path(folder)
    maps = hazard_maps(store, study, reached=reached, pressures=pressures)
    for one in maps.exceedances:
        for ending, values in (("", one.probability), ("_low", one.lower), ("_high", one.upper)):
            _write(place / "probability" / f"{one.name}{ending}.asc", maps, values)
    for (quantity, percentile), values in maps.percentiles.items():
        _write(place / "percentiles" / f"{QUANTITIES[quantity][1]}_p{percentile}.asc", maps, values)
    table = read_table(store, study)
    with Store.open(store) as opened:
        scene = json.loads(opened.runs(study)[0].scene)
        axes = opened.axes(study)
    facts = {**hazard_facts(maps), "ranges": _ends(table, axes), "figures": _figures(table)}
    write_text(place / "hazard.json", json.dumps(facts, indent=2) + "\n")
    export(store, place / "table.csv", study=study)
    outlines = release_outlines(scene)
    first = maps.exceedances[0]
    part = part_shown(maps.terrain, first.probability, outlines)
    label = f"{first.label}, of {maps.runs} slides"
    figure = probability_figure(maps.terrain, first.probability, outlines, part, label=label)
    save(figure, place / "hazard.png")
    return maps


def _write(file: Path, maps: HazardMaps, values: Any) -> None:
    file.parent.mkdir(exist_ok=True)
    write_ascii_grid(file, maps.raster(values))


def _ends(table: pd.DataFrame, axes: Sequence[str]) -> dict[str, list[float]]:
    """Return the smallest and the largest value of what varies."""
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
