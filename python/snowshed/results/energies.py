"""The energy balance of a run over time: its table and its picture."""

from __future__ import annotations

from pathlib import Path
from typing import Union

import snowshed._core as _core
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import write_csv
from snowshed.results.reader import HISTORY, Results

PICTURE = "energy.png"


def write_energy_history(simulation: _core.Simulation, folder: PathLike) -> None:
    """Write the energies over time so far into a results folder."""
    import pandas as pd

    table = pd.DataFrame(simulation.energy_history()).astype({"event": int})
    write_csv(table, Path(folder) / HISTORY, float_format="%.9g")


def draw_energies(folder: Union[PathLike, Results]) -> Path:
    """Draw the energies of a results folder over time as its energy.png, and return the path.

    Parameters
    ----------
    folder
        The folder, or its `Results`.

    Raises
    ------
    InputError
        If the energies are missing, or the table is damaged.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}, "output.energy": True})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder, pictures=False)
    ...     draw_energies(folder).name
    'energy.png'
    """
    from snowshed.plot.energy_figure import energy_figure
    from snowshed.plot.figure_style import save_figure

    results = folder if isinstance(folder, Results) else Results(folder)
    picture = results.folder / PICTURE
    save_figure(energy_figure(results.energy_history, results.scene.data), picture)
    return picture
