import json

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.interrupted_runs import compare_tables, interrupt_at

from snowshed import Body, InputError, Interrupted, Shape, _core, run_events
from snowshed.results.folder import CONVERSION_COLUMNS
from snowshed.running import sequence
from snowshed.running.conversion import conversion_row, outline_difference
from snowshed.snow.stack.measure import StackMeasure


def ridge(shift=0.0, rise=0.0):
    x = np.linspace(0, 1, 31)
    return np.column_stack([x + shift, 0.2 - 0.4 * np.abs(x - 0.5) + rise])


def test_the_difference_of_outlines():
    assert outline_difference(ridge(), ridge()) == 0
    assert outline_difference(ridge(), ridge(rise=-0.03)) == pytest.approx(0.03)
    assert 0 < outline_difference(ridge(), ridge(shift=0.05)) <= 0.4 * 0.05 + 1e-12


def test_outlines_without_overlap_have_no_difference():
    assert np.isnan(outline_difference(ridge(), ridge(shift=2)))
    assert np.isnan(outline_difference(ridge(), np.zeros((0, 2))))


def test_a_row_has_all_columns_and_excludes_snow_on_the_panel():
    def measure(positions, masses, densities, on_panel):
        return StackMeasure(height=float(positions[~on_panel, 2].max()), length=len(masses))

    cloud = {"positions": np.array([[0, 0, 1.0], [0, 0, 5.0]]), "masses": np.array([1.0, 2.0])}
    cloud["densities"] = np.array([200.0, 200.0])
    cloud["on_panel"] = np.array([False, True])
    conversion = {f"{k}_{when}": v for k, v in cloud.items() for when in ("before", "after")}
    row = conversion_row(2, conversion, measure)
    assert set(row) == set(CONVERSION_COLUMNS)
    assert (row["mass_before_kg"], row["particles_after"], row["height_after_m"]) == (3.0, 2, 1.0)


@pytest.fixture(scope="module")
def reseeded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reseeded")
    run_events(tiny_scene(**{"events.between": "reseed"}), folder, pictures=False)
    return folder


def test_reseeding_hardly_moves_the_stack(reseeded):
    rows = pd.read_csv(reseeded / "conversions.csv")
    assert list(rows.columns) == list(CONVERSION_COLUMNS)
    assert list(rows.event) == [2]
    row = rows.iloc[0]
    assert row.mass_after_kg == pytest.approx(row.mass_before_kg, rel=1e-6)
    dx = 0.02
    assert row.height_after_m == pytest.approx(row.height_before_m, abs=dx / 2)
    assert row.length_after_m == pytest.approx(row.length_before_m, abs=dx)
    assert row.outline_rms_m < dx / 2
    assert row.particles_after == pytest.approx(row.particles_before, rel=0.3)


def test_reseeded_snow_lies_at_rest_and_keeps_its_event():
    """Reseeded snow takes the event of the nearest old particle."""
    scene = tiny_scene(**{"events": {"between": "reseed", "count": 3}})
    simulation = _core.Simulation(scene.resolve().json)
    for event in (1, 2, 3):
        old = simulation.positions(), simulation.events()
        conversion = simulation.begin_event()
        assert (conversion is None) == (event == 1)
        if conversion is not None:
            new = conversion["positions_after"]
            distances = np.linalg.norm(new[:, None] - old[0][None], axis=2)
            nearest = old[1][distances.argmin(axis=1)]
            present = simulation.events()
            assert (np.bincount(present)[:event] == np.bincount(nearest)[:event]).all()
            assert set(present) == set(range(1, event + 1))
            reseeded = present < event
            assert (simulation.velocities()[reseeded] == 0).all()
            assert np.allclose(simulation.densities()[reseeded], 210)
        assert simulation.run(lambda info: True) in ("rest", "time_limit")


def test_a_reseeded_run_resumes(reseeded, tmp_path, monkeypatch):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    scene = tiny_scene(**{"events.between": "reseed"})
    with pytest.raises(Interrupted):
        run_events(scene, tmp_path, progress=interrupt_at(2, 0.0), pictures=False)
    run_events(scene, tmp_path, resume=True, pictures=False)
    compare_tables(reseeded, tmp_path)
    first, second = ((folder / "conversions.csv").read_bytes() for folder in (reseeded, tmp_path))
    assert first == second


def test_failed_seeding_leaves_the_checkpoint_of_the_previous_event(tmp_path, tiny):
    body = tmp_path / "body.npy"
    np.save(body, np.hypot(*np.mgrid[-2:3, -2:3]) * 0.05 - 0.08)
    shape = Shape.grid(str(body), origin=(1, 0), spacing=0.05)
    tiny.append("bodies", Body(shape=shape, event=2))

    def spoil(progress):
        if progress.event == 1 and progress.done == 1:
            body.write_text("no array")

    with pytest.raises(InputError, match=r"body\.npy: byte 0: not a .npy file"):
        run_events(tiny, tmp_path / "out", progress=spoil, pictures=False)
    facts = json.loads((tmp_path / "out" / "run.json").read_text())
    assert (facts["status"], facts["events"]) == ("failed", 1)
    np.save(body, np.hypot(*np.mgrid[-2:3, -2:3]) * 0.05 - 0.08)
    assert list(run_events(tiny, tmp_path / "out", resume=True, pictures=False).event) == [1, 2]
