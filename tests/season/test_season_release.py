"""Accumulation, release and settling, against closed forms and an ODE solver."""

import datetime
import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

from snowshed import InputError, Scene
from snowshed.season import SeasonSettings, Weather, accumulate, snow_balance
from snowshed.season.accumulation import pauses
from snowshed.season.settling_column import SnowColumn
from snowshed.season.stack_settling import SettlingStack
from snowshed.season.table import season_table
from snowshed.snow import SETTLING_LAWS

DAY = 86400.0


def season(*snowfalls, density=100.0, temperature=-5.0, days=1):
    start = datetime.datetime(2024, 12, 1)
    step = datetime.timedelta(days=days)
    return [
        Weather(2 + i, start + i * step, snowfall, density, temperature)
        for i, snowfall in enumerate(snowfalls)
    ]


@pytest.mark.parametrize("tilt", [10.0, 30.0, 40.0, 50.0])
def test_without_adhesion_the_friction_limit_is_the_tangent_of_the_tilt(tilt):
    limit = math.tan(math.radians(tilt))
    for load in (0.1, 100.0):
        assert snow_balance(load, tilt, limit * 0.999, 0.0).releases
        assert not snow_balance(load, tilt, limit * 1.001, 0.0).releases


def test_snow_at_30_degrees_stays_at_measured_frictions_and_slides_below_them():
    load = 210.0 * 0.02
    assert not any(snow_balance(load, 30.0, friction, 0.0).releases for friction in (0.6, 0.7, 0.8))
    assert snow_balance(load, 30.0, 0.57, 0.0).releases
    assert all(snow_balance(load, 40.0, friction, 0.0).releases for friction in (0.6, 0.7, 0.8))


