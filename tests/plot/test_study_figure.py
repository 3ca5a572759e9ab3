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


def test_only_the_last_event_of_successful_runs_is_drawn():
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


def test_numbers_are_in_units_of_the_axis_and_words_are_categories():
    values = {
        "snow.youngs_modulus": [1e5, 1e6, 1e5],
        "panel.condition": ["slip", "separate", "slip"],
    }
    figure = study_figure(runs(**values, height_m=[1.0, 2.0, 3.0]), [*values], "t")
    modulus, condition = figure.axes
    assert modulus.get_xlabel() == "E, MPa"
    assert modulus.collections[0].get_offsets()[:, 0].tolist() == [0.1, 1.0, 0.1]
    assert [label.get_text() for label in condition.get_xticklabels()] == ["slip", "separate"]
    assert modulus.lines[0].get_ydata().tolist() == [2.0, 2.0]  # medians


@pytest.mark.parametrize("table", [runs(height_m=[]), runs(height_m=[np.nan])])
def test_a_study_without_results_draws_a_note(table):
    figure = study_figure(table, ["panel.tilt"], "t")
    assert [text.get_text() for text in figure.axes[0].texts] == ["nothing to show"]
