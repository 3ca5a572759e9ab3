"""The same stack in 2D and in 3D."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.formatting import plural
from snowshed.base.notes import ResultNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.results.folder import read_events
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    import pandas as pd

RULE_OF_THUMB = 2 / 3  # thesis 5.1: 3D over 2D height, when height and width are comparable


@checked
def dimension_ratio(df3: pd.DataFrame, df2: pd.DataFrame) -> pd.DataFrame:
    """Return the ratio of the stack heights in 3D and 2D, event by event.

    Parameters
    ----------
    df3, df2
        Tables of events of a 3D and a 2D run, with the columns `event` and `height_m`.

    Returns
    -------
    pandas.DataFrame
        Columns `event`, `height_3d_m`, `height_2d_m`, `ratio`, for the events both have.

    Examples
    --------
    >>> import pandas as pd
    >>> three = pd.DataFrame({"event": [1, 2], "height_m": [0.04, 0.06]})
    >>> two = pd.DataFrame({"event": [1, 2], "height_m": [0.05, 0.08]})
    >>> dimension_ratio(three, two).ratio.round(2).tolist()
    [0.8, 0.75]
    """
    return _ratio(df3, df2, "height_3d_m", "height_2d_m")


def compare_folders(first: PathLike, second: PathLike) -> pd.DataFrame:
    """Return `dimension_ratio` of two results folders, in either order.

    Raises
    ------
    InputError
        If they are not a 3D and a 2D run, or hold no results.
    """
    tables = {_dimension(folder): read_events(folder) for folder in (first, second)}
    if len(tables) < 2:
        raise InputError(f"{first}, {second}: both {next(iter(tables))}D; give a 3D and a 2D run")
    return dimension_ratio(tables[3], tables[2])


def same_dimension(first: PathLike, second: PathLike) -> bool:
    """Return whether two results folders are both of 2D or both of 3D runs; raises InputError."""
    return _dimension(first) == _dimension(second)


def height_ratio(first: PathLike, second: PathLike) -> pd.DataFrame:
    """Return the heights of the stacks of two runs, event by event, and their ratio.

    Returns
    -------
    pandas.DataFrame
        Columns `event`, `height_1_m`, `height_2_m` and `ratio` (the first over the second).

    Raises
    ------
    InputError
        If a folder holds no results.
    """
    return _ratio(read_events(first), read_events(second), "height_1_m", "height_2_m")


def _ratio(
    over: pd.DataFrame, under: pd.DataFrame, over_name: str, under_name: str
) -> pd.DataFrame:
    """Return the heights of the events that two tables share under new names, and their ratio."""
    heights = [
        events[["event", "height_m"]].rename(columns={"height_m": name})
        for events, name in ((over, over_name), (under, under_name))
    ]
    alone = sorted({*over["event"]} ^ {*under["event"]})
    if alone:
        issue_note(
            f"{plural(len(alone), 'event')} of only one of the two runs left out "
            f"({', '.join(map(str, alone[:6]))})",
            ResultNote,
        )
    table: pd.DataFrame = heights[0].merge(heights[1], on="event")
    table["ratio"] = table[over_name] / table[under_name]
    return table


def _dimension(folder: PathLike) -> int:
    scene = Path(folder) / "scene.json"
    if not scene.is_file():
        raise InputError(f"{folder}: no results; it holds no scene.json")
    data = ResolvedScene.load(scene).data
    return int(data["dimension"])
