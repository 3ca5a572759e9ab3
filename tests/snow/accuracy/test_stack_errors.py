import pandas as pd
import pytest

from snowshed import Scene
from snowshed.scene import example_slide
from snowshed.snow.accuracy.measurements import Measured, MeasuredSolution
from snowshed.snow.accuracy.mechanisms import Mechanisms
from snowshed.snow.accuracy.panel_errors import TABLE, panel_errors
from snowshed.snow.accuracy.recorded import load_recorded
from snowshed.snow.accuracy.recorded_stacks import CASE, PRESET, PRESET_THICKNESS
from snowshed.snow.accuracy.stack_errors import error_sentence, recorded_bias, stack_error


def stack(dx, height, length, **settings):
    """Return recorded runs whose means deviate by these shares from 0.1 m and 0.4 m."""
    measured = [
        Measured("height", 0.1 * (1 + height), 0.1, 0.9),
        Measured("length", 0.4 * (1 + length), 0.4, 0.9),
        Measured("height_spread", 0.04, 0.0, 0.04),
        Measured("length_spread", 0.06, 0.0, 0.06),
    ]
    settings = {"dimension": 2, "events": 5, "dx": dx, "transfer": "flip", **settings}
    settings = {name: value for name, value in settings.items() if value is not None}
    return MeasuredSolution(CASE, settings, measured)


RECORDED = [
    stack(0.01, 7.0, 7.0, basis="cubic"),
    stack(0.02, 0.8, -0.2),
    stack(0.01, 0.3, -0.1),
    stack(0.005, 0.1, 0.05),
    stack(0.01, 0.5, 0.0, events=1),
    stack(0.01, -0.2, 0.2, dimension=3),
    stack(0.01, 9.0, 9.0, transfer="apic"),
    stack(0.01, 3.0, 3.0, flip_ratio=0.95),
    stack(0.01, -0.15, 0.06, transfer=None, scheme="objective"),
    stack(0.005, 0.02, -0.03, transfer=None, scheme="objective"),
]


def scene(**values):
    return Scene.preset("lab-50").with_({"dimension": 2, **values})


@pytest.mark.parametrize(
    "values, height, length",
    [
        ({}, 0.3, -0.1),
        ({"numerics.dx": 0.02}, 0.8, -0.2),
        ({"events.count": 2}, 0.5, 0.0),
        ({"dimension": 3}, -0.2, 0.2),
        ({"slab.thickness": 0.5, "numerics.dx": 0.125}, 0.1, 0.05),  # four cells, as at 0.005 m
        ({"numerics.transfer": "apic"}, 9.0, 9.0),
        ({"numerics.flip_ratio": 0.95}, 3.0, 3.0),
        ({"numerics.scheme": "objective"}, -0.15, 0.06),
        ({"numerics.scheme": "objective", "numerics.dx": 0.005}, 0.02, -0.03),
    ],
)
def test_the_error_comes_from_the_nearest_recorded_runs(values, height, length):
    error = stack_error(scene(**values), RECORDED)
    assert error.bias == {"height": pytest.approx(height), "length": pytest.approx(length)}
    assert error.scatter == {"height": 0.04, "length": 0.06}


def test_the_sentence_names_the_recorded_scene_and_the_sign_of_the_error():
    text = stack_error(scene(**{"slab.thickness": 0.015}), RECORDED).sentence
    assert text.startswith(
        "error of the stack in recorded runs (lab-50 in 2D, event 5, scheme thesis, 2 cells"
    )
    assert "this scene has 1.5" in text
    assert (
        "height 30 % too large, length 10 % too small, relative to the finest recorded grid" in text
    )
    assert text.endswith("single runs scatter by 4 % and 6 %")


def test_scenes_without_recorded_runs_have_no_error_estimate(tmp_path):
    assert stack_error(example_slide(tmp_path), RECORDED) is None
    assert stack_error(scene(), []) is None


