"""The clearance of a panel from a weather file, in one call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Optional

from snowshed.analysis.clearance.answer import ClearanceResult, required_clearance
from snowshed.analysis.clearance.inputs import ClearanceInputs
from snowshed.analysis.clearance.panel_design import PanelDesign, SnowRanges
from snowshed.analysis.clearance.winters import counted_winters
from snowshed.base.arguments import checked
from snowshed.base.json_values import JsonValue
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.season.rows import PanelRows
from snowshed.season.settings import SeasonSettings
from snowshed.season.weather.quality import COVERAGE
from snowshed.season.weather.reading import Season, input_files, read_record
from snowshed.season.weather.source import AUTO

if TYPE_CHECKING:
    import pandas as pd  # noqa: F401 - of `Season`


@checked
def clearance(
    weather: Season,
    folder: PathLike,
    *,
    slope_length: float,
    tilt: float,
    rows: int = 1,
    pitch: float = 0.0,
    heights: Sequence[float] = (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0),
    ranges: Optional[SnowRanges] = None,
    settings: Optional[SeasonSettings] = None,
    scene: Optional[Mapping[str, JsonValue]] = None,
    coverage: float = COVERAGE,
    snow_from: str = AUTO,
    temperature: Optional[PathLike] = None,
    jobs: Optional[int] = None,
    same_version: bool = False,
    progress: Optional[Reporter] = None,
) -> ClearanceResult:
    r"""Return how high the lower edge of a panel must be to stay clear of shed snow.

    Parameters
    ----------
    weather
        Years of daily weather: a file of a station or several, or any other input of
        `snowshed.season.read_record`.
    folder
        Folder of the store of runs; the same call resumes there. The record ``clearance.json`` in
        it is enough to compute the answer again (`snowshed.repeat`).
    slope_length
        Length of the panel along the slope, m.
    tilt
        Tilt of the panel from the horizontal, degrees; 90: a fence, on which no snow lies.
    rows, pitch
        Number of rows of such panels, and the horizontal distance from a row to the next, m.
    heights
        Candidates for the height of the lower edge above the ground, m.
    ranges
        Ranges of the uncertain snow parameters. [default: `SnowRanges()`]
    settings
        Settings of the seasons, except those that vary. [default: `SeasonSettings()`]
    scene
        Values of the scene by dotted path, such as ``numerics.dx``, which slabs and margin follow.
    coverage
        Share of the days of a winter on which snow must have been observed.
    snow_from
        The column that observes snow. [default: the best of each winter]
    temperature
        Another file of the same station, for its temperature.
    jobs
        Local processes at once. [default: the number of cores]
    same_version
        As for `Study.compute`.
    progress
        Called with a `Progress` a few times a second.

    Returns
    -------
    ClearanceResult
        `ClearanceResult.at` gives the height and its 90 % interval for a share of winters.

    Raises
    ------
    InputError
        If the weather has no winter with enough observations, or a value is out of range.
    StudyError, StudyInterrupted
        As from `Study.compute`.

    Examples
    --------
    >>> from datetime import date, timedelta
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> days = [date(2023, 9, 1) + timedelta(n) for n in range(366)]
    >>> rows = [f"{day},{0.2 if day == date(2024, 1, 5) else 0},{-3 if day.month < 3 else 5}"
    ...         for day in days]
    >>> with TemporaryDirectory() as base:
    ...     file = Path(base) / "weather.csv"
    ...     _ = file.write_text("\n".join(["date,snowfall_m,temperature_c", *rows]))
    ...     answer = clearance(file, f"{base}/runs", slope_length=0.5, tilt=60, heights=[0.5],
    ...                        ranges=SnowRanges(draws=1), scene={"numerics.dx": 0.05})
    >>> len(answer.winters), answer.highest[0] < 0.5  # one winter has no probabilities
    (1, True)
    """
    record = read_record(weather, snow_from, temperature)
    winter_list = record.winters(coverage)
    for note in (*record.notes, *winter_list.notes):
        issue_note(note)
    design = PanelDesign(slope_length, tilt, PanelRows(rows, pitch))
    answer = required_clearance(
        design,
        counted_winters(winter_list),
        heights,
        folder,
        ranges=ranges,
        settings=settings,
        scene=scene,
        winter_list=winter_list,
        jobs=jobs,
        same_version=same_version,
        progress=progress,
    )
    inputs = ClearanceInputs(
        [design],
        record,
        coverage,
        heights,
        ranges or SnowRanges(),
        settings or SeasonSettings(),
        scene or {},
        files=input_files(weather, temperature),
    )
    inputs.write_record(Path(folder))
    return answer
