"""Tables and figures of a sensitivity method from a stored study."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Optional

from snowshed._core import InputError
from snowshed.analysis.sensitivity.fixed_parameter import fixation_table
from snowshed.analysis.sensitivity.global_indices import morris_effects, sobol_indices
from snowshed.analysis.sensitivity.noise import seeding_noise
from snowshed.analysis.sensitivity.single_parameter import local_index
from snowshed.analysis.sensitivity.stored import StudyRuns, read_study_runs
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import write_csv

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

EVALUATIONS: Mapping[str, Callable[[StudyRuns], pd.DataFrame]] = {
    "s": local_index,
    "fixation": fixation_table,
    "sobol": sobol_indices,
    "morris": morris_effects,
}
NOISE = "noise"


@checked
def evaluate_sensitivity(
    stored: PathLike,
    folder: PathLike,
    method: str = "s",
    *,
    study: Optional[str] = None,
    measure: str = "stack",
    note: Optional[Callable[[str], None]] = None,
) -> pd.DataFrame:
    """Evaluate the computed runs of a stored study, and write tables and figures.

    Parameters
    ----------
    stored
        Folder of the store.
    folder
        Folder for ``METHOD.csv``, ``METHOD.png`` (for fixation one figure per group of parameters)
        and ``noise.csv``.
    method
        "s", "fixation", "sobol" or "morris".
    study
        Name of the study; not needed if the store holds only one.
    measure
        "stack": height and length of 97 % of the snow; "body": of the largest connected body.
    note
        Called with notes on the limits of the table.

    Returns
    -------
    pandas.DataFrame
        The method's table; see `local_index`, `fixation_table`, `sobol_indices`,
        `morris_effects`.

    Raises
    ------
    InputError
        If there is no such study, or its runs do not fit the method.
    """
    from snowshed.plot.figure_style import save_figure

    if method not in EVALUATIONS:
        raise InputError(f"method: {method!r} is unknown; allowed: {', '.join(EVALUATIONS)}")
    runs = read_study_runs(stored, study, measure)
    if note and runs.incomplete:
        note(
            f"{runs.incomplete} of {len(runs.points)} runs are not computed, have failed or left "
            "events without a stack: means and differences are of the others"
        )
    try:
        table = EVALUATIONS[method](runs)
    except InputError as error:
        raise InputError(f"{stored}: {runs.name}: {error}") from None
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(table, folder / f"{method}.csv")
    write_csv(seeding_noise(runs).reset_index(), folder / f"{NOISE}.csv")
    for name, figure in figures(method, table).items():
        save_figure(figure, folder / f"{name}.png")
    return table


def figures(method: str, table: pd.DataFrame) -> dict[str, Figure]:
    """Return the figures of a method's table, by name."""
    from snowshed.analysis.sensitivity import figures as drawing

    if method == "fixation":
        groups = list(dict.fromkeys(table["group"]))
        return {f"fixation-{name}": drawing.fixation_figure(table, name) for name in groups}
    draw = {
        "s": drawing.local_index_figure,
        "sobol": drawing.sobol_figure,
        "morris": drawing.morris_figure,
    }
    return {method: draw[method](table)}