def test_with_adhesion_snow_gathers_up_to_the_closed_form():
    tilt, friction, adhesion, gravity = 40.0, 0.6, 40.0, 9.81
    slope = math.radians(tilt)
    limit = adhesion / (gravity * (math.sin(slope) - friction * math.cos(slope)))
    load_per_day = 100.0 * 0.05 * math.cos(slope)  # kg per m2 of the panel
    events = [
        day.event
        for day in accumulate(
            season(*[0.05] * 20),
            SeasonSettings(friction=friction, adhesion=adhesion),
            tilt,
            gravity,
        )
    ]
    needed = math.floor(limit / load_per_day) + 1
    assert [i + 1 for i, event in enumerate(events) if event] == list(range(needed, 21, needed))
    assert [event for event in events if event] == list(range(1, 20 // needed + 1))


def warm_spell(temperature, **settings):
    """Return snow of 10 kg/m2 on a panel of 60 degrees that held it, and the days after it."""
    cold, *later = season(0.2, 0.0, 0.0, 0.0, 0.0)
    days = [cold, *(replace(day, temperature=temperature) for day in later)]
    return accumulate(days, SeasonSettings(settling=None, **settings), 60.0)


def test_snow_on_the_panel_melts_by_degree_days():
    days = warm_spell(1.5, friction=5.0)
    expected = [10.0, 10.0, 4.0, 0.0, 0.0]  # 4 mm of water per day and degree, from the next row on
    assert [day.load for day in days] == pytest.approx(expected)
    assert not any(day.released for day in days)
    unchanged = pytest.approx([10.0] * 5)
    assert [day.load for day in warm_spell(0.0, friction=5.0)] == unchanged
    assert [day.load for day in warm_spell(1.5, friction=5.0, melt_factor=0.0)] == unchanged


def test_wet_snow_does_not_adhere():
    released = [day.released for day in warm_spell(0.5, friction=0.5, adhesion=500.0)]
    assert released == [False, True, False, False, False]
    assert not any(day.released for day in warm_spell(-0.5, friction=0.5, adhesion=500.0))
    dry = warm_spell(0.5, friction=0.5, adhesion=500.0, thaw=None)
    assert not any(day.released for day in dry)


def test_sunshine_frees_snow_in_cold_air():
    """Marion et al. 2013: snow slides if the air is warmer than -I / 80 degrees C."""
    held = SeasonSettings(adhesion=1e4)
    row = Weather(2, datetime.datetime(2024, 12, 1), 0.3, 100.0, -5.0)
    for irradiance, slides in ((None, False), (390.0, False), (410.0, True), (-9.0, False)):
        day = accumulate([replace(row, irradiance=irradiance)], held, tilt=60.0)[0]
        assert day.released is slides


def test_the_melt_of_a_stack_counts_once_over_its_events():
    """10 kg/m2 of 200 kg/m3 are 5 cm, also after later events."""
    stack = SettlingStack(None, 9.81)
    stack.melt(50.0)  # before there is a stack
    stack.set_stack(0.5, 200.0)
    stack.melt(10.0)
    assert stack.ratio == pytest.approx(0.9)
    stack.set_stack(0.8, 200.0)
    assert stack.ratio == pytest.approx(1.0 - 0.05 / 0.8)
    stack.melt(1000.0)
    assert stack.ratio == 0.0


@pytest.mark.parametrize(("cover", "melts"), [("weather", False), ("none", True), (0.3, True)])
def test_the_melt_of_the_cover_does_not_count_twice(cover, melts):
    """As long as there is a natural cover, its melt lowers the stack that lies on it."""
    rows = [
        Weather(2 + n, datetime.datetime(2024, 3, 1 + n), 0.0, None, 5.0, snow_depth=0.5)
        for n in range(3)
    ]
    rows[0] = replace(rows[0], snowfall=0.3, density=100.0, adhesion=0.0)
    settings = SeasonSettings(cover=cover, settling=None, friction=0.5)
    days = accumulate(rows, settings, tilt=60.0)
    names = ("event", "height_m", "length_m", "density_kg_m3", "on_panel_kg", "joined")
    events = pd.DataFrame([(1, 0.4, 1.0, 200.0, 0.0, 0)], columns=names)
    outlines = pd.DataFrame({"event": [1, 1], "x": [0.6, 1.0], "z": [0.4, 0.0]})
    scene = Scene.preset("lab-50").resolve().data
    table = season_table(scene, days, settings, events, outlines)
    assert table["event"].tolist()[0] == 1
    assert bool(table["settled_height_m"].iloc[-1] < 0.4) is melts


def test_the_adhesion_of_a_row_holds_in_warm_air_too():
    cold, warm = season(0.2, 0.0)
    warm = replace(warm, temperature=2.0, adhesion=500.0)
    days = accumulate([cold, warm], SeasonSettings(friction=0.5, adhesion=500.0), 60.0)
    assert not any(day.released for day in days)


def test_an_unknown_criterion_of_thaw_is_refused():
    with pytest.raises(InputError, match="thaw: 'sun'; allowed: marion-2013, or None"):
        SeasonSettings(thaw="sun")
    with pytest.raises(InputError, match="melt_factor: -1 is outside the allowed range"):
        SeasonSettings(melt_factor=-1.0)


def test_mass_per_area_of_ground_agrees_with_the_snowfall():
    tilt = 60.0
    (day,) = accumulate(season(0.4, density=80.0), SeasonSettings(friction=5.0), tilt)
    assert day.load / math.cos(math.radians(tilt)) == pytest.approx(0.4 * 80.0)
    assert day.thickness == pytest.approx(0.4 * math.cos(math.radians(tilt)))


def test_wind_removes_its_share_and_days_have_their_own_friction():
    rows = season(0.4)
    (day,) = accumulate(rows, SeasonSettings(catch=0.25), 0.0)
    assert day.load == pytest.approx(10.0)
    slippery = [Weather(2, rows[0].date, 0.4, 100.0, 0.0, friction=0.1, adhesion=0.0)]
    (day,) = accumulate(slippery, SeasonSettings(friction=0.9, adhesion=1e4), 20.0)
    assert day.event == 1


def test_a_missing_density_is_estimated_from_the_temperature():
    (day,) = accumulate(season(0.2, density=None, temperature=0.0), SeasonSettings(), 0.0)
    assert day.density == pytest.approx(67.92 + 51.25)


@pytest.mark.parametrize("name", SETTLING_LAWS)
def test_settling_of_one_layer_against_an_ode_solver(name):
    law, mass, start, temperature = SETTLING_LAWS[name], 40.0, 90.0, -3.0
    stress = np.array([0.5 * mass * 9.81])

    def rate(_, density):
        return density * law(density, stress, temperature)

    exact = solve_ivp(rate, (0.0, 10 * DAY), [start], rtol=1e-9, atol=1e-9).y[0, -1]
    column = SnowColumn(load_factor=9.81)
    column.add(mass, start)
    column.settle(law, 10 * DAY, temperature)
    assert column.density == pytest.approx(exact, rel=0.01)
    assert column.mass == mass


def test_lower_layers_settle_more_and_warm_ones_faster():
    def settled(temperature):
        column = SnowColumn(load_factor=9.81)
        for _ in range(3):
            column.add(20.0, 100.0)
        column.settle(SETTLING_LAWS["vionnet-2012"], 5 * DAY, temperature)
        return column.densities

    assert np.all(np.diff(settled(-10.0)) < 0)
    assert np.all(settled(-1.0) > settled(-10.0))


def test_settling_never_changes_the_mass():
    rows = season(0.3, 0.0, 0.0, days=10)
    unsettled = accumulate(rows, SeasonSettings(friction=2.0, settling=None), 30.0)
    settled = accumulate(rows, SeasonSettings(friction=2.0, settling="essery-2013"), 30.0)
    assert unsettled[0].thickness == unsettled[2].thickness
    assert settled[2].thickness < settled[1].thickness < settled[0].thickness
    assert settled[2].load == unsettled[2].load


def test_a_stack_settles_between_events_and_restarts_at_each():
    stack = SettlingStack(SETTLING_LAWS["vionnet-2012"], 9.81)
    stack.set_stack(0.5, 150.0)
    stack.settle(20 * DAY, -5.0)
    assert 0.3 < stack.ratio < 1.0
    stack.set_stack(1.0, 160.0)
    assert stack.ratio == 1.0


def test_pauses_lie_between_events_at_the_temperature_of_the_earlier_row():
    rows = season(0.3, 0.0, 0.3, 0.3, days=2)
    days = accumulate(rows, SeasonSettings(friction=0.1), 30.0)
    assert [day.event for day in days] == [1, None, 2, 3]
    temperatures = [row.temperature for row in rows]
    assert pauses(days) == {
        2: [(2 * DAY, temperatures[0]), (2 * DAY, temperatures[1])],
        3: [(2 * DAY, temperatures[2])],
    }


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"friction": -1.0}, "friction: -1 is outside the allowed range"),
        ({"adhesion": math.nan}, "adhesion: nan is outside the allowed range .* Pa"),
        ({"catch": 1.5}, "catch: 1.5 is outside the allowed range"),
        ({"density": "guess"}, "density: 'guess' is unknown; allowed: hedstrom"),
        ({"settling": "guess"}, "settling: 'guess'; allowed: vionnet-2012"),
    ],
)
def test_bad_settings_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        SeasonSettings(**values)
