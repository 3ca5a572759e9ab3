"""The picture of a study."""

import numpy as np
import pandas as pd
import pytest

from snowshed.plot.study_figure import study_figure


def runs(**columns):
    count = len(next(iter(columns.values())))
    return pd.DataFrame(
        {"hash": [f"{k}" for k in range(count)], "event": 1, "error": "", **columns}
    )


def test_each_parameter_has_a_diagram_of_each_measure():
    table = runs(**{"panel.tilt": [40, 50, 60], "height_m": [0.2, 0.3, 0.4], "length_m": [1, 2, 3]})
    figure = study_figure(table.assign(seed=[1, 2, 3]), ["panel.tilt", "seed"], "tilts")
    assert len(figure.axes) == 4
    assert figure.axes[2].get_xlabel() == "panel tilt, °"
    assert figure.axes[0].get_ylabel() == "height of the stack, m"
    assert figure.axes[0].collections[0].get_offsets().tolist() == [[40, 0.2], [50, 0.3], [60, 0.4]]


def test_only_the_last_event_of_runs_that_ended_counts():
    table = pd.DataFrame(
        {
            "hash": ["a", "a", "b", "c"],
            "event": [1, 2, 1, 1],
            "error": ["", "", "", "it failed"],
            "panel.tilt": [40, 40, 50, 60],
            "height_m": [0.1, 0.2, 0.3, np.nan],
        }
    )
    drawn = study_figure(table, ["panel.tilt"], "t").axes[0].collections[0].get_offsets()
    assert sorted(drawn.tolist()) == [[40, 0.2], [50, 0.3]]


def test_values_are_in_the_units_of_their_axis_and_words_beside_each_other():
    values = {
        "snow.youngs_modulus": [1e5, 1e6, 1e5],
        "panel.condition": ["slip", "separate", "slip"],
    }
    figure = study_figure(runs(**values, height_m=[1.0, 2.0, 3.0]), [*values], "t")
    modulus, condition = figure.axes
    assert modulus.get_xlabel() == "E, MPa"
    assert modulus.collections[0].get_offsets()[:, 0].tolist() == [0.1, 1.0, 0.1]
    assert [one.get_text() for one in condition.get_xticklabels()] == ["slip", "separate"]
    assert modulus.lines[0].get_ydata().tolist() == [2.0, 2.0]  # medians


@pytest.mark.parametrize("table", [runs(height_m=[]), runs(height_m=[np.nan])])
def test_a_study_without_results_says_so(table):
    figure = study_figure(table, ["panel.tilt"], "t")
    assert [one.get_text() for one in figure.axes[0].texts] == ["nothing to show"]
