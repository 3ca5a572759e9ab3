"""Import of results folders into the recorded stacks, and measurements from these stacks."""

import json
from dataclasses import astuple

import pytest
from validation.laboratory import lab_records
from validation.laboratory.case_stack_convergence import CASE
from validation.laboratory.lab_import import imported, settings_of
from validation.laboratory.lab_records import Grid, RecordedRun, recorded_runs
from validation.laboratory.lab_stack import COMPARED, Cost, lab_scene
from validation.laboratory.recorded_measurements import SCHEME, measurements_of, renew

from snowshed import InputError
from snowshed.cli.main import main
from snowshed.snow.accuracy.measurements import MeasuredSolution
from snowshed.snow.accuracy.mechanisms import scheme_of
from snowshed.snow.accuracy.recorded import load_recorded, record

GRID = Grid(2, 0.02, 1, events=2)


@pytest.fixture
def reference(monkeypatch):
    """Replace the grids of the scheme objective by one small grid."""
    settings = {"scheme": "objective", "sleep_speed": 0.02}
    reference = lab_records.Reference(settings, (GRID,))
    monkeypatch.setitem(lab_records.REFERENCES, "objective", reference)
    return lab_records.keys_of(GRID, settings)[0]


def test_a_folder_gives_the_same_entry_as_recording(reference, tmp_path):
    """A run in memory and the stored particles of the run give the same entry."""
    stored = tmp_path / "made.json"
    lab_records.record(stored, "objective")
    (expected,) = lab_records.read_entries(stored)
    scene = tmp_path / "scene.json"
    lab_scene(reference).set("output.film", False).resolve().save(scene)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-q", "-o", str(out)]) == 0
    entry = imported(out, "machine", "2026-11-26")
    assert (entry["machine"], entry["date"]) == ("machine", "2026-11-26")
    for name in ("dimension", "dx", "seed", "events", "scheme", "sleep_speed", "version"):
        assert entry[name] == expected[name]
    for name in COMPARED:  # particles are stored in single precision
        assert entry[name] == pytest.approx(expected[name], abs=2e-5)
    for imported_cost, recorded_cost in zip(entry["costs"], expected["costs"]):
        assert imported_cost[2:] == recorded_cost[2:]
    assert [cost[1] for cost in entry["costs"]] == [0, expected["costs"][-1][1]]
    assert 0 < entry["costs"][0][0] < entry["costs"][1][0]


@pytest.mark.parametrize(
    "change",
    [
        {"panel.friction": 0.6},
        {"numerics.scheme": "thesis"},
        {"seeding.seed": 2},
        {"events.count": 1},
        {"numerics.sleep_speed": 0.0},
        {"numerics.damping_length": 0.02},
    ],
    ids=str,
)
def test_other_scenes_are_refused(reference, change):
    scene = lab_scene(reference)
    assert settings_of(scene.resolve(), "out") == reference
    with pytest.raises(InputError, match="out: the scene is that of no recorded run"):
        settings_of(scene.update(change).resolve(), "out")


def test_an_unfinished_run_is_refused(reference, tmp_path):
    (tmp_path / "run.json").write_text(json.dumps({"status": "running"}))
    with pytest.raises(InputError, match="not finished"):
        imported(tmp_path, "machine", "2026-11-26")


def test_the_package_has_the_measurements_of_the_recorded_runs():
    """The packaged measurements follow from lab_stack.json, except for the last digits of sums."""
    packaged = [
        stored
        for stored in load_recorded()
        if stored.case == CASE.name and scheme_of(stored.settings) == SCHEME
    ]
    computed = measurements_of(SCHEME)
    assert [stored.key for stored in packaged] == [stored.key for stored in computed]
    for stored, expected in zip(packaged, computed):
        for name in ("steps", "particles", "updates", "machine", "version", "date"):
            assert getattr(stored, name) == getattr(expected, name)
        assert stored.wall_s == pytest.approx(expected.wall_s)
        assert len(stored.measured) == len(expected.measured)
        for result, expected_result in zip(stored.measured, expected.measured):
            assert result.quantity == expected_result.quantity
            assert astuple(result)[1:] == pytest.approx(astuple(expected_result)[1:], abs=1e-9)
    problems = {(stored.settings["dimension"], stored.settings["events"]) for stored in packaged}
    assert problems == {(2, 1), (2, 2), (2, 3), (2, 5), (3, 1), (3, 2)}


