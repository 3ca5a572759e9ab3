"""Units that the names of columns end with."""

import pytest

from snowshed.base.units import unit_of_column
from snowshed.results.folder import EVENT_COLUMNS
from snowshed.results.season_folder import SEASON_COLUMNS
from snowshed.study.database import STORED_TYPES


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("damping_rate_per_s", "1/s"),
        ("updates_per_s", "1/s"),
        ("mass_kg_per_m", "kg/m"),
        ("sim_time_s", "s"),
        ("peak_speed_m_s", "m/s"),
        ("irradiance_w_m2", "W/m2"),
        ("panel_load_kg_m2", "kg/m2"),
        ("force_kn", "kN"),
        ("super_s", "s"),
    ],
)
def test_a_unit_is_that_of_the_whole_ending(column, unit):
    assert unit_of_column(column) == unit


def test_rates_of_all_tables_are_per_unit():
    columns = [*EVENT_COLUMNS, *SEASON_COLUMNS, *STORED_TYPES]
    rates = [name for name in columns if "_per_" in name]
    assert rates and all("/" in unit_of_column(name) for name in rates)
