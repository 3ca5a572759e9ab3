"""Files of candidate release areas: polygons with their figures, and a table of the figures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Union

from snowshed.analysis.hazard.candidates import CAUTION, ReleaseCandidate, ReleaseCandidates
from snowshed.base.arguments import checked
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import write_csv
from snowshed.io.polygons.output import check_ending, write_polygons

if TYPE_CHECKING:
    import pandas as pd

#: Fields of the files, with at most ten letters, and the attributes of a candidate.
FIELDS = {
    "name": "name",
    "area_m2": "area",
    "surface_m2": "surface",
    "slope_deg": "slope",
    "slope_min": "lowest_slope",
    "slope_max": "highest_slope",
    "aspect_deg": "aspect",
    "lowest_m": "lowest",
    "highest_m": "highest",
    "thickness": "thickness",
    "max_thick": "largest_thickness",
    "volume_m3": "volume",
}
#: Fields that need a thickness of the snow.
SNOW_FIELDS = ("thickness", "max_thick", "volume_m3")
#: Digits after the point; the outlines are exact.
DIGITS = {"thickness": 4, "max_thick": 4}


@checked
def write_candidates(path: PathLike, candidates: ReleaseCandidates) -> list[Path]:
    """Write candidate release areas as polygons, and their figures as a CSV table beside them.

    `snowshed.slide` and ``snowshed slide --release`` take the polygons as they are. Every polygon
    has a field that says that it is a candidate.

    Parameters
    ----------
    path
        File of the polygons: .geojson, .gpkg or .shp. The table has the same name with .csv.
    candidates
        The candidates.

    Returns
    -------
    list of pathlib.Path
        The polygons and the table.

    Raises
    ------
    InputError
        As `snowshed.io.polygons.output.write_polygons`.
    OSError
        If a file cannot be written.
    """
    file = Path(path)
    check_ending(file)
    if not candidates.crs:
        issue_note(
            f"{file}: has no coordinate system, because that of the terrain is unknown", InputNote
        )
    table = candidate_table(candidates)
    fields: dict[str, list[Union[str, float, None]]] = {
        str(name): [None if value != value else value for value in column.tolist()]
        for name, column in table.items()
    }
    fields["note"] = [CAUTION for _ in candidates.areas]
    rings = [(area.outline, *area.holes) for area in candidates.outlines]
    write_polygons(file, rings, fields, crs=candidates.crs, description=rules_text(candidates))
    written = file.with_suffix(".csv")
    write_csv(table, written)
    return [file, written]


def candidate_table(candidates: ReleaseCandidates) -> pd.DataFrame:
    """Return the figures of candidates, a row each.

    Columns are name, area_m2 (map), surface_m2 (ground), slope_deg (mean), slope_min, slope_max,
    aspect_deg (from north; empty if all sides), lowest_m, highest_m, and with snow thickness,
    max_thick (m) and volume_m3.
    """
    import pandas as pd

    areas = candidates.areas
    snow = any(area.volume is not None for area in areas)
    names = [name for name in FIELDS if snow or name not in SNOW_FIELDS]
    return pd.DataFrame(
        {name: [_rounded(area, name) for area in areas] for name in names}, columns=names
    )


def _rounded(area: ReleaseCandidate, name: str) -> Union[str, float, None]:
    value: Union[str, float, None] = getattr(area, FIELDS[name])
    return round(value, DIGITS.get(name, 2)) if isinstance(value, float) else value


def rules_text(candidates: ReleaseCandidates) -> str:
    """Return the rules of candidates as text, with a word of caution and the sources."""
    _, *rules = candidates.remaining
    return (
        "Candidate release areas by the shape of the terrain alone, not a hazard assessment. "
        f"Rules: {'; '.join(rules)}. After Bühler et al. (2013), doi:10.5194/nhess-13-1321-2013, "
        "and Bühler et al. (2018), doi:10.5194/nhess-18-3235-2018; ruggedness: Sappington et al. "
        "(2007), doi:10.2193/2005-723."
    )
