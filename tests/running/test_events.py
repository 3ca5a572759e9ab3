import json
import signal

import pandas as pd
import pytest
from helpers.interrupted_runs import compare_tables, interrupt_at

from snowshed import InputError, Interrupted, ResultNote, SimulationError, _core, run_events
from snowshed.cli.output.results import energy_residual
from snowshed.results.folder import read_events
from snowshed.running import sequence, stack_run


def test_the_results_folder_is_complete(finished):
    names = {path.name for path in finished.iterdir()}
    assert names == {
        "scene.json", "events.csv", "outline.csv", "energy.csv", "run.json", "checkpoint.bin",
        "film.bin", "solids.vtp", "energy_history.csv", "energy.png",
        "particles", "particles.pvd", "stack.png", "growth.png",
    }  # fmt: skip
    assert {path.name for path in (finished / "particles").iterdir()} == {
        "event_001.vtp",
        "event_002.vtp",
    }


def test_mass_is_conserved(finished):
    table = read_events(finished)
    slab = 210 * 0.245 * 0.02
    assert list(table.event) == [1, 2]
    assert list(table.mass_kg + table.on_panel_kg) == pytest.approx([slab, 2 * slab], rel=1e-6)


def test_measures_are_consistent(finished):
    table = read_events(finished)
    assert (table.tail_m - table.head_m).to_numpy() == pytest.approx(table.length_m.to_numpy())
    assert (table.density_kg_m3 * table.volume_m3).to_numpy() == pytest.approx(
        table.mass_kg.to_numpy()
    )
    assert (table.body_height_m <= table.height_m + 1e-9).all()
    assert (table.steps > 0).all() and (table.sim_time_s > 0).all()
    assert set(table.ended) <= {"rest", "time_limit"}
    outline = pd.read_csv(finished / "outline.csv")
    tops = outline.groupby("event").z.max().to_numpy()
    assert tops == pytest.approx(table.height_m.to_numpy())


def test_the_residual_of_the_energy_balance_is_recorded_and_warned_of(
    finished, tiny, tmp_path, monkeypatch
):
    last = json.loads((finished / "run.json").read_text())["finished_events"][-1]
    energy = pd.read_csv(finished / "energy.csv").iloc[-1].drop("event")
    largest = energy.drop("residual_j").abs().max()
    assert last["energy_residual"] == pytest.approx(abs(energy["residual_j"]) / largest)
    assert last["energy_residual"] == energy_residual(finished) < 0.01
    monkeypatch.setattr(stack_run, "MAX_RESIDUAL", 0.0)
    with pytest.warns(ResultNote, match=r"event 1: the energy balance has a residual of"):
        run_events(tiny.set("output.energy", True), tmp_path / "out", pictures=False)
    notes = json.loads((tmp_path / "out" / "run.json").read_text())["notes"]
    assert any(note.startswith("event 1: the energy balance") for note in notes)


def test_run_json_records_the_run(finished):
    facts = json.loads((finished / "run.json").read_text())
    table = read_events(finished)
    assert facts["status"] == "finished"
    assert facts["version"] == _core.version
    assert facts["steps"] == table.steps.sum()
    assert facts["scalar"] == "float"
    assert facts["wall_s"] >= table.wall_s.sum() * 0.99
    assert facts["updates_per_s"] > 0 and facts["peak_memory_mb"] > 10 and facts["threads"] >= 1


def test_energy_is_written_on_request(finished):
    assert list(pd.read_csv(finished / "energy.csv").event) == [1, 2]


def test_a_run_is_repeated_from_its_stored_scene(finished, tmp_path):
    from snowshed import ResolvedScene

    run_events(ResolvedScene.load(finished / "scene.json"), tmp_path / "again", pictures=False)
    compare_tables(finished, tmp_path / "again")


@pytest.mark.parametrize(("event", "moment"), [(1, 0.1), (2, 0.0), (2, 0.2)])
def test_interrupted_and_resumed_equals_uninterrupted(
    finished, tmp_path, tiny, monkeypatch, event, moment
):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    tiny.set("output.energy", True)
    with pytest.raises(Interrupted, match="--resume"):
        run_events(tiny, tmp_path, progress=interrupt_at(event, moment), pictures=False)
    facts = json.loads((tmp_path / "run.json").read_text())
    assert facts["status"] == "interrupted"
    assert facts["events"] == event - 1
    assert (tmp_path / "checkpoint.bin").exists()
    run_events(tiny, tmp_path, resume=True, pictures=False)
    compare_tables(finished, tmp_path)


