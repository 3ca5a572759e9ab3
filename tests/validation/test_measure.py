import json
import os
import signal
import subprocess
import sys
import time
import types
from dataclasses import replace
from pathlib import Path

import pytest
from helpers.paths import ROOT
from made_up import MEGABYTES, made_up_case
from validation.framework import cases as listing
from validation.framework import measure
from validation.framework.folder import ValidationFolder
from validation.framework.measure import Estimate, measure_cases, tasks_of
from validation.framework.measurement_file import MeasurementFile

from snowshed._core import InputError
from snowshed.snow.accuracy.measurements import (
    Measured,
    MeasuredSolution,
    setting_names,
    to_table,
)

FAILURES = {
    "raises": "ValueError: no such snow (made_up.py:",
    "crashes": "its process was killed by signal 9",
    "returns nothing": "TypeError: measure returned NoneType, not Outcome",
    "measures something else": "measure returned 'length', which the case does not list",
}


@pytest.fixture
def file(tmp_path):
    return MeasurementFile(tmp_path / "measurements.jsonl")


def test_every_entry_of_every_matrix_is_measured_once(file):
    measurements = measure_cases([made_up_case()], file)
    assert [measurement.settings for measurement in measurements] == made_up_case().matrix(False)
    first = measurements[0]
    assert first.measured[0] == Measured("height", pytest.approx(2.352), 2.0, pytest.approx(0.176))
    assert first.wall_s == pytest.approx(0.1)
    assert (first.updates, first.steps, first.particles) == (1000, 10, 100)
    assert first.version and first.machine and first.date and not first.failure
    assert file.read() == measurements
    assert len(tasks_of([made_up_case(entries=[{"dx": 1}, {"dx": 1}])], full=False)) == 1
    assert len(tasks_of([made_up_case()], full=True)) == 6


def test_a_failed_measurement_is_recorded_with_the_reason(file):
    entries = [{"mode": mode} for mode in (*FAILURES, "works")]
    *failed, works = measure_cases([made_up_case(entries=entries)], file)
    for measurement, reason in zip(failed, FAILURES.values()):
        assert measurement.failure.startswith(reason)
        assert [result.quantity for result in measurement.measured] == ["height", "drift"]
    assert not works.failure
    table = to_table([*failed, works])
    assert table["error"].isna().tolist() == [True] * 8 + [False] * 2


def test_peak_memory_is_of_a_single_measurement(file):
    entries = [{"mode": "needs memory"}, {"mode": "works"}]
    large, small = measure_cases([made_up_case(entries=entries)], file)
    assert large.peak_memory_mb > MEGABYTES > small.peak_memory_mb > 0


def test_processes_start_quickly(file):
    started = time.perf_counter()
    measurements = measure_cases(
        [made_up_case(entries=[{"dx": 1.0 / i} for i in range(1, 41)])], file
    )
    elapsed = time.perf_counter() - started
    assert elapsed < 10.0  # starting Python for each would take a minute on a busy machine
    assert sum(measurement.elapsed_s for measurement in measurements) < elapsed


def test_only_the_case_that_cannot_be_imported_fails(file, monkeypatch):
    def measure(settings):
        raise AssertionError

    nowhere = types.ModuleType("nowhere")
    nowhere.measure, measure.__module__, measure.__qualname__ = measure, "nowhere", "measure"
    monkeypatch.setitem(sys.modules, "nowhere", nowhere)
    lost = replace(made_up_case(entries=[{"dx": 0.1}]), name="lost", measure=measure)
    failed, successful = measure_cases([lost, made_up_case(entries=[{"dx": 0.1}])], file)
    assert failed.failure.startswith("ModuleNotFoundError: No module named 'nowhere'")
    assert not successful.failure


def test_measurements_do_not_share_imports(file):
    entries = [{"mode": "imports", "seed": seed} for seed in (1, 2)]
    measurements = measure_cases([made_up_case(entries=entries)], file)
    assert [measurement.measured[0].value for measurement in measurements] == [0.0, 0.0]


def test_measurements_are_not_repeated_unless_they_failed(file, monkeypatch):
    entries = [{"mode": "raises"}, {"dx": 0.1}]
    measure_cases([made_up_case(entries=entries)], file)
    reports = []
    entries.append({"dx": 0.2})
    measure_cases([made_up_case(entries=entries)], file, progress=reports.append)
    assert [p.doing for p in reports] == ["made_up: raises", "made_up: dx 0.2"]  # failures again
    assert [(p.done, p.count) for p in reports] == [(1, 3), (2, 3)]
    assert len(file.read()) == 4
    monkeypatch.setattr(measure._core, "version", "another")
    measure_cases([made_up_case(entries=entries[1:])], file, progress=reports.append)
    assert len(reports) == 4


