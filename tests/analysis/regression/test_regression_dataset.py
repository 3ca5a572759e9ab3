"""The rows and the model that come with snowshed."""

import json
from collections import Counter

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError, Scene, run_events
from snowshed.analysis.regression import OutsideDataError, load_model, predict
from snowshed.analysis.regression.dataset import geometry_rows, geometry_table, model_file
from snowshed.analysis.regression.geometry import SCHEMES, geometry_study

PANEL = ["panel.height", "panel.length", "panel.tilt"]
#: Treatment between events, and scheme, of each table.
TABLES = [("carry", "thesis"), ("carry", "objective"), ("reseed", "thesis")]


def panel_scenes(**settings):
    """Return the scenes of the study, by height, length and tilt of the panel."""
    scenes = [json.loads(run.scene) for run in geometry_study(**settings).runs()]
    names = ("height", "length", "tilt")
    return {tuple(scene["panel"][name] for name in names): scene for scene in scenes}


@pytest.mark.parametrize(("between", "scheme"), TABLES)
def test_the_rows_are_those_of_the_study(between, scheme):
    panels = set(panel_scenes(between=between, scheme=scheme))
    rows = geometry_rows(between, scheme=scheme)
    assert len(rows) == 610 and len(panels) == 122
    assert {tuple(row) for row in rows.inputs[:, 1:]} == panels
    assert set(rows.inputs[:, 0]) == {1, 2, 3, 4, 5}


def test_short_panels_have_more_seeds():
    panels = [json.loads(run.scene)["panel"] for run in geometry_study(seeds=16).runs()]
    counts = Counter((panel["length"], panel["height"], panel["tilt"]) for panel in panels)
    assert len(counts) == 122
    for (length, _, _), count in counts.items():
        assert count == (16 if length <= 1 else 6 if length <= 2 else 3 if length <= 4 else 1)


@pytest.mark.parametrize(("scheme", "low", "high"), [("thesis", 1.1, 1.5), ("objective", 1.3, 1.8)])
def test_the_rows_of_a_model_have_both_trimming_rules(scheme, low, high):
    """Trimming at equal pace, as in the thesis, gives longer stacks of the same snow."""
    rules = ("outermost_first", "equal_pace")
    first, second = (geometry_rows(measure=name, scheme=scheme) for name in rules)
    assert geometry_rows(scheme=scheme).settings["trimming"] == "outermost_first"
    longer = second.targets["length"] / first.targets["length"]
    assert low < np.median(longer) < high and np.quantile(longer, 0.05) > 0.95


@pytest.mark.parametrize("scheme", SCHEMES)
def test_all_stacks_of_a_model_came_to_rest(scheme):
    assert set(pd.read_csv(geometry_table(scheme=scheme))["ended"]) == {"rest"}


@pytest.mark.parametrize(("between", "scheme"), TABLES)
def test_snow_is_conserved_between_stack_and_panel(between, scheme):
    table = pd.read_csv(geometry_table(between, scheme))
    slab = 210 * 0.05 * table["panel.length"]
    mass = table["mass_kg"] + table["on_panel_kg"]
    np.testing.assert_allclose(mass, slab * table["event"], rtol=1e-3)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_row_is_reproduced_by_its_scene(tmp_path, scheme):
    """The first event below a panel whose stacks hardly scatter is computed again.

    Other vector instructions round differently, which changes the stack as another seed does.
    """
    panel = (2.0, 2.0, 70.0)
    table = pd.read_csv(geometry_table(scheme=scheme))
    row = table[(table[PANEL] == list(panel)).all(axis=1) & (table["event"] == 1)].iloc[0]
    scene = Scene.from_data(panel_scenes(dx=row["dx"], scheme=scheme)[panel])
    scene.update({"events.count": 1, "seeding.seed": int(row["seed"])})
    event = run_events(scene, tmp_path / "out").iloc[0]
    assert event["height_m"] == pytest.approx(row["height_m"], rel=0.05)
    assert event["length_m"] == pytest.approx(row["length_m"], rel=0.05)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_model_was_fitted_to_its_rows(scheme):
    rows, model = geometry_rows(scheme=scheme), load_model(model_file(scheme))
    np.testing.assert_array_equal(model.inputs, rows.inputs)
    assert model.targets == ["ratio", "height", "length"] and model.kinds[0] == "rbf"
    assert geometry_table(scheme=scheme).stem in model.title
    for name, values in rows.targets.items():
        assert model.members[name, "rbf"].mean == pytest.approx(values.mean(), rel=1e-12)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_predictions_without_a_model_file_are_near_the_rows(scheme):
    rows = geometry_rows(scheme=scheme)
    for height, length, tilt in ((2.0, 4.0, 60.0), (1.5, 8.0, 40.0), (3.0, 2.0, 40.0)):
        table = predict(height=height, length=length, tilt=tilt, events=5, scheme=scheme).table
        is_panel = (rows.inputs[:, 1:] == (height, length, tilt)).all(axis=1)
        for target, values in rows.targets.items():
            predicted = table[table["target"] == target]
            assert (np.abs(predicted["value"] - values[is_panel]) < 2 * predicted["spread"]).all()


def test_the_model_refuses_panels_outside_its_data():
    with pytest.raises(OutsideDataError, match="panel length 12 m is outside the data"):
        predict(height=2, length=12, tilt=40, events=5)
    with pytest.raises(InputError, match="between: 'x' is unknown; allowed: carry, reseed"):
        geometry_table("x")


def test_rows_and_models_that_do_not_exist_are_refused():
    with pytest.raises(InputError, match="scheme: 'x' is unknown; allowed: thesis, objective"):
        predict(height=2, length=4, tilt=60, events=1, scheme="x")
    with pytest.raises(InputError, match="rows of reseed were computed with the scheme thesis"):
        geometry_rows("reseed", scheme="objective")
    with pytest.raises(InputError, match="scheme: has no effect with a given model"):
        predict(height=2, length=4, tilt=60, events=1, model=model_file(), scheme="thesis")
