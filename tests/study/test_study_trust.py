"""A store may come from anyone: files outside it are not touched, and damage is detected."""

import random
import sqlite3
from pathlib import Path

import pytest
from study_helpers import outcome, tiny_study

from snowshed import InputError
from snowshed.io.locks import holding
from snowshed.study import StudyError, session
from snowshed.study.database import FILE
from snowshed.study.owner import release_dead
from snowshed.study.store import Store
from snowshed.study.table import read_table

RUNS = tiny_study().runs()


@pytest.fixture
def folder(tmp_path):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", ["panel.friction"], RUNS)
        for run in RUNS:
            store.record(outcome(run.hash))
    return tmp_path / "store"


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def change(folder, *queries):
    connection = sqlite3.connect(folder / FILE)
    with connection:
        for query in queries:
            connection.execute(query)
    connection.close()


def test_a_link_instead_of_the_folder_of_runs_is_refused(folder, tmp_path):
    (tmp_path / "home").mkdir()
    (tmp_path / "home/precious").write_text("x")
    (folder / "running").rmdir()
    (folder / "running").symlink_to(tmp_path / "home")
    with pytest.raises(InputError, match="running: a link"):
        session.resume(folder)
    assert names(tmp_path / "home") == ["precious"]


def test_foreign_files_are_not_removed(folder):
    foreign = folder / "running/mine"
    foreign.mkdir()
    (foreign / "a.txt").write_text("x")
    (folder / "running/notes.lock").write_text("x")
    (folder / "running" / ("0" * 32)).symlink_to(foreign)
    session.resume(folder)
    assert names(folder / "running") == ["0" * 32, "mine", "notes.lock"]
    assert names(foreign) == ["a.txt"]


def test_the_name_of_an_owner_is_not_used_as_a_path(folder, tmp_path):
    (tmp_path / "victim.lock").write_text("x")
    change(folder, "UPDATE run SET owner = '../../victim'")
    with Store.open(folder) as store:
        release_dead(store)
        assert store.owners() == []
    assert (tmp_path / "victim.lock").exists()


@pytest.mark.parametrize(
    "query",
    [
        "UPDATE run SET hash = '../../evil' WHERE rowid = 1",
        "UPDATE run SET scene = replace(scene, '9.81', '9.82')",
        "UPDATE run SET version = '0.0.0'",
        "UPDATE run SET status = 'pending'",
        "UPDATE run SET status = 'failed'",
        "UPDATE event SET height_m = height_m + 1e-6",
        "UPDATE run_timing SET run_wall_s = 2",
        "DELETE FROM event WHERE event = 2",
        "DELETE FROM study_run WHERE position = 1",
        "UPDATE study SET axes = '[\"panel.tilt\"]'",
        "UPDATE checksum SET digest = 'x'",
    ],
)
def test_a_changed_store_is_refused(folder, query):
    change(folder, "PRAGMA ignore_check_constraints = on", query)
    with pytest.raises(InputError, match="damaged: "):
        read_table(folder, timing=True)


def test_flipped_bits_are_refused_or_change_nothing(folder):
    expected = read_table(folder, timing=True)
    file = folder / FILE
    good = file.read_bytes()
    chance = random.Random(1)
    for _ in range(40):
        at = chance.randrange(len(good))
        file.write_bytes(good[:at] + bytes([good[at] ^ 1 << chance.randrange(8)]) + good[at + 1 :])
        for extra in ("-wal", "-shm"):
            (folder / f"{FILE}{extra}").unlink(missing_ok=True)
        try:
            table = read_table(folder, timing=True)
        except (InputError, StudyError):
            continue
        assert table.equals(expected), at


def remove_checksums(folder):
    change(folder, "DROP TABLE checksum", "PRAGMA user_version = 1")


def test_a_store_that_lost_its_checksums_is_damaged(folder):
    change(folder, "DROP TABLE checksum")
    with pytest.raises(InputError, match="damaged: the table of checksums is missing"):
        read_table(folder)


def test_a_running_earlier_version_is_distinguished_from_damage(folder):
    """It would add results without checksums. If it starts later, it refuses the store itself."""
    remove_checksums(folder)
    owner = "node-1-0123abcd"
    change(folder, f"UPDATE run SET owner = '{owner}' WHERE rowid = 1")
    refused = pytest.raises(InputError, match="an earlier version of snowshed is computing in it")
    with holding(folder / "running" / f"{owner}.lock", Path.touch), refused:
        read_table(folder)
    assert len(read_table(folder)) > 0
    assert sqlite3.connect(folder / FILE).execute("PRAGMA user_version").fetchone() == (2,)


def test_results_without_a_checksum_are_distinguished_from_changed_ones(folder):
    change(folder, "DELETE FROM checksum WHERE name LIKE 'results%'")
    with pytest.raises(InputError, match="without its checksum: damaged, or added by an earlier"):
        read_table(folder)
