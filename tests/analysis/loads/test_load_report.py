"""The page of loads: its numbers are those of the tables, and designs are compared."""

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.pages import Page

from snowshed import InputError, Results, run_events
from snowshed.analysis.loads import RuleInputs, structure_loads, write_loads
from snowshed.analysis.loads.slope import SnowSlope
from snowshed.scene import Obstacle, Shape, gable_roof, panel_table


def scene_with_post(**values):
    """A slab that slides off against a post."""
    scene = tiny_scene(**{"output.forces": True, "events.count": 1, **values})
    post = Shape.box((0.3, 0.1), (0.06, 0.2))
    return scene.append("obstacles", Obstacle(name="post", shape=post, condition="separate"))


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("loads") / "run"
    run_events(scene_with_post(), folder, pictures=False)
    return folder


def test_page_and_table_have_the_loads_of_the_run(loaded, tmp_path):
    page = Page(write_loads([Results(loaded)], tmp_path, RuleInputs(snow_load=3.0)).read_text())
    table = pd.read_csv(tmp_path / "largest_loads.csv").set_index("obstacle")
    loads = Results(loaded).loads.set_index("obstacle")
    assert table.peak_10ms_n["post"] == pytest.approx(loads.peak_10ms_n["post"], rel=1e-5)
    text = " ".join(page.text)
    assert f"post with {table.peak_10ms_n['post'] / 1000:.3g} kN/m for 10 ms" in text
    assert "Loads depend on the grid" in text and "not available" in text
    assert "ASCE 7-22, 7.9" in text and "needs `snow_depth=`" in text
    assert "equation 11" in text and "nan" not in text
    assert sum(source.startswith("data:image/png") for source in page.sources) == 2


def test_several_designs_stand_beside_each_other(loaded, tmp_path):
    other = tmp_path / "other"
    run_events(scene_with_post(**{"panel.friction": 0.1}), other, pictures=False)
    write_loads([Results(loaded), Results(other)], tmp_path / "page")
    table = pd.read_csv(tmp_path / "page/largest_loads.csv")
    assert len(set(table.design)) == 2 and table.design[0] != "lab"
    assert "All designs" in (tmp_path / "page/loads.html").read_text()


def test_a_run_without_forces_is_refused(tmp_path):
    run_events(tiny_scene(**{"events.count": 1}), tmp_path / "run", pictures=False)
    with pytest.raises(InputError, match=r"loads\.csv: missing; a run with output\.forces"):
        write_loads([Results(tmp_path / "run")], tmp_path)


def test_largest_loads_are_over_all_events():
    rows = [
        {"event": event, "obstacle": "wall", "at_rest": 1, "rest_fx_n": fx, "rest_fy_n": 0.0,
         "rest_fz_n": -4.0, "rest_pressure_pa": fx, "peak_pressure_pa": 7.0,
         "peak_1ms_n": 9.0, "peak_10ms_n": 8.0 - event, "peak_100ms_n": 5.0,
         "peak_10ms_time_s": event, **{f"peak_10ms_f{axis}_n": 0.0 for axis in "xyz"}}
        for event, fx in ((1, 1.0), (2, 3.0))
    ]  # fmt: skip
    (row,) = structure_loads(pd.DataFrame(rows)).to_dict("records")
    assert (row["rest_n"], row["rest_event"]) == (5.0, 2)
    assert (row["peak_10ms_n"], row["peak_10ms_event"], row["peak_10ms_time_s"]) == (7.0, 1, 1.0)


def test_modules_of_a_table_are_one_slope_and_a_gable_has_two():
    table = panel_table(2, 0.1, module_length=1, height=0.8, tilt=40, snow=0.25, dx=0.05)
    gable = gable_roof(eaves=2.5, length=3, tilt=40, snow=0.25, dx=0.05)
    assert SnowSlope.of(table.resolve()).length == pytest.approx(2.1, rel=0.02)
    roof = SnowSlope.of(gable.resolve())
    weight = 210 * 9.81 * 0.25 / np.cos(np.radians(40))
    assert (roof.length, roof.load) == (3.0, pytest.approx(weight, rel=0.02))


def test_snow_of_the_rules_is_compared_with_the_simulated_snow(loaded, tmp_path):
    page = Page(write_loads([Results(loaded)], tmp_path, RuleInputs(snow_load=3.0)).read_text())
    assert "this is other snow" in " ".join(page.text)


def test_momentum_of_the_run_is_explained(loaded):
    forces = Results(loaded).forces
    impulse = (forces.force * forces.duration).sum("time").sel(obstacle="unbalanced")
    on_ground = (forces.force * forces.duration).sum("time").sel(obstacle="ground")
    assert np.linalg.norm(impulse) < 1e-2 * np.linalg.norm(on_ground)