@pytest.mark.parametrize(
    "values, label",
    [
        ({"transfer": "affine_flip"}, "scheme thesis with affine flip"),
        ({"flip_ratio": 0.9}, "scheme thesis with flip ratio 0.9"),
        ({"contact": "touch"}, "scheme thesis with touch"),
        ({"fields": "events", "transfer": "apic"}, "scheme thesis with apic, events"),
        ({"scheme": "objective", "damping_length": 0.02}, "scheme objective with damping length"),
    ],
)
def test_the_sentence_names_mechanisms_without_recorded_runs(values, label):
    resolved = scene(**{f"numerics.{name}": value for name, value in values.items()}).resolve()
    assert stack_error(resolved, RECORDED) is None
    sentence = error_sentence(resolved)
    assert sentence.startswith(f"error of the stack: no runs are recorded for {label}")
    assert sentence.endswith("; --check measures it")
    mechanisms = Mechanisms.of_scene(resolved.data)
    assert recorded_bias(2, 5, mechanisms).startswith(f"no runs are recorded for {label}")


def test_the_sentence_names_the_scheme_and_its_lengths():
    objective = {"numerics.scheme": "objective"}
    text = stack_error(scene(**objective), RECORDED).sentence
    assert "event 5, scheme objective, 2 cells in the slab): height 15 % too small" in text
    calibration = Mechanisms("objective").calibration_note
    assert text.endswith(f"single runs scatter by 4 % and 6 %; {calibration}")
    assert "calibrated snow" not in stack_error(scene(), RECORDED).sentence
    thick = stack_error(scene(**objective, **{"slab.thickness": 0.04}), RECORDED).sentence
    assert thick.endswith("are 50 % of the recorded slab's thickness, 25 % of this one's")


def test_the_recorded_bias_covers_all_resolved_grids():
    packaged = [m for m in load_recorded() if m.case == CASE]
    assert packaged
    end = " cells in the slab, relative to the finest recorded grid of this scheme"
    thesis = recorded_bias(2, 5)
    assert thesis.startswith("stacks of lab-50 in 2D, event 5, scheme thesis were ")
    assert f"% too high with 2 to 4{end}; all recorded panels (" in thesis
    objective = recorded_bias(2, 5, Mechanisms("objective"))
    assert objective.startswith("stacks of lab-50 in 2D, event 5, scheme objective were ")
    assert f"with 2 to 4{end}" in objective
    assert objective.endswith("; " + Mechanisms("objective").calibration_note)
    assert "event 2, scheme objective" in recorded_bias(3, 5, Mechanisms("objective"))


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_sentence_has_the_errors_of_all_recorded_panels(dimension):
    values = {"dimension": dimension, "numerics.scheme": "objective", "events.count": 2}
    error = stack_error(scene(**values))
    low, high = error.panels.spans["height"]
    assert low < error.bias["height"] < high and low < -0.15 and high > 0.25
    sentence = error_sentence(scene(**values).resolve())
    assert f"height from {-100 * low:.0f} % too small to {100 * high:.0f} % too large" in sentence


@pytest.mark.parametrize("cells, slide_offs", [(2.0, 1), (2.0, 3), (4.0, 2)])
def test_stacks_of_fewer_slide_offs_and_coarser_grids_do_not_count(cells, slide_offs):
    table = pd.read_csv(TABLE)
    table = table[(table.cells >= cells) & (table.slide_offs >= slide_offs)]
    lengths = table[table.scheme == "objective"].length_error
    errors = panel_errors(Mechanisms("objective"), cells, slide_offs)
    assert errors.spans["length"] == (lengths.min(), lengths.max())
    assert errors.slide_offs == slide_offs and errors.cells[0] >= cells


def test_the_most_slide_offs_and_the_finest_grid_count_for_more_of_either():
    errors = panel_errors(Mechanisms("objective"), 100.0, 30)
    assert errors == panel_errors(Mechanisms("objective"), 4.0, 5)


def test_planar_errors_leave_out_stacks_in_3d():
    everything = panel_errors(Mechanisms("thesis"), 2.0, 2)
    planar = panel_errors(Mechanisms("thesis"), 2.0, 2, planar=True)
    assert everything.panels == "1 panel in 2D and 1 panel in 3D"
    assert planar.panels == "1 panel in 2D"


def test_the_recorded_slab_is_as_thick_as_that_of_the_preset():
    assert Scene.preset(PRESET).slab.thickness == PRESET_THICKNESS
