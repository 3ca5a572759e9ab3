"""The pile of a season in the snow loss models of pvlib, which engineers use.

pvlib is an extra (``pip install "snowshed[pv]"``); its functions are called with the pile of a
season. Names and angles are those of pvlib: ``surface_tilt`` in degrees from the horizontal.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.extras import require

if TYPE_CHECKING:
    import pandas as pd

EVENT_DAY = 0.0254  # m: a snowfall event of Townsend's model is a day with more than an inch
FIXED_ANGLE = 40.0  # degrees, the pile that the model assumes
MAX_DAYS = 200 * 366  # days of a table of months
MIN_ANGLE, MAX_ANGLE = 0.1, 89.0  # degrees


@checked
def pile_angle(height: float, area: float) -> float:
    """Return the angle of repose of the pile that Townsend's model should assume, degrees.

    The model lets the snow of a row fill a triangle against the row, of the height H of the lower
    edge and the area H^2 / (2 tan(angle)) (its ground interference term). A simulated pile with
    the height h and the cross section A fills such a triangle if tan(angle) = h^2 / (2 A).

    Parameters
    ----------
    height
        h, m.
    area
        A, m2: volume over width.

    Examples
    --------
    >>> round(pile_angle(1.0, 0.5), 1), round(pile_angle(0.5, 1.0), 1)
    (45.0, 7.1)
    """
    if not (height > 0.0 and area > 0.0):
        return FIXED_ANGLE
    angle = math.degrees(math.atan(height**2 / (2.0 * area)))
    return float(np.clip(angle, MIN_ANGLE, MAX_ANGLE))


@checked
def loss_townsend(
    monthly: pd.DataFrame,
    *,
    surface_tilt: float,
    slant_height: float,
    lower_edge_height: float,
    string_factor: float = 1.0,
) -> pd.DataFrame:
    """Return the monthly energy loss of Townsend's model, with its pile and with the simulated one.

    Parameters
    ----------
    monthly
        A row for each month with ``snow_total`` (cm), ``snow_events`` (days above 2.54 cm),
        ``relative_humidity`` (%), ``temp_air`` (degrees C), ``poa_global`` (Wh/m2 in the month),
        and ``pile_angle_deg`` (from `monthly_table`).
    surface_tilt, slant_height, lower_edge_height, string_factor
        As for `pvlib.snow.loss_townsend`, degrees and m.

    Returns
    -------
    pandas.DataFrame
        ``loss_fixed_pile`` and ``loss_own_pile``, parts from 0 to 1, by month.

    Raises
    ------
    InputError
        If a column is missing, or pvlib is not installed.
    """
    import pandas as pd

    snow = require("pvlib.snow", "pv", "the loss model of Townsend")
    needed = ("snow_total", "snow_events", "relative_humidity", "temp_air", "poa_global")
    for name in (*needed, "pile_angle_deg"):
        if name not in monthly:
            raise InputError(f"the monthly table: no column {name!r}")
    weather = [monthly[name].to_numpy(dtype=float) for name in needed]
    panel: dict[str, Any] = {
        "slant_height": slant_height,
        "lower_edge_height": lower_edge_height,
        "string_factor": string_factor,
    }
    total, events, humidity, temperature, insolation = weather
    losses = {
        name: snow.loss_townsend(
            total, events, surface_tilt, humidity, temperature, insolation,
            angle_of_repose=angle, **panel,
        )
        for name, angle in (
            ("loss_fixed_pile", FIXED_ANGLE),
            ("loss_own_pile", monthly["pile_angle_deg"].to_numpy(dtype=float)),
        )
    }  # fmt: skip
    return pd.DataFrame(losses, index=monthly.index)


@checked
def coverage_nrel(
    snowfall: pd.Series,
    poa_irradiance: pd.Series,
    temp_air: pd.Series,
    surface_tilt: float,
    blocked: pd.Series,
    **options: float,
) -> pd.Series:
    """Return the covered share of a row by the NREL model, with slides blocked by the pile.

    While the pile reaches the lower edge, the model is given air so cold that nothing slides; all
    else is `pvlib.snow.coverage_nrel`.

    Parameters
    ----------
    snowfall, poa_irradiance, temp_air, surface_tilt, options
        As for `pvlib.snow.coverage_nrel`: cm in each period, W/m2, degrees C, degrees.
    blocked
        Booleans with the same index: True while the pile reaches the edge (`blocked_days`).

    Raises
    ------
    InputError
        If the index of `blocked` differs, or pvlib is not installed.
    """
    snow = require("pvlib.snow", "pv", "the coverage model of NREL")
    if not blocked.index.equals(temp_air.index):
        raise InputError("blocked: its index is not that of temp_air")
    cold = temp_air.where(~blocked.astype(bool), -1e6)
    covered: pd.Series = snow.coverage_nrel(snowfall, poa_irradiance, cold, surface_tilt, **options)
    return covered


@checked
def plane_irradiance(
    global_horizontal: pd.Series,
    latitude: float,
    longitude: float,
    *,
    surface_tilt: float,
    surface_azimuth: float,
) -> pd.Series:
    """Return the sunshine on a tilted panel, W/m2, as a season's file gives it.

    The result is a column ``irradiance_w_m2``. The direct part of the radiation follows from Erbs
    et al. 1982, the sky is isotropic, and the ground reflects like snow (all by pvlib). Hours
    without radiation or sun have 0.

    Parameters
    ----------
    global_horizontal
        Global radiation on the level, W/m2, with an index of times with a time zone.
    latitude, longitude
        Degrees, positive to the north and to the east.
    surface_tilt, surface_azimuth
        Tilt of the panel from the horizontal, and the direction that it faces (180: south),
        degrees.

    Raises
    ------
    InputError
        If the times have no time zone, or pvlib is not installed.

    Examples
    --------
    >>> import pandas as pd
    >>> noon = pd.DatetimeIndex(["2024-12-21T11:30"], tz="UTC")
    >>> level = pd.Series([300.0], noon)
    >>> steep = plane_irradiance(level, 46.8, 9.8, surface_tilt=60.0, surface_azimuth=180.0)
    >>> bool(steep.iloc[0] > 1.5 * level.iloc[0])  # the sun of December is low
    True
    """
    solar = require("pvlib.solarposition", "pv", "the irradiance of a plane")
    sky = require("pvlib.irradiance", "pv", "the irradiance of a plane")
    times = global_horizontal.index
    if getattr(times, "tz", None) is None:
        raise InputError("global_horizontal: its times have no time zone; use tz_localize")
    sun = solar.get_solarposition(times, latitude, longitude)
    zenith = sun["apparent_zenith"]
    parts = sky.erbs(global_horizontal, zenith, times)
    plane = sky.get_total_irradiance(
        surface_tilt, surface_azimuth, zenith, sun["azimuth"],
        parts["dni"], global_horizontal, parts["dhi"], surface_type="snow",
    )  # fmt: skip
    irradiance: pd.Series = plane["poa_global"].fillna(0.0).rename("irradiance_w_m2")
    return irradiance


@checked
def blocked_days(season: pd.DataFrame, dx: float) -> pd.Series:
    """Return whether the snow below reaches the lower edge, by day; the index holds the dates.

    Parameters
    ----------
    season
        The table of a season, as in season.csv.
    dx
        Size of its grid cells, m: a gap of one cell counts as none.
    """
    import pandas as pd

    reached = (season["settled_clearance_m"] <= dx) | (season["joined"] > 0)
    days = pd.to_datetime(season["date"])
    return pd.Series(reached.to_numpy(), index=days, name="blocked")


@checked
def monthly_table(season: pd.DataFrame, events: pd.DataFrame, dx: float) -> pd.DataFrame:
    """Return the monthly quantities of a season that engineers need.

    Parameters
    ----------
    season
        The table of a season, as in season.csv.
    events
        The table of its slide-offs, as in run/events.csv; without rows if nothing slid.
    dx
        Size of the grid cells, m.

    Returns
    -------
    pandas.DataFrame
        One row per month, also for months without data: ``snow_total`` (cm), ``snow_events`` (days
        with more than 2.54 cm), ``temp_air`` (mean of the days), ``releases``, ``pile_height_m``
        and ``clearance_m`` (least), ``blocked_days``, ``pile_angle_deg`` for `loss_townsend`. Days
        count by their dates, for any spacing of the rows; a row holds until the next.

    Raises
    ------
    InputError
        If the dates cannot be dates of a season.
    """
    import pandas as pd

    area = dict(zip(events["event"], events["volume_m3"] / events["width_m"].replace(0.0, 1.0)))
    rows = pd.DataFrame(
        {
            "day": _dates(season).dt.normalize(),
            "snow": season["snowfall_m"],
            "warm": season["temperature_c"],
            "releases": season["released"] == "yes",
            "height": season["stack_height_m"],
            "clearance": season["clearance_m"],
            "blocked": blocked_days(season, dx).to_numpy(),
            "area": season["event"].map(area).ffill().fillna(0.0),
        }
    )
    days = _daily(rows)
    months = days.groupby(pd.PeriodIndex(days.index, freq="M"))
    height, largest = months["height"].max(), months["area"].max()
    return pd.DataFrame(
        {
            "snow_total": 100.0 * months["snow"].sum(),
            "snow_events": months["snow"].agg(lambda falls: int((falls > EVENT_DAY).sum())),
            "temp_air": months["warm"].mean(),
            "releases": months["releases"].sum().astype(int),
            "pile_height_m": height,
            "clearance_m": months["clearance"].min(),
            "blocked_days": months["blocked"].sum().astype(int),
            "pile_angle_deg": [pile_angle(*pair) for pair in zip(height, largest)],
        }
    ).rename_axis("month")


def _dates(season: pd.DataFrame) -> pd.Series:
    import pandas as pd

    try:
        dates = pd.Series(pd.to_datetime(season["date"])).reset_index(drop=True)
    except (ValueError, TypeError) as error:  # also of years that pandas cannot hold
        raise InputError(f"the season, column date: {error}") from None
    if dates.empty:
        raise InputError("the season: no rows")
    if (dates.iloc[-1] - dates.iloc[0]).days > MAX_DAYS:
        raise InputError(
            f"the season, column date: it spans {dates.iloc[0].date()} to "
            f"{dates.iloc[-1].date()}; at most {MAX_DAYS} days are allowed"
        )
    return dates


def _daily(rows: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each day from the first to the last, for rows of any spacing.

    A day without a row has the state of the last row before it; for a day with rows, its initial
    state counts, too.
    """
    import pandas as pd

    by_day = rows.groupby("day")
    every = pd.date_range(rows["day"].iloc[0], rows["day"].iloc[-1], freq="D")
    sums = by_day[["snow", "releases"]].sum().reindex(every, fill_value=0)
    last = by_day[["height", "clearance", "blocked", "area"]].last().reindex(every).ffill()
    state = {"height": "max", "clearance": "min", "blocked": "max", "area": "max"}
    within = by_day.agg(state).reindex(every)
    within = within.where(within.notna(), last)
    warm = by_day["warm"].mean().reindex(every).ffill()
    return pd.concat([sums, within, warm], axis=1).astype({"blocked": bool})
