"""Damaged files of a validation folder are named, with the line and the error."""

import json
import resource

import pandas as pd
import pytest
from made_up import made_up_case, program
from validation import stress
from validation.framework import cases as listing
from validation.framework.folder import ValidationFolder

from snowshed import InputError
from snowshed.snow.accuracy.measurements import Measured, MeasuredSolution
from snowshed.snow.accuracy.recorded import load_recorded

COMPLETE = MeasuredSolution("bar", {"dx": 0.1, "apic": True}, [Measured("height", 1.0, 2.0, -0.5)])

# A line of measurements.jsonl, and the message on it.
LINES = {
    "nothing": (b"", "damaged: Expecting value"),
    "random bytes": (bytes(range(128, 250)), "damaged: 'utf-8' codec can't decode byte 0x80"),
    "half": (json.dumps(COMPLETE.to_json()).encode()[:99], "damaged: "),
    "deep": (b"[" * 100_000, "damaged: maximum recursion depth exceeded"),
    "list": (b"[]", "damaged: not a JSON object"),
    "no case": ({"case": None}, "damaged: /case: null is not a text"),
    "endless": ({"wall_s": float("inf")}, "damaged: /wall_s: Infinity is not a finite number"),
    "too large": ({"steps": 10**400}, "damaged: /steps: 1000000"),
    "switch": ({"updates": True}, "damaged: /updates: true is not a finite number"),
    "settings": ({"settings": {"dx": [1]}}, "damaged: /settings/dx: not a setting"),
    "column": ({"settings": {"steps": 1}}, "damaged: /settings/steps: not a setting"),
    "text": ({"measured": "height"}, 'damaged: /measured: "height" is not a list'),
    "part": ({"measured": [3]}, "/measured/0: damaged: not a JSON object"),
    "number": (
        {"measured": [{"quantity": "a", "value": None, "exact": "2", "error": 0}]},
        '/measured/0: damaged: /exact: "2" is not a finite number',
    ),
    "lack": ({"measured": [{"quantity": "a", "value": 1}]}, "damaged: /exact is missing"),
    "unknown": ({"wind": 3}, "damaged: unknown key 'wind'"),
}


@pytest.mark.parametrize("name", LINES)
def test_a_damaged_line_of_measurements_is_refused_with_its_number(name, tmp_path):
    line, message = LINES[name]
    if isinstance(line, dict):
        line = json.dumps({**COMPLETE.to_json(), **line}).encode()
    folder = ValidationFolder.create(tmp_path)
    folder.measurements.append(COMPLETE)
    with folder.measurements.path.open("ab") as file:
        file.write(line + b"\n")
    with pytest.raises(InputError) as caught:
        folder.measurements.read()
    error = str(caught.value)
    assert error.startswith(f"{tmp_path / 'measurements.jsonl'}:2: ")
    assert message in error and len(error) < 400 + len(str(tmp_path))


def test_a_file_that_cannot_grow_is_named(tmp_path):
    folder = ValidationFolder.create(tmp_path)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, limits[1]))
        with pytest.raises(OSError, match=r"measurements\.jsonl"):
            folder.measurements.append(COMPLETE)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_an_endless_device_is_refused(tmp_path):
    (tmp_path / "measurements.jsonl").symlink_to("/dev/zero")
    with pytest.raises(InputError, match="not a regular file"):
        ValidationFolder(tmp_path).measurements.read()


@pytest.mark.parametrize("missing", COMPLETE.to_json())
def test_a_missing_key_of_a_measurement_is_named(missing):
    data = {key: value for key, value in COMPLETE.to_json().items() if key != missing}
    with pytest.raises(InputError, match=rf"^m\.jsonl:1: damaged: /{missing} is missing$"):
        MeasuredSolution.from_json(data, "m.jsonl:1")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "damaged: Expecting value"),
        (b"\xff\xff", "damaged: 'utf-8' codec"),
        (b"{}", "damaged: /measurements is missing"),
        (b'{"measurements": [1]}', "/measurements/0: damaged: not a JSON object"),
    ],
)
def test_a_damaged_file_of_recorded_measurements_is_refused(content, message, tmp_path, capsys):
    path = tmp_path / "recorded.json"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"recorded\.json: ") as caught:
        load_recorded(path)
    assert message in str(caught.value)
    assert program("--record", path, "-o", tmp_path / "out") == 2
    assert capsys.readouterr().err.startswith(f"error: {path}: ")
    assert not (tmp_path / "out").exists()


RUNS = pd.DataFrame({"outcome": ["rest", "failed"], "n": [1.5, None], "wall_s": [0.7, 0.3]})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("{", "", "damaged: "),
        ("0.7", "0.2", "damaged: /runs is not what was written"),
        ('"failed"', "7", "damaged: /runs is not what was written"),
        ("0.7", "NaN", "damaged: /runs is not what was written"),
        ('"runs"', '"walks"', "damaged: /runs is missing"),
    ],
)
def test_damaged_runs_of_the_stress_suite_are_refused(old, new, message, tmp_path):
    folder = ValidationFolder.create(tmp_path)
    folder.keep_stress(RUNS, full=False, seed=1)
    file = tmp_path / "stress.json"
    assert folder.kept_stress(full=False, seed=1).equals(RUNS)
    file.write_text(file.read_text().replace(old, new, 1))
    with pytest.raises(InputError, match=r"stress\.json: ") as caught:
        folder.kept_stress(full=False, seed=1)
    assert message in str(caught.value)


def test_the_runs_of_another_stress_suite_are_not_used(tmp_path):
    folder = ValidationFolder.create(tmp_path)
    folder.keep_stress(RUNS, full=False, seed=1)
    assert folder.kept_stress(full=True, seed=1) is None
    assert folder.kept_stress(full=False, seed=2) is None


@pytest.mark.parametrize("name", ["measurements.jsonl", "stress.json"])
def test_resuming_in_a_damaged_folder_gives_one_line_and_code_2(
    name, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr(listing, "case_modules", lambda: {"made_up": "validation.made_up.case"})
    monkeypatch.setattr(listing, "cases_of", lambda module: [made_up_case(entries=[{"dx": 0.1}])])
    monkeypatch.setattr(stress, "run", lambda *_: pytest.fail("the damage was not found"))
    ValidationFolder.create(tmp_path / "out")
    (tmp_path / "out" / name).write_text("snow\n")
    assert program("-q", "--resume", "-o", tmp_path / "out") == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {tmp_path / 'out' / name}:") and error.count("\n") == 1
    assert not (tmp_path / "out" / "validation.html").exists()
