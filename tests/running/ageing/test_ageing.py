"""Settling and sintering of simulated stacks between events."""

import json

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene

from snowshed import InputError, Interrupted, Scene, Shape, _core, run_events
from snowshed.running import Ageing, Interval
from snowshed.running.sequence import open_sequence
from snowshed.season.settling_column import SnowColumn
from snowshed.snow import SETTLING_LAWS, SINTERING_LAWS

DAY = 86400.0
WEEK = [Interval(2 * DAY, -3.0), Interval(5 * DAY, -8.0)]


def block_of_snow(height=1.0, **values):
    """A block without ground, observed only between events."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.05, **values})
    scene.panel = scene.slab = None
    scene.update({"events.count": 2, "events.max_time": 1e-4, "events.rest_time": 1e-5})
    scene.set("numerics.threads", 1)
    shape = Shape.box((0, height / 2), (0.8, height))
    scene.append("bodies", {"shape": shape, "event": 1})
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    simulation.run(lambda _: True)
    return simulation


def middle(simulation):
    return np.abs(simulation.positions()[:, 0]) < 0.2


def test_a_block_settles_as_a_column_of_thin_layers():
    simulation = block_of_snow()
    column = SnowColumn(load_factor=9.81)
    for _ in range(200):
        column.add(210.0 / 200, 210.0)
    for interval in WEEK:
        column.settle(SETTLING_LAWS["vionnet-2012"], *interval)
    mass, before = simulation.masses().sum(), simulation.positions()
    row = Ageing({2: WEEK}, settling="vionnet-2012").apply(simulation, 2, 9.81)
    inner = middle(simulation)
    drops = (before - simulation.positions())[inner, 2]
    layers = 1 / 200 - column.masses / column.densities
    expected = np.interp(before[inner, 2], np.linspace(0, 1, 201), np.insert(layers, 0, 0).cumsum())
    upper = before[inner, 2] > 0.5
    assert drops[upper].mean() == pytest.approx(expected[upper].mean(), rel=0.02)
    assert np.abs(drops - expected).max() < 0.1 * expected.max()
    density = np.average(simulation.densities()[inner], weights=simulation.masses()[inner])
    assert density == pytest.approx(np.average(column.densities), rel=0.02)
    assert simulation.masses().sum() == mass
    assert simulation.positions()[:, :2] == pytest.approx(before[:, :2], abs=1e-7)
    assert row["hours"] == 7 * 24 and row["temperature_c"] == pytest.approx(-46 / 7)
    assert row["crest_sank_m"] == pytest.approx(drops.max(), rel=0.1)
    assert row["density_kg_m3"] > row["density_before_kg_m3"] == pytest.approx(210, rel=1e-3)


def break_snow(simulation, plastic_strain):
    """Give all snow a volumetric plastic strain."""
    change = plastic_strain - simulation.plastic_strains()
    simulation.settle(np.zeros(len(change)), change)


def strength(simulation):
    """p0 of (1.1.42) relative to new snow, computed independently."""
    snow = json.loads(simulation.snows[0])
    bulk = snow["youngs_modulus"] / (3 * (1 - 2 * snow["poissons_ratio"]))
    strains = np.minimum(simulation.plastic_strains(), 0.0)
    return bulk * np.sinh(-snow["hardening_factor"] * strains) / snow["preconsolidation_pressure"]


@pytest.mark.parametrize("name", SINTERING_LAWS)
def test_broken_snow_regains_strength_with_a_power_of_time(name):
    exponent = SINTERING_LAWS[name].exponent
    for hours, expected in [(1.0, (1 / 24) ** exponent), (24.0, 1.0), (240.0, 1.0)]:
        simulation = block_of_snow(0.3)
        break_snow(simulation, 0.2)
        row = Ageing({2: [Interval(3600 * hours, -5.0)]}, sintering=name).apply(simulation, 2, 9.81)
        assert strength(simulation) == pytest.approx(expected, rel=1e-4)
        assert (row["intact_before"], row["crest_sank_m"]) == (0.0, 0.0)
        assert row["intact"] == pytest.approx(expected, rel=1e-4)


def test_two_pauses_strengthen_as_one_and_strong_snow_is_unchanged():
    law = SINTERING_LAWS["podolskiy-2014"]
    start = np.array([0.0, 0.1, 0.7, 1.0, 3.0])
    twice = law.strengthen(law.strengthen(start, 0.2), 0.3)
    assert twice == pytest.approx(law.strengthen(start, 0.5))
    assert (twice >= start).all() and twice[3:].tolist() == [1.0, 3.0]


@pytest.fixture(scope="module")
def aged(tmp_path_factory):
    folder = tmp_path_factory.mktemp("aged") / "results"
    ageing = Ageing({2: WEEK}, "vionnet-2012", "van-herwijnen-2013")
    return run_events(tiny_scene(), folder, ageing=ageing, pictures=False), folder, ageing


def test_a_stack_ages_between_its_events(aged, finished):
    table, folder, _ = aged
    unaged = pd.read_csv(finished / "events.csv")
    row = pd.read_csv(folder / "ageing.csv").iloc[0]
    assert row["event"] == 2
    assert 0 < row["crest_sank_m"] < table.height_m[0]
    assert row["density_kg_m3"] > row["density_before_kg_m3"]
    assert row["intact"] > row["intact_before"]
    measures = ["height_m", "length_m", "mass_kg"]
    # The other run records the energy balance, with kernels that round differently.
    expected = unaged.loc[0, measures].tolist()
    assert table.loc[0, measures].tolist() == pytest.approx(expected, rel=1e-5)
    assert table.mass_kg[1] == pytest.approx(unaged.mass_kg[1], rel=1e-3)
    assert table.height_m[1] != unaged.height_m[1]


def test_an_interrupted_run_ages_as_an_uninterrupted_one(aged, tmp_path):
    table, folder, ageing = aged

    def stop(report):
        if report.event == 2:
            raise KeyboardInterrupt

    with pytest.raises((KeyboardInterrupt, Interrupted)):
        run_events(tiny_scene(), tmp_path / "a", ageing=ageing, progress=stop, pictures=False)
    resumed = run_events(tiny_scene(), tmp_path / "a", ageing=ageing, resume=True, pictures=False)
    measured = ["height_m", "length_m", "head_m", "tail_m", "volume_m3"]
    assert resumed[measured].equals(table[measured])
    assert (tmp_path / "a" / "ageing.csv").read_bytes() == (folder / "ageing.csv").read_bytes()


def test_a_run_resumes_only_with_its_ageing(aged):
    _, folder, _ = aged
    for changed in (None, Ageing({2: WEEK}, "essery-2013")):
        with pytest.raises(InputError, match=r"ageing\.json: ageing settings differ"):
            run_events(tiny_scene(), folder, ageing=changed, resume=True, pictures=False)


def test_a_run_killed_before_its_first_event_ages_when_resumed(aged, tmp_path):
    """Its folder holds the scene, but no ageing settings yet."""
    table, folder, ageing = aged
    with open_sequence(tiny_scene().resolve(), tmp_path / "a", resume=False):
        pass
    resumed = run_events(tiny_scene(), tmp_path / "a", ageing=ageing, resume=True, pictures=False)
    assert resumed["height_m"].equals(table["height_m"])
    assert (tmp_path / "a" / "ageing.json").read_bytes() == (folder / "ageing.json").read_bytes()


def test_without_laws_or_time_nothing_changes(tmp_path, finished):
    for number, ageing in enumerate([Ageing({2: WEEK}), Ageing({3: WEEK}, "vionnet-2012")]):
        folder = tmp_path / str(number)
        run_events(tiny_scene(**{"output.energy": True}), folder, ageing=ageing, pictures=False)
        assert (folder / "outline.csv").read_bytes() == (finished / "outline.csv").read_bytes()
        assert not (folder / "ageing.csv").exists()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"settling": "guess"}, "settling: 'guess'; allowed: vionnet-2012, essery-2013"),
        ({"sintering": "guess"}, "sintering: 'guess'; allowed: van-herwijnen-2013"),
        ({"strength_age": 0.0}, "strength_age: 0.0 hours; must be positive"),
        ({"strength_age": float("nan")}, "strength_age: nan hours; must be positive"),
    ],
)
def test_bad_settings_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        Ageing(**values)


def test_reseeded_snow_cannot_age(tmp_path):
    scene = tiny_scene(**{"events.between": "reseed"})
    with pytest.raises(InputError, match='/events/between: "reseed" replaces the snow'):
        run_events(scene, tmp_path / "a", ageing=Ageing({2: WEEK}, "vionnet-2012"))
    assert not (tmp_path / "a").exists()


def test_snow_ages_between_events_only():
    simulation = block_of_snow(0.3)
    simulation.begin_event()
    count = simulation.particle_count
    with pytest.raises(InputError, match="an event is running"):
        simulation.settle(np.zeros(count), np.zeros(count))


@pytest.mark.parametrize(
    ("interval", "message"),
    [
        (("a", 2), r"pauses\[2\]\[1\], seconds: 'a'; needed: a finite number"),
        ((True, 2), "seconds: True; needed: a finite number"),
        ((60.0, None), "temperature: None; needed: a finite number"),
        ((np.nan, -5.0), "seconds: nan; needed: a finite number"),
        ((-60.0, -5.0), "seconds: -60; needed: not negative"),
        ((60.0, -300.0), "temperature: -300 °C is below absolute zero"),
    ],
)
def test_intervals_that_cannot_be_times_at_a_temperature_are_refused(interval, message):
    with pytest.raises(InputError, match=message):
        Ageing({2: [WEEK[0], Interval(*interval)]}, settling="vionnet-2012")


def test_intervals_of_numpy_are_stored():
    ageing = Ageing({2: [Interval(np.int64(60), np.float32(-5.0))]}, settling="vionnet-2012")
    assert Ageing.from_data(ageing.data, "here") == ageing


# --- as JSON ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pauses": []}, "pauses: not an object"),
        ({"pauses": {"two": []}}, "two is not the number of an event"),
        ({"pauses": {"2": [[1.0]]}}, "not pairs of seconds"),
        ({"pauses": {"2": [[-1.0, 0.0]]}}, "not pairs of seconds"),
        ({"pauses": {"2": [["1", 0.0]]}}, "not pairs of seconds"),
        ({"settling": "no-such-law"}, "no-such-law"),
        ({"sintering": 3}, "sintering: neither a name nor null"),
        ({"strength_age": True}, "strength_age: not a number"),
        ({"more": 1}, "needed: an object with pauses, settling, sintering, strength_age"),
    ],
)
def test_damaged_data_are_named(change, message):
    data = {**Ageing({2: [Interval(60.0, -3.0)]}).data, **change}
    with pytest.raises(InputError, match=message):
        Ageing.from_data(data, "here")
