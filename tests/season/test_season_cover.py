"""The natural snow cover of a season, the strength of its slabs, and its first contact."""

from dataclasses import replace
from datetime import datetime, timedelta

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError, Scene
from snowshed.scene.components import Obstacle, Shape
from snowshed.season import SeasonSettings, accumulate
from snowshed.season.cover import natural_cover
from snowshed.season.panel_contact import first_contact
from snowshed.season.settling_column import SnowColumn
from snowshed.season.slabs import season_scene
from snowshed.season.weather.row import Weather


def days(*falls, warm=-4.0, depth=None, density=100.0):
    start = datetime(2024, 12, 1)
    return [
        Weather(i + 2, start + timedelta(days=i), fall, density, warm, snow_depth=depth)
        for i, fall in enumerate(falls)
    ]


def test_the_cover_is_the_settled_snowfall():
    depths = natural_cover(days(0.3, 0.0, 0.2), SeasonSettings())
    assert depths[0] == pytest.approx(0.3)
    assert 0.2 < depths[1] < 0.3
    assert depths[1] < depths[2] < depths[1] + 0.2
    assert natural_cover(days(0.3, 0.0, 0.2), SeasonSettings(settling=None))[2] == pytest.approx(
        0.5
    )


def test_positive_temperatures_melt_the_cover():
    """5 degrees melt 20 mm of water a day; 0.3 m of 100 kg/m3 melt in a day and a half."""
    without_settling = SeasonSettings(settling=None)
    assert natural_cover(days(0.3, 0.0, 0.0, warm=5.0), without_settling) == pytest.approx(
        [0.3, 0.1, 0.0]
    )


def test_measured_and_given_depths_take_precedence():
    assert natural_cover(days(0.3, 0.0, depth=0.8), SeasonSettings()) == [0.8, 0.8]
    assert natural_cover(days(0.3, 0.0), SeasonSettings(cover=0.5)) == [0.5, 0.5]
    assert natural_cover(days(0.3, 0.0), SeasonSettings(cover="none")) == [0.0, 0.0]
    with pytest.raises(InputError, match="cover: 'deep'; allowed: weather, none, a depth in m"):
        SeasonSettings(cover="deep")


def test_the_cover_melts_after_its_last_reading():
    """Readings end at 0.6 m; at 10 degrees the cover is gone after some days, not in autumn."""
    read = days(0.0, 0.0, depth=0.6)
    later = [
        replace(row, date=row.date + timedelta(days=2), temperature=10.0)
        for row in days(*[0.0] * 30)
    ]
    depths = natural_cover([*read, *later], SeasonSettings())
    assert depths[:2] == [0.6, 0.6] and 0.5 < depths[2] < 0.6
    assert depths[10] == 0.0 == depths[-1]
    grown = natural_cover(
        [*read, *(replace(row, snowfall=0.1) for row in later[:1])], SeasonSettings()
    )
    assert grown[2] == pytest.approx(depths[2] + 0.1)


def test_between_readings_the_cover_is_interpolated():
    rows = days(*[0.0] * 5)
    ends = [replace(rows[0], snow_depth=0.8), *rows[1:4], replace(rows[4], snow_depth=0.4)]
    assert natural_cover(ends, SeasonSettings()) == pytest.approx([0.8, 0.7, 0.6, 0.5, 0.4])


def test_a_column_merges_its_layers_beyond_a_thousand():
    column = SnowColumn(load_factor=9.81)
    for _ in range(5000):
        column.add(2.0, 100.0)
    assert column.mass == pytest.approx(10_000.0) and column.thickness == pytest.approx(100.0)
    assert len(column.masses) <= 1000


def slab_snow(density, settings):
    base = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03}).resolve()
    gathered = accumulate(days(0.2, density=density), settings, 50.0)
    scene = season_scene(base, gathered, settings).data
    return scene["slab"]["layers"][0]["snow"]


