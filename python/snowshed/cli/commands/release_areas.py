"""The command ``snowshed release-areas``."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import click

from snowshed._core import InputError
from snowshed.base.limits import MAX_RESAMPLED_CELLS
from snowshed.cli.options.common import PATH, quiet_option
from snowshed.cli.options.number_texts import span
from snowshed.cli.output.terminal import narrow_table, say, wide_console

if TYPE_CHECKING:
    from snowshed.analysis.hazard.candidates import ReleaseCandidates
    from snowshed.io.raster.areas import MapArea
    from snowshed.io.raster.raster import Raster

RASTERS = (".asc", ".txt", ".tif", ".tiff")
MAX_SHOWN = 20  # candidates in the printed table
#: Heads of the printed table, and the fields of the files.
SHOWN = {
    "area\nm2": ("area_m2", "{:,.0f}"),
    "slope\ndegrees": ("slope_deg", "{:.1f}"),
    "aspect\ndegrees": ("aspect_deg", "{:.0f}"),
    "lowest\nm": ("lowest_m", "{:.0f}"),
    "highest\nm": ("highest_m", "{:.0f}"),
    "thickness\nm": ("thickness", "{:.2f}"),
    "largest\nm": ("max_thick", "{:.2f}"),
    "volume\nm3": ("volume_m3", "{:,.0f}"),
}


@click.command()
@click.argument("terrain", type=PATH)
@click.option(
    *("-o", "--output", "file"),
    type=PATH,
    required=True,
    help="File of the polygons: .geojson, .gpkg or .shp; a table .csv goes beside it.",
)
@click.option(
    "--slope", metavar="LOW:HIGH", default="28:60", show_default=True, help="Slopes [degrees]."
)
@click.option(
    "--max-plan-curvature",
    type=float,
    default=0.06,
    show_default=True,
    help="Largest curvature across the slope, of ridges [1/m].",
)
@click.option(
    "--max-ruggedness",
    type=float,
    default=0.08,
    show_default=True,
    help="Largest ruggedness, from 0 of a plane to 1.",
)
@click.option(
    "--ruggedness-window",
    type=float,
    default=45.0,
    show_default=True,
    help="Side of the square in which the ruggedness is measured [m].",
)
@click.option(
    "--min-area", type=float, default=500.0, show_default=True, help="Smallest area [m2]."
)
@click.option(
    "--max-gap", type=float, default=0.0, show_default=True, help="Largest gap to fill [m2]."
)
@click.option(
    "--sectors",
    type=int,
    default=8,
    show_default=True,
    help="Sectors of the compass by which slopes are split; 1 does not split.",
)
@click.option("--forest", type=PATH, help="Forest: a raster with values above 0, or polygons.")
@click.option("--forest-layer", metavar="NAME", help="Layer of the GeoPackage of forest.")
@click.option("--thickness", type=float, help="Thickness of the snow [m].")
@click.option("--thickness-raster", type=PATH, help="Raster of the thickness of the snow [m].")
@click.option("--cell", type=float, help="Size of the cells [m].  [default: that of the terrain]")
@click.option("--band", type=int, help="Band of the terrain, if the GeoTIFF has several.")
@click.option(
    "--max-cells",
    type=int,
    default=MAX_RESAMPLED_CELLS,
    show_default=True,
    help="Largest number of cells of the terrain.",
)
@quiet_option
def release_areas(
    terrain: Path,
    file: Path,
    slope: str,
    forest: Optional[Path],
    forest_layer: Optional[str],
    thickness: Optional[float],
    thickness_raster: Optional[Path],
    cell: Optional[float],
    band: Optional[int],
    max_cells: int,
    quiet: bool,
    sectors: int,
    **limits: float,
) -> None:
    """Find candidate release areas by the shape of the terrain.

    TERRAIN holds elevations: an ESRI ASCII grid or a GeoTIFF in metres. The candidates are polygons
    that `snowshed slide --release` takes. They are not a hazard assessment, because the rules know
    neither snow nor wind.

    \b
    Example:
      snowshed release-areas dem.tif -o areas.geojson --forest forest.gpkg --thickness 0.5
      snowshed slide --terrain dem.tif --release areas.geojson -o slide
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.hazard.candidate_files import write_candidates
    from snowshed.analysis.hazard.candidates import ReleaseRules, find_release_areas
    from snowshed.io.polygons.output import check_ending
    from snowshed.io.raster.raster import read_raster

    check_ending(file)
    low, high = span("--slope", slope, example="28:60")
    rules = ReleaseRules(min_slope=low, max_slope=high, sectors=sectors, **limits)
    if thickness is not None and thickness_raster is not None:
        raise InputError("give one of --thickness and --thickness-raster")
    depth = thickness if thickness_raster is None else read_raster(thickness_raster)
    candidates = find_release_areas(
        _ground(terrain, cell, band, max_cells),
        rules,
        forest=_forest(forest, forest_layer),
        thickness=depth,
    )
    written = write_candidates(file, candidates)
    if not quiet:
        _print_candidates(candidates)
        say(f"polygons in {written[0]}, table in {written[1]}")


def _ground(file: Path, cell: Optional[float], band: Optional[int], max_cells: int) -> Raster:
    from snowshed.io.raster.resampling import resampled
    from snowshed.scene.builders.terrain_checks import read_terrain

    terrain = read_terrain(file, band, max_cells=max_cells)
    return terrain if cell is None else resampled(terrain, cell)


def _forest(file: Optional[Path], layer: Optional[str]) -> Union[Raster, list[MapArea], None]:
    if file is None:
        if layer is not None:
            raise InputError("--forest-layer: only with --forest")
        return None
    if file.suffix.lower() in RASTERS:
        from snowshed.io.raster.raster import read_raster

        return read_raster(file)
    from snowshed.io.raster.areas import read_areas

    return read_areas(file, layer, option="--forest-layer", with_thickness=False)


def _print_candidates(candidates: ReleaseCandidates) -> None:
    """Print the area after each rule, the largest candidates, and a word of caution."""
    from snowshed.analysis.hazard.candidate_files import candidate_table, rules_text

    console = wide_console(110)
    remaining = narrow_table("Area that the rules leave", ("after the rule", "m2"))
    for rule, area in candidates.remaining.items():
        remaining.add_row(rule, f"{area:,.0f}")
    console.print(remaining)
    table = candidate_table(candidates)
    shown = {head: value for head, value in SHOWN.items() if value[0] in table}
    rows = narrow_table(f"{len(table)} candidate release areas", ("", *shown))
    for record in table.head(MAX_SHOWN).to_dict("records"):
        rows.add_row(str(record["name"]), *(_cell(record, *form) for form in shown.values()))
    console.print(rows)
    if len(table) > MAX_SHOWN:
        console.print(f"and {len(table) - MAX_SHOWN} smaller ones")
    console.print(rules_text(candidates), soft_wrap=True)


def _cell(record: Mapping[Hashable, Any], name: str, form: str) -> str:
    value = record[name]
    return "" if value is None or value != value else form.format(value)
