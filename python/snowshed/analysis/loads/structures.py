"""The loads on structures over all events of a run, as a designer needs them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.base.arguments import checked

if TYPE_CHECKING:
    import pandas as pd

#: Windows of the peaks, ms, as in the columns of loads.csv.
WINDOWS = (1, 10, 100)
#: The window whose peak has a direction and a time in tables, ms.
DIRECTED = 10


def kilo(value: float) -> str:
    """Return a load in thousands for a table; less than half a unit is 0.

    Examples
    --------
    >>> kilo(-1234.5), kilo(8e-17)
    ('-1.23', '0')
    """
    return f"{value / 1000:.3g}" if abs(value) >= 0.5 else "0"


@checked
def structure_loads(loads: pd.DataFrame) -> pd.DataFrame:
    """Return the largest loads on each obstacle over all events.

    Parameters
    ----------
    loads
        The loads of each event, as from `Results.loads`.

    Returns
    -------
    pandas.DataFrame
        A row for each obstacle: the largest force at rest, with its direction, the event after
        which it acts, and its pressure; the largest peaks with their events; direction and time
        of the largest peak of 10 ms; the largest pressure.

    Examples
    --------
    >>> import pandas as pd
    >>> row = {"event": 1, "obstacle": "post", "at_rest": 1, "peak_pressure_pa": 900.0,
    ...        "rest_fx_n": 3.0, "rest_fy_n": 0.0, "rest_fz_n": -4.0, "rest_pressure_pa": 10.0,
    ...        **{f"peak_{w}ms_n": 50.0 for w in WINDOWS}, "peak_10ms_time_s": 0.4,
    ...        **{f"peak_10ms_f{axis}_n": 0.0 for axis in "xyz"}}
    >>> table = structure_loads(pd.DataFrame([row, {**row, "event": 2, "rest_fz_n": -8.0}]))
    >>> table[["obstacle", "rest_n", "rest_event"]].values.tolist()
    [['post', 8.54400374531753, 2]]
    """
    import pandas as pd

    rows = [
        {"obstacle": name, **_largest(of_obstacle)}
        for name, of_obstacle in loads.groupby("obstacle", sort=False)
    ]
    return pd.DataFrame(rows)


def _largest(loads: pd.DataFrame) -> Mapping[str, Any]:
    at_rest = np.sqrt(sum(loads[f"rest_f{axis}_n"].to_numpy(float) ** 2 for axis in "xyz"))
    most = int(np.argmax(at_rest))
    row = loads.iloc[most]
    largest: dict[str, Any] = {
        "rest_n": float(at_rest[most]),
        **{f"rest_f{axis}_n": float(row[f"rest_f{axis}_n"]) for axis in "xyz"},
        "rest_event": int(row["event"]),
        "rest_pressure_pa": float(loads["rest_pressure_pa"].max()),
    }
    for window in WINDOWS:
        peaks = loads[f"peak_{window}ms_n"].to_numpy(float)
        largest[f"peak_{window}ms_n"] = float(peaks.max())
        row = loads.iloc[int(np.argmax(peaks))]
        largest[f"peak_{window}ms_event"] = int(row["event"])
        if window == DIRECTED:
            for name in (*(f"f{axis}_n" for axis in "xyz"), "time_s"):
                largest[f"peak_{window}ms_{name}"] = float(row[f"peak_{window}ms_{name}"])
    largest["peak_pressure_pa"] = float(loads["peak_pressure_pa"].max())
    return largest
