"""The pile of a season in pvlib's snow loss models."""

import importlib
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError
from snowshed.analysis.photovoltaics import (
    blocked_days,
    coverage_nrel,
    loss_townsend,
    monthly_table,
    pile_angle,
)

pvlib_snow = pytest.importorskip("pvlib.snow")
MONTHLY = pd.DataFrame(
    {
        "snow_total": [80.0, 60.0],
        "snow_events": [8, 6],
        "relative_humidity": [80.0, 75.0],
        "temp_air": [-5.0, -3.0],
        "poa_global": [80e3, 100e3],
        "pile_angle_deg": [40.0, 20.0],
    }
)
PANEL = {"surface_tilt": 35.0, "slant_height": 3.0, "lower_edge_height": 0.6}


def test_the_own_pile_agrees_with_the_model_at_its_fixed_angle():
    loss = loss_townsend(MONTHLY, **PANEL)
    assert loss["loss_own_pile"][0] == loss["loss_fixed_pile"][0] > 0.0
    assert loss["loss_own_pile"][1] < loss["loss_fixed_pile"][1]  # a flatter pile interferes less
    by_pvlib = pvlib_snow.loss_townsend(
        np.array([80.0, 60.0]), np.array([8, 6]), 35.0, np.array([80.0, 75.0]),
        np.array([-5.0, -3.0]), np.array([80e3, 100e3]), 3.0, 0.6,
    )  # fmt: skip
    np.testing.assert_allclose(loss["loss_fixed_pile"], by_pvlib)


def test_a_triangle_against_the_row_has_its_own_angle():
    for angle in (20.0, 40.0, 60.0):
        area = 0.5 * 1.3**2 / np.tan(np.radians(angle))
        assert pile_angle(1.3, area) == pytest.approx(angle)


def test_no_snow_slides_while_the_pile_reaches_the_edge():
    hours = pd.date_range("2024-01-01", periods=48, freq="h")
    fall = pd.Series(np.where(np.arange(48) == 1, 5.0, 0.0), index=hours)
    sun, warm = pd.Series(400.0, index=hours), pd.Series(2.0, index=hours)
    never, always = pd.Series(False, index=hours), pd.Series(True, index=hours)
    free = coverage_nrel(fall, sun, warm, 40.0, never)
    pd.testing.assert_series_equal(free, pvlib_snow.coverage_nrel(fall, sun, warm, 40.0))
    assert free.iloc[-1] == 0.0
    assert coverage_nrel(fall, sun, warm, 40.0, always).iloc[-1] == 1.0
    with pytest.raises(InputError, match="its index is not that of temp_air"):
        coverage_nrel(fall, sun, warm, 40.0, never.iloc[:-1])


def test_a_season_is_summed_by_month():
    season = pd.DataFrame(
        {
            "event": pd.array([None, 1, 2], dtype="Int64"),
            "date": ["2024-01-05", "2024-01-20", "2024-02-03"],
            "released": ["no", "yes", "yes"],
            "snowfall_m": [0.02, 0.3, 0.2],
            "temperature_c": [-4.0, -2.0, -6.0],
            "stack_height_m": [0.0, 0.4, 0.6],
            "clearance_m": [0.6, 0.2, 0.0],
            "settled_clearance_m": [0.6, 0.2, 0.0],
            "joined": [0, 0, 1],
        }
    )
    events = pd.DataFrame({"event": [1, 2], "volume_m3": [0.3, 0.5], "width_m": [1.0, 1.0]})
    table = monthly_table(season, events, 0.03)
    assert table["snow_total"].tolist() == pytest.approx([32.0, 20.0])
    assert table["snow_events"].tolist() == [1, 1]
    assert table["blocked_days"].tolist() == [0, 1]
    assert table["pile_height_m"].tolist() == [0.4, 0.6]
    assert table["pile_angle_deg"].iloc[0] == pytest.approx(pile_angle(0.4, 0.3))
    assert blocked_days(season, 0.03).tolist() == [False, False, True]


def synthetic_season(dates, fall, blocked):
    return pd.DataFrame(
        {
            "date": [day.isoformat() for day in dates],
            "snowfall_m": fall,
            "temperature_c": -5.0,
            "event": pd.array([None] * len(dates), dtype="Int64"),
            "released": "no",
            "stack_height_m": 0.3,
            "clearance_m": np.where(blocked, 0.0, 0.5),
            "settled_clearance_m": np.where(blocked, 0.0, 0.5),
            "joined": 0,
        }
    )


NOTHING = pd.DataFrame({"event": [], "volume_m3": [], "width_m": []})


@pytest.mark.parametrize("hours", [1, 6, 24])
def test_days_are_counted_by_date_for_rows_of_any_length(hours):
    """12 cm on every sixth day; the pile reaches the edge from 10 January on."""
    dates = pd.date_range("2024-12-01", "2025-01-31 23:00", freq=f"{hours}h")
    day = (dates - dates[0]).days
    fall = np.where(day % 6 == 0, 0.12 * hours / 24, 0.0)
    table = monthly_table(
        synthetic_season(dates, fall, dates >= pd.Timestamp("2025-01-10")), NOTHING, 0.02
    )
    assert table["snow_total"].tolist() == pytest.approx([72.0, 60.0])
    assert table["snow_events"].tolist() == [6, 5]
    assert table["blocked_days"].tolist() == [0, 22]


def test_a_row_holds_until_the_next():
    """Only snowfalls have rows: the pile blocks from 5 January to 31 March, also in February."""
    dates = pd.to_datetime(["2024-12-01", "2025-01-05", "2025-01-20", "2025-03-31"])
    table = monthly_table(
        synthetic_season(dates, [0.4, 0.4, 0.4, 0.0], [False, True, True, True]), NOTHING, 0.02
    )
    assert table["blocked_days"].tolist() == [0, 27, 28, 31]
    assert table["snow_total"].tolist() == pytest.approx([40.0, 80.0, 0.0, 0.0])
    assert table["snow_events"].tolist() == [1, 2, 0, 0]
    assert table.index[2] == pd.Period("2025-02")


def test_far_dates_are_refused():
    dates = pd.to_datetime(["1700-12-01", "2025-01-05"])
    with pytest.raises(InputError, match="it spans 1700-12-01 to 2025-01-05; at most"):
        monthly_table(synthetic_season(dates, [0.1, 0.1], [False, False]), NOTHING, 0.02)
    wrong = synthetic_season(dates, [0.1, 0.1], [False, False]).assign(
        date=["0224-01-01", "2024-01-02"]
    )
    with pytest.raises(InputError, match="column date"):
        monthly_table(wrong, NOTHING, 0.02)


def test_the_short_name_is_a_module():
    code = (
        "from snowshed.pv import monthly_table; import snowshed.pv, snowshed; "
        "from snowshed.analysis import photovoltaics; "
        "assert snowshed.pv.monthly_table is photovoltaics.monthly_table is monthly_table; "
        "print('good')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "good\n", done.stderr
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("snowshed.pvx")
