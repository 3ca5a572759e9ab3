"""The clearance answer, killed (SIGKILL) when some of its seasons are finished."""

import sqlite3
from contextlib import closing

import pytest
from helpers.processes import kill_with_children, snowshed_command, wait_for
from helpers.records import RECORDS, undated

from snowshed.season.weather.generator import Climate, MonthClimate
from snowshed.study.database import FILE

OFTEN = MonthClimate(0.08, 0.3, 1.5, 0.06, -4.0, 3.0)
WINTERS = Climate({12: OFTEN, 1: OFTEN, 2: MonthClimate(0.0, 0.0, 1.0, 0.1, -4.0, 3.0)})
PANEL = ("--slope-length", 0.6, "--tilt", 60, "--heights", "0.25,0.9", "--draws", 1)
STORE = f"runs-0.6-60/{FILE}"


@pytest.fixture(scope="module")
def weather(tmp_path_factory):
    file = tmp_path_factory.mktemp("weather") / "winters.csv"
    rows = "".join(
        f"{row.date.date()},{row.snowfall},{row.temperature}\n"
        for row in WINTERS.winters(3, seed=3)
    )
    file.write_text(f"date,snowfall_m,temperature_c\n{rows}")
    return file


def finished(folder):
    """Return the computing time, s, of each event in finished seasons, by which runs differ."""
    file = folder / STORE
    if not file.exists():
        return {}
    try:
        with closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as store:
            rows = store.execute(
                "SELECT hash, event, wall_s FROM event_timing JOIN run USING (hash) "
                "WHERE status = 'done'"
            ).fetchall()
    except sqlite3.OperationalError:  # its tables are being created
        return {}
    return {(hash_, event): seconds for hash_, event, seconds in rows}


def answer(weather, folder, jobs):
    return snowshed_command("clearance", weather, *PANEL, "--jobs", jobs, "-q", "-o", folder)


def files(folder):
    """Return all files of an answer beside its stores, by name; its record has no date."""
    contents = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    return {
        name: undated(content) if name in RECORDS else content for name, content in contents.items()
    }


@pytest.fixture(scope="module")
def reference(weather, tmp_path_factory):
    """The folder of an answer that is not killed."""
    folder = tmp_path_factory.mktemp("reference") / "answer"
    command = answer(weather, folder, 2)
    assert command.communicate(timeout=240)[1] == "" and command.returncode == 0
    return folder


@pytest.mark.parametrize("seasons", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_a_killed_answer_resumes_to_the_same_files(weather, reference, tmp_path, seasons):
    killed = answer(weather, tmp_path / "killed", 2)
    wait_for(lambda: len({hash_ for hash_, _ in finished(tmp_path / "killed")}) >= seasons)
    kill_with_children(killed)
    finished_before = finished(tmp_path / "killed")
    assert len(finished_before) < len(finished(reference))
    assert files(tmp_path / "killed") == {}

    resumed = answer(weather, tmp_path / "killed", 1)
    assert resumed.communicate(timeout=240)[1] == "" and resumed.returncode == 0
    assert finished_before.items() <= finished(tmp_path / "killed").items()
    expected = files(reference)
    assert {"clearance.html", "clearance.csv", "clearance.json"} < expected.keys()
    assert files(tmp_path / "killed") == expected
