"""The first lines that a scientist would try."""

from dataclasses import replace
from datetime import date, timedelta

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.slide_files import plane, write_polygons

import snowshed
from snowshed import InputError, Panel, Results, Scene, Simulation, Slab, Study
from snowshed.analysis.clearance import SnowRanges
from snowshed.io import write_raster

TINY = {"dimension": 2, "numerics.dx": 0.02, "events.count": 1, "events.max_time": 0.1}


@pytest.fixture
def tiny():
    return Scene.preset("lab-50").update(TINY)


def test_a_scene_file_is_run(tiny, tmp_path):
    tiny.resolve().save(tmp_path / "scene.json")
    results = snowshed.run(str(tmp_path / "scene.json"), str(tmp_path / "out"), pictures=False)
    assert isinstance(results, Results)
    assert results.events.event.tolist() == [1]
    assert results.stack.height == results.events.height_m.iloc[-1] or np.isnan(
        results.stack.height
    )


def test_a_scene_of_parts_is_run(tmp_path):
    scene = Scene(
        dimension=2,
        panel=Panel(height=0.33, length=0.245, tilt=40),
        slab=Slab(thickness=0.04),
        **{"events": snowshed.Events(count=1, max_time=0.05)},
    ).set("numerics.dx", 0.02)
    assert len(snowshed.run_events(scene, tmp_path / "out", pictures=False)) == 1


def test_values_are_set_and_checked():
    scene = Scene.preset("lab-50")
    scene.panel.tilt = 60
    assert scene.resolve().data["panel"]["tilt"] == 60
    scene.panel.tilt = 100
    with pytest.raises(InputError, match="/panel/tilt"):
        scene.resolve()


def test_parts_that_every_scene_has_can_be_set():
    scene = Scene(panel=Panel(height=0.33, length=0.245, tilt=40))
    scene.snow.density = 250
    assert scene.snow.density == 250


def test_a_simulation_begins_its_event(tiny):
    simulation = Simulation(tiny)
    simulation.run()
    assert simulation.event == 1
    assert simulation.positions().shape == (simulation.particle_count, 3)


def test_results_are_tables_and_datasets(tiny, tmp_path):
    snowshed.run(tiny.set("output.film_interval", 0.05), tmp_path / "out", pictures=False)
    results = Results(tmp_path / "out")
    assert results.events.attrs["units"]["height_m"] == "m"
    assert len(results.particles(1)["position"])
    assert results.film_dataset().sizes["frame"] >= 1


def test_scenes_of_a_loop_are_different():
    base = Scene.preset("lab-50")
    scenes = [base.with_({"panel.tilt": tilt}) for tilt in (30, 40)]
    assert [scene.panel.tilt for scene in scenes] == [30, 40]
    assert base.panel.tilt == 50


def test_a_study_is_run(tiny, tmp_path):
    table = Study.product(tiny, {"panel.tilt": [40, 50]}).run(tmp_path / "study", jobs=1)
    assert isinstance(table, pd.DataFrame)
    assert sorted(table["panel.tilt"]) == [40, 50]


def test_a_slide_is_run_and_has_maps(tmp_path):
    terrain, release = tmp_path / "hill.asc", write_polygons(tmp_path / "release.geojson")
    write_raster(terrain, replace(plane(), crs="EPSG:31287"))
    results = snowshed.slide(
        str(terrain), str(release), str(tmp_path / "out"), thickness=0.5, max_time=0.2,
        pictures=False,
    )  # fmt: skip
    assert results.summary.released_kg > 0
    assert results.maps.peak_thickness.max() > 0
    with pytest.raises(InputError, match="stack"):
        _ = results.stack


def test_a_panel_is_predicted():
    answer = snowshed.predict(height=2, length=4, tilt=60, events=3)
    assert answer.array("height").shape == (1, 3)


def test_a_clearance_is_computed(tmp_path):
    days = pd.Series([date(2022, 9, 1) + timedelta(n) for n in range(731)])
    snowfall = 0.15 * (days == date(2023, 1, 9)) + 0.2 * (days == date(2024, 1, 5))
    weather = pd.DataFrame({"date": days, "snowfall_m": snowfall, "temperature_c": -3.0})
    answer = snowshed.clearance(
        weather, str(tmp_path), slope_length=0.5, tilt=60, heights=[0.5],
        ranges=SnowRanges(draws=1), scene={"numerics.dx": 0.05}, jobs=1,
    )  # fmt: skip
    level = answer.at(0.9)
    assert level.low <= level.height <= level.high
    with pytest.raises(InputError, match=r"allowed: 0\.5, 0\.9"):
        answer.at(0.7)


def test_a_scene_is_shown_by_its_differences_from_the_defaults():
    scene = tiny_scene()
    names = {name: getattr(snowshed, name) for name in snowshed.__all__}
    assert eval(repr(scene), names).resolve().json == scene.resolve().json
    page = scene._repr_html_()
    assert page.count("<polygon") == 3  # ground, slab and panel
    assert "panel=Panel(" in page.replace("&#x27;", "'")
    assert "<svg" not in Scene()._repr_html_()
