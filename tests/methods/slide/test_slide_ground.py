"""Ground that adapts to the snow: maps, figures and refusals."""

import json
import math

import numpy as np
import pytest
from helpers.slide_files import box, plane, write_polygons

import snowshed
from snowshed import InputError, _core
from snowshed.io.raster.raster import read_raster, write_ascii_grid
from snowshed.methods.slide.event_notes import event_notes
from snowshed.methods.slide.maps import read_maps
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene import slide_scene

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")
pytestmark = pytest.mark.usefixtures("undrawn")


def braking_scene(folder, **settings):
    """Return the scene of a slab that starts with a speed, on a plane that stops it in a second."""
    write_ascii_grid(folder / "dem.asc", plane())
    values = {"friction": 1.2, "bonds": False, "stop_ratio": 1e-6, "ground_rest_time": 0.0}
    scene = slide_scene(
        folder / "dem.asc",
        write_polygons(folder / "release.geojson", box(10.3, 10.3, 30.3, 30.3), thickness=0.3),
        settings=SlideSettings(**{**values, **settings}),
    )
    return scene.set("terrain.release_speed", 2.0).set("events.max_time", 3.0)


@pytest.fixture(scope="module")
def changed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ground")
    with pytest.warns(snowshed.SnowshedNote, match="The ground gained .* and became ground"):
        return run(braking_scene(folder, ground_gains_stopped=True), folder / "out")


def run(scene, folder):
    snowshed.run(scene, folder, pictures=False)
    return folder


def test_the_maps_show_the_volume_of_the_figures(changed):
    figures = json.loads((changed / "slide.json").read_text())
    rise = read_raster(changed / "ground/sfcChange.asc")
    terrain = read_raster(changed / "ground/demAdapted.asc")
    assert figures["stopped_kg"] > 0.5 * figures["released_kg"]
    volume = rise.heights.sum() * rise.cell**2
    assert volume == pytest.approx(figures["ground_gained_m3"], rel=1e-6)
    assert volume == pytest.approx(figures["stopped_kg"] / 300.0, rel=1e-6)
    np.testing.assert_allclose(terrain.heights, plane().heights + rise.heights, atol=1e-4)
    balance = json.loads((changed / "run.json").read_text())["mass_balance"]
    assert balance["stopped_kg"] == figures["stopped_kg"]
    assert abs(balance["residual_kg"]) < 1e-9 * balance["released_kg"]


def test_snow_that_became_ground_counts_for_the_run_out(changed, tmp_path):
    with_ground = json.loads((changed / "slide.json").read_text())
    unchanged = run(braking_scene(tmp_path), tmp_path / "out")
    without = json.loads((unchanged / "slide.json").read_text())
    assert with_ground["run_out_m"] == pytest.approx(without["run_out_m"], abs=4.0)
    assert with_ground["drop_m"] == pytest.approx(without["drop_m"], abs=4.0)
    assert without["stopped_kg"] == 0.0
    assert not (tmp_path / "out/ground").exists()


def test_the_maps_are_read_by_name(changed, tmp_path):
    maps = read_maps(changed)
    assert maps["ground_change"].attrs["units"] == "m"
    assert float(maps["ground_change"].max()) > 0.1
    assert float((maps["changed_terrain"] - maps["ground_change"]).max()) == pytest.approx(1500.0)
    assert "ground_change" not in read_maps(run(braking_scene(tmp_path), tmp_path / "out"))


def test_a_note_says_how_much_snow_became_ground():
    facts = {"ground_gained_m3": 2.0, "stopped_kg": 600.0}
    (note,) = event_notes(facts)
    assert note == "The ground gained 2.0 m3 by the snow; 600 kg of snow stopped and became ground."


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"ground_min_change": -0.1}, "/numerics/ground_min_change"),
        ({"ground_min_change": math.inf}, "ground_min_change"),
        ({"ground_rest_time": -1.0}, "/numerics/ground_rest_time"),
        ({"ground_gains_detrained": True}, "ground_gains_detrained: forest takes no snow"),
        ({"ground_loses_entrained": True}, "ground_loses_entrained: the slide takes up no snow"),
        (
            {"mode": "compatible", "ground_rest_time": 2.0},
            'ground_rest_time: only in the mode "improved"',
        ),
    ],
)
def test_values_without_sense_are_refused(tmp_path, settings, message):
    with pytest.raises(InputError, match=message):
        resolved = braking_scene(tmp_path, **settings).resolve()
        _core.Simulation(resolved.json, resolved.base_dir)