def test_the_signal_handler_is_restored(tmp_path, tiny):
    before = signal.getsignal(signal.SIGINT)
    run_events(tiny.set("events.count", 1), tmp_path, pictures=False)
    assert signal.getsignal(signal.SIGINT) is before


def test_intermediate_checkpoints_change_nothing(finished, tmp_path, tiny, monkeypatch):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    saved = set()

    def read_checkpoint(progress):
        if (tmp_path / "checkpoint.bin").exists():
            saved.add((tmp_path / "checkpoint.bin").read_bytes())

    tiny.update({"output": {"energy": True, "checkpoint_interval": 1e-6}})
    run_events(tiny, tmp_path, progress=read_checkpoint, pictures=False)
    assert len(saved) > 3
    compare_tables(finished, tmp_path)


def test_a_killed_run_resumes_from_its_last_checkpoint(finished, tmp_path, tiny):
    """Rows that are newer than the checkpoint are written again."""
    tiny.set("output.energy", True)
    checkpoints = []

    def halt(progress):
        if progress.event == 2 and not checkpoints:
            checkpoints.append((tmp_path / "checkpoint.bin").read_bytes())

    run_events(tiny, tmp_path, progress=halt, pictures=False)
    (tmp_path / "checkpoint.bin").write_bytes(checkpoints[0])
    table = run_events(tiny, tmp_path, resume=True, pictures=False)
    assert list(table.event) == [1, 2]
    compare_tables(finished, tmp_path)


def test_resume_without_a_checkpoint_starts_over(finished, tmp_path, tiny):
    tiny.set("output.energy", True).resolve().save(tmp_path / "scene.json")
    run_events(tiny, tmp_path, resume=True, pictures=False)
    compare_tables(finished, tmp_path)


def test_resuming_a_finished_run_changes_nothing(finished, tiny):
    before = (finished / "events.csv").read_bytes()
    run_events(tiny.set("output.energy", True), finished, resume=True, pictures=False)
    assert (finished / "events.csv").read_bytes() == before


def test_a_truncated_checkpoint_is_refused(tmp_path, tiny):
    run_events(tiny.set("events.count", 1), tmp_path, pictures=False)
    checkpoint = tmp_path / "checkpoint.bin"
    checkpoint.write_bytes(checkpoint.read_bytes()[:-100])
    with pytest.raises(InputError, match="checkpoint"):
        run_events(tiny, tmp_path, resume=True, pictures=False)


def fail_at(event, error):
    """Return a progress reporter that raises an error once snow slides in an event."""

    def report(progress):
        if progress.event == event and progress.time > 0:
            raise error

    return report


@pytest.mark.parametrize("kind", [SimulationError, InputError])
def test_a_failed_run_leaves_a_checkpoint(finished, tmp_path, tiny, monkeypatch, kind):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    tiny.set("output.energy", True)
    with pytest.raises(kind, match="particle 7"):
        run_events(tiny, tmp_path, progress=fail_at(2, kind("at particle 7")), pictures=False)
    facts = json.loads((tmp_path / "run.json").read_text())
    assert (facts["status"], facts["events"]) == ("failed", 1)
    assert "particle 7" in facts["error"]
    assert list(read_events(tmp_path).event) == [1]
    assert _core.Simulation.load(str(tmp_path / "checkpoint.bin")).time_s > 0
    assert list(run_events(tiny, tmp_path, resume=True, pictures=False).event) == [1, 2]


def test_errors_outside_the_simulation_are_not_recorded_as_failures(tmp_path, tiny):
    with pytest.raises(MemoryError):
        run_events(tiny, tmp_path, progress=fail_at(2, MemoryError()), pictures=False)
    assert json.loads((tmp_path / "run.json").read_text())["status"] == "running"


def test_failed_seeding_leaves_no_folder(tmp_path, tiny):
    tiny.update({"bodies": [{"shape": {"type": "sphere", "radius": 1e-4, "center": [0, 1]}}]})
    with pytest.raises(InputError, match="/bodies/0"):
        run_events(tiny, tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_snapshots_are_written_on_request(tmp_path, tiny):
    tiny.update({"events.count": 1, "output.snapshot_interval": 0.1})
    run_events(tiny, tmp_path, pictures=False)
    assert len(list((tmp_path / "snapshots").glob("*.vtp"))) > 1


def test_progress_rises_from_zero_to_one(tmp_path, tiny):
    reports = []
    run_events(tiny, tmp_path, progress=reports.append, pictures=False)
    assert [p.event for p in reports] == sorted(p.event for p in reports)
    assert reports[0].fraction == 0 and reports[-1].fraction == 1
    assert all(0 <= p.fraction <= 1 for p in reports)