def test_a_truncated_line_is_ignored(file):
    (measurement,) = measure_cases([made_up_case(entries=[{"dx": 0.1}])], file)
    with file.path.open("a") as stream:
        stream.write('{"case": "made_up", "sett')
    assert file.read() == [measurement]
    file.append(measurement)
    assert file.read() == [measurement, measurement]


def test_an_interrupt_ends_the_measurement_and_keeps_finished_ones(tmp_path):
    code = (
        "from pathlib import Path; from made_up import made_up_case; import signal, sys\n"
        # Where the tests run in the background, interrupts are ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from validation.framework.measurement_file import MeasurementFile\n"
        "from validation.framework.measure import measure_cases\n"
        "entries = [{'dx': 0.1}, {'mode': 'takes long'}]\n"
        "measure_cases([made_up_case(entries=entries)], MeasurementFile(Path(sys.argv[1])),"
        " progress=lambda p: print(p.done, flush=True))"
    )
    path = tmp_path / "m.jsonl"
    suite_run = subprocess.Popen(
        [sys.executable, "-c", code, path],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), str(ROOT)])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert [suite_run.stdout.readline() for _ in range(2)] == ["0\n", "1\n"]
    time.sleep(0.3)
    started = time.perf_counter()
    suite_run.send_signal(signal.SIGINT)
    _, errors = suite_run.communicate(timeout=120)
    assert errors.rstrip().endswith("KeyboardInterrupt")
    assert time.perf_counter() - started < 10.0  # the measurement would have taken 60 s
    assert len(MeasurementFile(path).read()) == 1


def test_the_estimate_follows_known_durations_and_the_present_pace(monkeypatch):
    clock = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    tasks = tasks_of([made_up_case(entries=[{"dx": 1}, {"dx": 2}, {"dx": 3}])], full=False)
    durations = {tasks[0].key: 1.0, tasks[1].key: 3.0}  # the third: 2 s, their mean
    estimate = Estimate(tasks, durations)
    assert estimate.after(0) == (0.0, 6.0)
    clock[0] += 2.0  # twice as slow as in the earlier runs
    assert estimate.after(1) == (pytest.approx(1 / 6), pytest.approx(10.0))
    assert Estimate(tasks, {}).after(0) == (0.0, None)
    assert Estimate(tasks, {}).after(3)[0] == 1.0


def test_the_table_has_a_row_for_each_quantity_and_a_column_for_each_setting():
    table = to_table(
        [
            MeasuredSolution(
                "one", {"dx": 0.1, "basis": "cubic"}, [Measured("a", 1.0, 2.0, 0.5)] * 2
            ),
            MeasuredSolution(
                "other", {"seed": 3}, [Measured("b", 1.0, 2.0, 0.5)], wall_s=2, updates=8
            ),
        ]
    )
    assert len(table) == 3
    assert setting_names(table) == ["dx", "basis", "seed"]
    assert table["basis"].tolist() == ["cubic", "cubic", None]
    assert table["updates_per_s"].tolist()[2] == 4.0
    with pytest.raises(ValueError, match="may not be called steps"):
        to_table([MeasuredSolution("one", {"steps": 3}, [])])


def test_a_folder_is_either_created_or_resumed(tmp_path):
    with pytest.raises(InputError, match="nothing to resume"):
        ValidationFolder.reopen(tmp_path)
    ValidationFolder.create(tmp_path)
    with pytest.raises(InputError, match="not empty"):
        ValidationFolder.create(tmp_path)
    assert ValidationFolder.reopen(tmp_path).measurements.read() == []


def test_cases_are_found_by_module_and_by_name(monkeypatch):
    first, second = made_up_case(), made_up_case(remarks="")
    object.__setattr__(second, "name", "other")
    cases_by_module = {"first": [first], "second": [second]}
    modules = {name: f"validation.{name}.case" for name in cases_by_module}
    monkeypatch.setattr(listing, "case_modules", lambda: modules)
    monkeypatch.setattr(listing, "cases_of", lambda module: cases_by_module[module.split(".")[1]])
    assert listing.load_cases() == [first, second]
    assert listing.load_cases(["second"]) == [second]
    assert listing.load_cases(["other"]) == [second]
    with pytest.raises(InputError, match="--case third: no such case; there are first, made_up"):
        listing.load_cases(["third"])


def test_measurements_are_read_back_from_json():
    measurement = MeasuredSolution(
        "a", {"dx": 0.1}, [Measured("b", float("inf"), 1.0, float("nan"))]
    )
    text = json.dumps(measurement.to_json(), allow_nan=False)
    read = MeasuredSolution.from_json(json.loads(text), "m.jsonl")
    assert read.to_json() == measurement.to_json()
