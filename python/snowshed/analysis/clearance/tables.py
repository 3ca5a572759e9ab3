"""The answer as tables: heights, probabilities of burial, and snow on the panel by month."""

from __future__ import annotations

import calendar
import importlib.util
import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from snowshed.analysis.clearance.answer import ClearanceResult
from snowshed.analysis.clearance.answer_text import rounded_up
from snowshed.base.extras import require
from snowshed.io.atomic import replacing
from snowshed.io.csv_table import write_csv

if TYPE_CHECKING:
    import pandas as pd

#: Moments of writing in the properties of a workbook.
DATES = re.compile(rb"(?<=>)[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:.]+Z(?=</dcterms:)")


def height_table(answers: Sequence[ClearanceResult], price: Optional[float] = None) -> pd.DataFrame:
    """Return the height of each panel for each probability, and for the worst winter.

    Parameters
    ----------
    answers
        One answer for each panel.
    price
        Price of a metre of height; None: the table has no costs. Heights are rounded up to 10 cm.
    """
    import pandas as pd

    rows = []
    for answer in answers:
        height, low, high = answer.highest
        heights: list[tuple[str, Optional[float], float, float, float]] = [
            ("the worst winter of the record", None, height, low, high)
        ]
        heights += [
            (
                f"clear in {100 * level.probability:g} % of winters",
                level.probability,
                level.height,
                level.low,
                level.high,
            )
            for level in answer.levels
        ]
        for case, probability, middle, lower, upper in heights:
            row = {
                **panel_columns(answer),
                "case": case,
                "probability": probability,
                "height_m": middle,
                "low_m": lower,
                "high_m": upper,
            }
            if price is not None:
                row["cost"] = price * rounded_up(middle)
            rows.append(row)
    return pd.DataFrame(rows)


def burial_table(answers: Sequence[ClearanceResult]) -> pd.DataFrame:
    """Return the probability of burial in a winter at each candidate height, with its interval."""
    import pandas as pd

    rows = [{**panel_columns(answer), **row} for answer in answers for row in burials(answer)]
    return pd.DataFrame(rows).rename(columns={"height": "height_m", "buried": "probability"})


def burials(answer: ClearanceResult) -> list[dict[str, float]]:
    """Return the probability of burial at each candidate height; none of a single winter."""
    rows = []
    for height in answer.heights:
        burial = answer.heights_by_probability.burial(height)
        if burial is not None:
            rows.append({"height": height, **dict(zip(("buried", "low", "high"), burial))})
    return rows


def panel_snow_table(answers: Sequence[ClearanceResult]) -> pd.DataFrame:
    """Return the snow on each panel, month by month of a mean winter."""
    import pandas as pd

    rows: list[Mapping[str, Any]] = []
    for answer in answers:
        for month, snow in answer.panel_snow.items():
            row = {**panel_columns(answer), "month": calendar.month_abbr[month], "days": snow.days}
            rows.append({**row, "covered_days": snow.covered_days, "blocked": snow.blocked})
    table = pd.DataFrame(rows)
    return table.dropna(axis=1, how="all")  # without irradiance nothing is known of the energy


def panel_columns(answer: ClearanceResult) -> dict[str, float]:
    """Return the columns that name a panel."""
    design = answer.design
    columns = {"slope_length_m": design.slope_length, "tilt_deg": design.tilt}
    if design.rows.count > 1:
        columns |= {"rows": design.rows.count, "pitch_m": design.rows.pitch}
    return columns


def write_tables(
    answers: Sequence[ClearanceResult], folder: Path, price: Optional[float] = None
) -> list[str]:
    """Write heights.csv, and clearance.xlsx with all tables if its library is installed.

    Returns
    -------
    list of str
        Names of the files.
    """
    heights = height_table(answers, price)
    write_csv(heights, folder / "heights.csv", float_format="%.6g")
    if importlib.util.find_spec("openpyxl") is None:
        return ["heights.csv"]
    sheets = {
        "heights": heights,
        "burial": burial_table(answers),
        "snow on the panel": panel_snow_table(answers),
    }
    _write_excel(sheets, folder / "clearance.xlsx")
    return ["heights.csv", "clearance.xlsx"]


def _write_excel(sheets: Mapping[str, pd.DataFrame], file: Path) -> None:
    """Write tables as sheets; the same tables give the same bytes."""
    import pandas as pd

    require("openpyxl", "excel", "a table for Excel")
    written = io.BytesIO()
    with pd.ExcelWriter(written, engine="openpyxl") as book:
        for name, table in sheets.items():
            table.to_excel(book, sheet_name=name, index=False, freeze_panes=(1, 0))
            for column in book.sheets[name].columns:
                longest = max(len(_shown(cell.value)) for cell in column)
                book.sheets[name].column_dimensions[column[0].column_letter].width = longest + 2
                for cell in column[1:]:
                    cell.number_format = "0.00" if isinstance(cell.value, float) else "General"
    with replacing(file) as beside, ZipFile(written) as dated, ZipFile(beside, "w") as undated:
        for part in dated.namelist():
            content = DATES.sub(b"2000-01-01T00:00:00Z", dated.read(part))
            undated.writestr(ZipInfo(part), content, ZIP_DEFLATED)


def _shown(value: object) -> str:
    return f"{value:.2f}" if isinstance(value, float) else str(value)
