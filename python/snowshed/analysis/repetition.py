"""Anything that was computed, again from its record alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from snowshed._core import InputError
from snowshed.analysis.clearance.inputs import recorded_clearance
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.input_file import read_input
from snowshed.results.computed_record import CLEARANCE, SEASON, record_kind
from snowshed.running.recorded_run import recorded_run
from snowshed.running.run import run
from snowshed.season.driver import simulate_season
from snowshed.season.repeated import recorded_season
from snowshed.study.definition import Study

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.analysis.clearance.answer import ClearanceResult
    from snowshed.results.reader import Results
    from snowshed.season.driver import SeasonResult


@checked
def repeat(
    record: PathLike,
    folder: PathLike,
    *,
    jobs: Optional[int] = None,
    progress: Optional[Reporter] = None,
) -> Union[Results, pd.DataFrame, SeasonResult, list[ClearanceResult]]:
    """Compute a run, a study, a season or a clearance again from its record alone.

    On the same build and kernels the numbers are the same to the bit.

    Parameters
    ----------
    record
        The run.json of a run, the ``NAME.json`` of a study, the season.json of a season or the
        clearance.json of a clearance; it may have any name.
    folder
        The results folder; new or empty. Of a study and a clearance it may hold some of the runs.
    jobs
        Runs at once, of a study or a clearance.
    progress
        Called about twice a second.

    Returns
    -------
    Results, pandas.DataFrame, SeasonResult or list of ClearanceResult
        As from `run`, `Study.run`, `run_season` and, for each panel, `clearance`.

    Warns
    -----
    SnowshedNote
        If the record is of another build, or a file that it names has changed.

    Raises
    ------
    InputError
        If the file is no record, or damaged.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.05}})
    >>> with TemporaryDirectory() as folder:
    ...     first = Study.product(tiny, {"panel.friction": [0.2, 0.3]}, name="two").run(folder)
    ...     again = repeat(f"{folder}/two.json", f"{folder}-again")
    >>> again.equals(first)
    True
    """
    file = Path(record)
    kind = record_kind(read_input(file))
    if kind is None:
        if recorded_run(file) is None:
            raise InputError(f"{file}: no record of a run, a study, a season or a clearance")
        return run(file, folder, progress=progress)
    if kind == SEASON:
        plan, settings = recorded_season(file)
        return simulate_season(plan, folder, settings=settings, progress=progress)
    if kind == CLEARANCE:
        inputs = recorded_clearance(file)
        answers = inputs.answers(Path(folder), jobs=jobs, progress=progress)
        inputs.write_record(Path(folder))
        return answers
    return Study.load(file).run(folder, jobs=jobs, progress=progress)