def test_measurements_follow_from_the_runs():
    """Compute one measurement from the numbers of the file: mean, error of a single run, cost."""
    runs = lab_records.read_entries(lab_records.FILE)
    planar = [r for r in runs if scheme_of(r) == SCHEME and r["dimension"] == 2]
    heights = [r["height"][1] for r in planar if r["dx"] == 0.01]
    finest = [r["height"][1] for r in planar if r["dx"] == 0.0025]
    exact = sum(finest) / len(finest)
    squares = [(height / exact - 1) ** 2 for height in heights]
    costs = [r["costs"] for r in planar if r["dx"] == 0.01]
    (measurement,) = [
        candidate
        for candidate in measurements_of(SCHEME)
        if (candidate.settings["dimension"], candidate.settings["dx"], candidate.settings["events"])
        == (2, 0.01, 2)
    ]
    height = measurement.measured[0]
    assert height.quantity == "height"
    assert height.value == pytest.approx(sum(heights) / len(heights))
    assert height.exact == pytest.approx(exact)
    assert height.error == pytest.approx((sum(squares) / len(squares)) ** 0.5)
    assert measurement.steps == round(sum(cost[1][2] for cost in costs) / len(costs))
    # Each run counts with all updates at the speed of the fastest run, and the share of two events.
    quickest = min(cost[-1][0] / cost[-1][1] for cost in costs)
    times = [cost[-1][1] * quickest * cost[1][0] / cost[-1][0] for cost in costs]
    assert measurement.wall_s == pytest.approx(sum(times) / len(times))
    assert measurement.updates == 0  # counted for all events only
    assert measurement.machine == "AMD EPYC"


def test_a_part_of_a_run_ends_with_its_event():
    run = recorded_runs(2, 0.01, "objective")[0]
    assert len(run.series("length")) == 5
    part = run.until(2)
    assert len(part.series("height")) == len(part.costs) == 2
    assert part.cost.wall_s < run.cost.wall_s
    with pytest.raises(LookupError, match="no event 6"):
        run.until(6)
    with pytest.raises(LookupError, match="cost of this run was not recorded"):
        recorded_runs(2, 0.01, "thesis")[0].cost  # noqa: B018


def test_new_measurements_replace_those_of_the_same_scheme(tmp_path):
    path = tmp_path / "recorded.json"
    unrelated = [
        MeasuredSolution("bar", {"dx": 1.0}, []),
        MeasuredSolution(CASE.name, {"dx": 0.01}, []),
    ]
    record([*unrelated, MeasuredSolution(CASE.name, {"dx": 0.5, "scheme": "objective"}, [])], path)
    new = MeasuredSolution(CASE.name, {"dx": 0.25, "scheme": "objective"}, [])
    renew([new], path)
    assert [measurement.key for measurement in load_recorded(path)] == [
        measurement.key for measurement in (*unrelated, new)
    ]


def test_times_of_several_machines_are_not_mixed(monkeypatch):
    from validation.laboratory import recorded_measurements

    def mixed(dimension, dx, scheme):
        runs = recorded_runs(dimension, dx, scheme)
        first = runs[0]
        another = RecordedRun(first.measures, first.costs, "another", first.version, first.date)
        return [another, *runs[1:]]

    monkeypatch.setattr(recorded_measurements, "recorded_runs", mixed)
    with pytest.raises(InputError, match=r"differ in their machine: AMD EPYC, another"):
        measurements_of(SCHEME)


def test_runs_without_a_time_on_one_thread_give_no_measurement(monkeypatch):
    from validation.laboratory import recorded_measurements

    def timeless(dimension, dx, scheme):
        runs = recorded_runs(dimension, dx, scheme)
        return [
            RecordedRun(
                run.measures,
                [Cost(0.0, *(cost.updates, cost.steps, cost.particles)) for cost in run.costs],
            )
            for run in runs
        ]

    monkeypatch.setattr(recorded_measurements, "recorded_runs", timeless)
    with pytest.raises(InputError, match="time of the runs on one thread was not recorded"):
        measurements_of(SCHEME)