def panel_height(cover, **values):
    """Return the height of the panel in the scene of two slide-offs on a natural cover."""
    base = Scene.preset("lab-50").update({"dimension": 2, "panel.height": 1.0, **values}).resolve()
    settings = SeasonSettings(friction=0.1, cover=cover)
    gathered = accumulate(days(0.2, 0.3, density=100.0), settings, 50.0)
    return season_scene(base, gathered, settings).data["panel"]["height"]


def test_snow_falls_on_the_natural_cover():
    assert panel_height("none") == 1.0
    assert panel_height(0.3) == pytest.approx(0.7)
    settings = SeasonSettings(friction=0.1)
    depths = natural_cover(days(0.2, 0.3, density=100.0), settings)
    assert panel_height("weather") == pytest.approx(1.0 - np.mean(depths))


def test_a_panel_in_the_cover_stands_on_the_ground_of_the_slide_offs():
    assert panel_height(1.4) == 0.0


def test_obstacles_keep_the_ground():
    fence = Obstacle(name="fence", shape=Shape.box((2.0, 0.5), (0.1, 1.0)))
    assert panel_height(0.3, obstacles=[fence.to_data()]) == 1.0


def test_light_snow_is_weak_and_soft():
    own = Scene.preset("lab-50").resolve().data["snow"]
    light = slab_snow(80.0, SeasonSettings())
    ratio = light["preconsolidation_pressure"] / own["preconsolidation_pressure"]
    assert ratio == pytest.approx((80.0 / own["density"]) ** 2.44)
    assert light["youngs_modulus"] / own["youngs_modulus"] == pytest.approx(
        (80.0 / own["density"]) ** 2.94
    )
    rigid = slab_snow(80.0, SeasonSettings(strength=None))
    for name in ("preconsolidation_pressure", "youngs_modulus"):
        assert rigid[name] == own[name]


def test_thin_releases_slide_together_and_keep_their_mass():
    settings = SeasonSettings(friction=0.3, settling=None, pool_below=0.1)
    gathered = accumulate(days(*[0.05] * 7), settings, 60.0)
    slides = [day for day in gathered if day.event]
    assert [day.event for day in slides] == [1, 2]
    assert all(day.released for day in gathered)
    assert slides[0].slab_thickness == pytest.approx(0.1)  # four of 25 mm
    assert sum(day.slab_load for day in slides) == pytest.approx(sum(day.load for day in gathered))


def contact_table(**columns):
    rows = {
        "date": ["2024-12-01", "2024-12-02", "2024-12-03"],
        "event": pd.array([1, 2, None], dtype="Int64"),
        "stack_height_m": [0.3, 0.5, 0.5],
        "settled_height_m": [0.3, 0.5, 0.4],
        "settled_clearance_m": [0.5, 0.4, 0.4],
        "crest_clearance_m": [0.5, 0.3, 0.3],
        "joined": [0, 0, 0],
    }
    return pd.DataFrame({**rows, **columns})


def test_the_first_contact_of_any_kind_is_reported():
    assert first_contact(contact_table(), 0.03) is None
    crest = first_contact(contact_table(crest_clearance_m=[0.5, 0.02, 0.3]), 0.03)
    assert (crest.cause, crest.event, crest.date) == ("crest", 2, "2024-12-02")
    slab = first_contact(contact_table(joined=[1, 1, 1]), 0.03)
    assert (slab.cause, slab.event) == ("slab", 1)
    below = first_contact(contact_table(settled_clearance_m=[0.5, 0.4, 0.0]), 0.03)
    assert (below.cause, below.event, below.date) == ("below", 2, "2024-12-03")
    nothing = {"stack_height_m": [0.0] * 3, "settled_height_m": [0.0] * 3}
    cover = first_contact(contact_table(**nothing, crest_clearance_m=[0.5, 0.3, 0.0]), 0.03)
    assert cover.cause == "cover"
