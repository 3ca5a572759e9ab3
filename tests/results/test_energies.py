"""The energy balance over time: rows, picture, and the same rows after resuming."""

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.interrupted_runs import interrupt_at

from snowshed import InputError, Interrupted, Results, run_events
from snowshed.plot.energy_figure import energy_figure
from snowshed.results.energies import draw_energies
from snowshed.running import sequence


def test_rows_span_each_event(finished):
    results = Results(finished)
    table, events = results.energy_history, results.events
    assert table.attrs["units"]["kinetic_j"] == "J" and table.attrs["units"]["time_s"] == "s"
    ends = np.cumsum(events.sim_time_s)
    for event, end in zip((1, 2), ends):
        times = table.time_s[table.event == event]
        assert times.is_monotonic_increasing and len(times) > 10
        assert times.iloc[0] == pytest.approx(end - events.sim_time_s[event - 1], abs=1e-8)
        assert times.iloc[-1] == pytest.approx(end, rel=1e-8)
    last = table.groupby("event").last()
    at_the_end = pd.read_csv(finished / "energy.csv").set_index("event")
    pd.testing.assert_frame_equal(last[at_the_end.columns], at_the_end)
    assert table.kinetic_j.max() > 100 * last.kinetic_j.max()  # the ends miss this peak


def test_every_row_balances(finished):
    table = Results(finished).energy_history
    stored = table[["kinetic_j", "gravitational_j", "elastic_j"]].sum(axis=1)
    spent = [
        "plastic_j",
        "friction_j",
        "sticking_j",
        "impact_j",
        "transfer_j",
        "sleep_j",
        "damping_j",
    ]
    balance = stored + table[spent].sum(axis=1) - table.added_j
    assert balance.to_numpy() == pytest.approx(table.residual_j.to_numpy(), abs=1e-7)


@pytest.mark.parametrize(("event", "moment"), [(1, 0.1), (2, 0.2)])
def test_a_resumed_run_has_the_same_rows(finished, tmp_path, monkeypatch, event, moment):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    scene = tiny_scene(**{"output.energy": True})
    with pytest.raises(Interrupted):
        run_events(scene, tmp_path, progress=interrupt_at(event, moment), pictures=False)
    assert Results(tmp_path).energy_history.event.max() == event  # rows before the interrupt
    run_events(scene, tmp_path, resume=True, pictures=False)
    expected = (finished / "energy_history.csv").read_bytes()
    assert (tmp_path / "energy_history.csv").read_bytes() == expected


def test_the_picture_has_units_and_a_legend(finished):
    results = Results(finished)
    figure = energy_figure(results.energy_history, results.scene.data)
    above, below = figure.axes
    for axes in (above, below):
        assert axes.get_ylabel() in ("energy, J per m of width", "energy, mJ per m of width")
    assert below.get_xlabel() == "time through all events, s"
    named = [text.get_text() for axes in (above, below) for text in axes.get_legend().get_texts()]
    assert named[:2] == ["kinetic", "elastic"] and "plastic" in named and "friction" in named
    drawn = {line.get_label(): line.get_ydata() for line in below.lines}
    scale = 1.0 if "mJ" not in below.get_ylabel() else 1e-3
    released = drawn["released from height and added"][-1] * scale
    last = results.energy_history.iloc[-1]
    assert released == pytest.approx(last.added_j - last.gravitational_j, rel=1e-6)
    figure.draw_without_rendering()
    for axes in (above, below):  # nothing is cut off at the right
        box = axes.get_legend().get_window_extent()
        assert box.x1 <= figure.bbox.x1


def test_the_error_without_energies_names_the_setting(tmp_path):
    run_events(tiny_scene(**{"events.count": 1, "events.max_time": 0.1}), tmp_path, pictures=False)
    with pytest.raises(InputError, match=r"energy_history\.csv: missing; a run with output\.en"):
        draw_energies(tmp_path)
