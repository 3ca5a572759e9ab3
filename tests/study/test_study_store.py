"""The store: its contents, owners of runs, and failures."""

import multiprocessing
import os
import sqlite3
from dataclasses import replace

import pytest
from study_helpers import contents, outcome, tiny_study

from snowshed import InputError, _core
from snowshed.study import StudyError, database
from snowshed.study.database import FILE, STORED_TYPES
from snowshed.study.owner import is_alive, ownership, release_dead
from snowshed.study.store import Store
from snowshed.study.table import read_table

RUNS = tiny_study().runs()
HASHES = [run.hash for run in RUNS]


@pytest.fixture
def tiny_store(tmp_path):
    with Store.create(tmp_path / "store") as tiny_store:
        tiny_store.register("tiny", ["panel.friction"], RUNS)
        yield tiny_store


def test_a_study_is_read_back_in_order(tiny_store):
    with Store.open(tiny_store.folder) as reopened:
        assert reopened.studies() == ["tiny"]
        assert reopened.axes("tiny") == ["panel.friction"]
        assert [(run.hash, run.scene) for run in reopened.runs("tiny")] == [
            (run.hash, run.scene) for run in RUNS
        ]
        assert {run.status for run in reopened.runs("tiny")} == {"pending"}


def test_a_changed_study_replaces_the_former_and_keeps_its_results(tiny_store):
    tiny_store.record(outcome(HASHES[0]))
    tiny_store.register("tiny", [], RUNS[:2])
    assert [run.status for run in tiny_store.runs("tiny")] == ["done", "pending"]


@pytest.mark.parametrize(
    ("query", "message"),
    [
        ("UPDATE study SET axes = '{'", "damaged: the axes of tiny are no list of names"),
        ("UPDATE study SET axes = '[1]'", "damaged: the axes of tiny are no list of names"),
        ("UPDATE study SET axes = x'ff'", "damaged: the axes of tiny are no list of names"),
        ("UPDATE run SET scene = '{'", "its scene: damaged: Expecting"),
        ("UPDATE run SET scene = '[]'", "its scene: damaged: not a JSON object"),
        ("UPDATE run SET scene = '{}'", "its scene: damaged: /dimension is missing"),
        ("UPDATE run SET scene = x'ff'", "not a text in every column"),
        ("UPDATE event SET height_m = 'high'", "height_m: 'high'"),
        ("UPDATE event SET height_m = 9e999", "height_m: inf"),
        ("UPDATE event SET height_m = x'ff'", "height_m: b'.xff'"),
        ("UPDATE event SET ended = x'ff'", "ended: b'.xff'"),
    ],
)
def test_impossible_contents_are_refused(tiny_store, query, message):
    tiny_store.record(outcome(HASHES[0]))
    connection = sqlite3.connect(tiny_store.folder / FILE)
    with connection:
        connection.execute(query)
    connection.close()
    with pytest.raises(InputError, match=rf"store\.sqlite: .*{message}"):
        read_table(tiny_store.folder)


def test_studies_share_runs(tiny_store):
    tiny_store.register("other", ["panel.friction"], reversed(RUNS))
    tiny_store.record(outcome(HASHES[1]))
    assert [run.status for run in tiny_store.runs("other")] == ["pending", "done", "pending"]
    with pytest.raises(InputError, match="holds several studies; name one of: other, tiny"):
        tiny_store.named(None)
    with pytest.raises(InputError, match="holds no study 'third'"):
        tiny_store.named("third")


def test_results_are_read_back_exactly(tiny_store):
    value = 0.1 + 0.2
    result = outcome(HASHES[0], events=1)
    result.events[0]["height_m"] = value
    result.events[0]["density_kg_m3"] = None
    tiny_store.record(result)
    ((height, density, wall),) = tiny_store.read(
        "SELECT height_m, density_kg_m3, wall_s FROM event JOIN event_timing USING (hash, event)"
    )
    assert (height, density, wall) == (value, None, 0.5)


def test_only_the_first_result_of_a_run_counts(tiny_store):
    tiny_store.record(outcome(HASHES[0]))
    tiny_store.record(outcome(HASHES[0], "failed", 1, "too late"))
    assert tiny_store.runs("tiny")[0].status == "done"
    assert tiny_store.read("SELECT count(*) FROM event") == [(2,)]


def test_a_study_with_moved_files_continues(tiny_store):
    """The hash is the same. Results stay, and pending runs use the new paths."""
    tiny_store.record(outcome(HASHES[0]))
    moved = [replace(run, scene=run.scene.replace("{", '{"moved": 1, ', 1)) for run in RUNS]
    tiny_store.register("tiny", ["panel.friction"], moved)
    scenes = [run.scene for run in tiny_store.runs("tiny")]
    assert scenes == [RUNS[0].scene, *(run.scene for run in moved[1:])]
    assert tiny_store.runs("tiny")[0].status == "done"


def test_a_failed_run_can_be_tried_again(tiny_store):
    tiny_store.record(outcome(HASHES[0], "failed", 1, "broken"))
    tiny_store.record(outcome(HASHES[1]))
    tiny_store.reset(HASHES)
    assert [run.status for run in tiny_store.runs("tiny")] == ["pending", "done", "pending"]
    assert tiny_store.read("SELECT DISTINCT hash FROM event") == [(HASHES[1],)]


def test_a_run_belongs_to_one_owner_until_it_is_released_or_recorded(tiny_store):
    first, second, _ = HASHES
    assert tiny_store.claim(first, "a") and tiny_store.claim(second, "a")
    assert tiny_store.claim(first, "a")
    assert not tiny_store.claim(first, "b")
    tiny_store.record(outcome(first))
    assert not tiny_store.claim(first, "b")
    tiny_store.release("a")
    assert tiny_store.claim(second, "b")
    assert tiny_store.owners() == ["b"]


def test_the_claims_of_a_dead_owner_are_taken_over(tiny_store):
    assert tiny_store.claim(HASHES[0], "died-long-ago")
    with Store.open(tiny_store.folder) as second_store, ownership(second_store) as living:
        assert second_store.claim(HASHES[1], living)
        assert is_alive(tiny_store, living) and not is_alive(tiny_store, "died-long-ago")
        release_dead(tiny_store)
        assert tiny_store.claim(HASHES[0], "me")
        assert not tiny_store.claim(HASHES[1], "me")
    assert tiny_store.claim(HASHES[1], "me")
    assert not any(tiny_store.running.iterdir())


def _claim_all(folder, owner, answers):
    with Store.open(folder) as store:
        answers.put([run.hash for run in store.runs("race") if store.claim(run.hash, owner)])


def test_racing_processes_share_the_runs(tmp_path):
    runs = tiny_study(frictions=tuple(0.1 + i / 1000 for i in range(40))).runs()
    with Store.create(tmp_path / "store") as store:
        store.register("race", [], runs)
    context = multiprocessing.get_context("spawn")
    answers = context.Queue()
    processes = [
        context.Process(target=_claim_all, args=(tmp_path / "store", f"owner {i}", answers))
        for i in range(3)
    ]
    for process in processes:
        process.start()
    claimed = [hash_ for _ in processes for hash_ in answers.get(timeout=120)]
    for process in processes:
        process.join()
    assert sorted(claimed) == sorted(run.hash for run in runs)


def _create(folder, answers):
    with Store.create(folder) as store:
        store.register("race", [], RUNS)
    answers.put("made")


def test_processes_that_make_the_same_store_at_once_all_succeed(tmp_path):
    context = multiprocessing.get_context("spawn")
    answers = context.Queue()
    processes = [
        context.Process(target=_create, args=(tmp_path / "new" / "store", answers))
        for _ in range(4)
    ]
    for process in processes:
        process.start()
    assert [answers.get(timeout=120) for _ in processes] == ["made"] * 4
    with Store.open(tmp_path / "new" / "store") as store:
        assert len(store.runs("race")) == 3


def test_a_full_disk_is_a_clear_error_and_loses_nothing(tiny_store):
    tiny_store.record(outcome(HASHES[0]))
    before = contents(tiny_store.folder)
    (pages,) = tiny_store.read("PRAGMA page_count")[0]
    tiny_store.read(f"PRAGMA max_page_count = {pages}")
    with pytest.raises(StudyError, match=r"disk is full; stored results are safe.*repeat"):
        tiny_store.record(outcome(HASHES[1], events=5000))
    assert contents(tiny_store.folder) == before
    tiny_store.read(f"PRAGMA max_page_count = {pages + 10000}")
    tiny_store.record(outcome(HASHES[1], events=5000))
    assert tiny_store.state(HASHES[1]) == ("done", None)


def test_runs_are_found_by_the_beginning_of_their_hash(tiny_store):
    assert tiny_store.find(HASHES[0][:12]).hash == HASHES[0]
    with pytest.raises(InputError, match="no run with a hash that begins with 'xyz'"):
        tiny_store.find("xyz")
    with pytest.raises(InputError, match="several runs"):
        tiny_store.find("")


def test_new_measures_are_added_to_an_older_store(tiny_store, monkeypatch):
    tiny_store.record(outcome(HASHES[0]))
    tiny_store.close()
    monkeypatch.setattr(database, "STORED_TYPES", {**STORED_TYPES, "wetness": "REAL"})
    with Store.open(tiny_store.folder) as newer:
        assert newer.read("SELECT height_m, wetness FROM event WHERE event = 1") == [(10.0, None)]


def test_unsuitable_folders_are_refused(tmp_path):
    (tmp_path / "file").touch()
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").touch()
    with pytest.raises(InputError, match="file: not a folder"):
        Store.create(tmp_path / "file")
    with pytest.raises(InputError, match="not empty, but holds no study"):
        Store.create(tmp_path / "full")
    with pytest.raises(InputError, match="holds no study"):
        Store.open(tmp_path / "none")
    with Store.create(tmp_path / "empty") as empty, pytest.raises(InputError, match="no study"):
        empty.named(None)
    assert not (tmp_path / "none").exists()
    assert [path.name for path in (tmp_path / "full").iterdir()] == ["thesis.txt"]


def test_other_databases_are_refused(tmp_path):
    connection = sqlite3.connect(tmp_path / FILE)
    connection.execute("CREATE TABLE run (distance REAL)")
    connection.close()
    with pytest.raises(InputError, match="not a store of studies"):
        Store.open(tmp_path)
    (tmp_path / FILE).write_bytes(b"no database at all" * 100)
    with pytest.raises(StudyError, match="file is not a database"):
        Store.open(tmp_path)


def test_a_damaged_store_with_an_undecodable_error_is_refused(tmp_path):
    connection = sqlite3.connect(tmp_path / FILE)
    connection.execute("CREATE TABLE run (distance REAL)")
    connection.execute("PRAGMA writable_schema = ON")
    connection.execute("UPDATE sqlite_master SET name = CAST(x'9e' AS TEXT), sql = 'damaged'")
    connection.commit()
    connection.close()
    with pytest.raises(StudyError, match=r"store\.sqlite: "):
        Store.open(tmp_path)


def test_a_store_of_another_version_is_refused(tiny_store):
    tiny_store.read("PRAGMA user_version = 99")
    with pytest.raises(InputError, match="another version of snowshed"):
        Store.open(tiny_store.folder)


def test_a_store_that_cannot_be_written_can_be_read(tmp_path, monkeypatch):
    with Store.create(tmp_path / "store") as tiny_store:
        tiny_store.register("tiny", ["panel.friction"], RUNS)
        tiny_store.record(outcome(HASHES[0]))
        monkeypatch.setattr(os, "access", lambda *arguments: False)
        with pytest.raises(InputError, match=r"left in the middle of a change"):
            Store.open(tmp_path / "store")
    before = {file: file.stat().st_mtime_ns for file in (tmp_path / "store").iterdir()}
    with Store.open(tmp_path / "store") as read_only:
        assert [run.status for run in read_only.runs("tiny")] == ["done", "pending", "pending"]
        with pytest.raises(StudyError, match="readonly"):
            read_only.claim(HASHES[1], "me")
    assert {file: file.stat().st_mtime_ns for file in (tmp_path / "store").iterdir()} == before


def test_runs_have_the_version_that_computed_them(tiny_store):
    assert {run.version for run in tiny_store.runs("tiny")} == {_core.version}


def test_notes_on_a_run_are_stored_with_its_results_and_guarded(tiny_store):
    notes = ("the slab is 1.5 cells thick", "snow stays on the panel")
    tiny_store.record(replace(outcome(HASHES[0]), notes=notes))
    tiny_store.record(replace(outcome(HASHES[1], "failed"), notes=notes[:1]))
    assert [tuple(run.notes) for run in tiny_store.runs("tiny")] == [notes, notes[:1], ()]
    tiny_store.reset([HASHES[1]])
    assert [tuple(run.notes) for run in tiny_store.runs("tiny")] == [notes, (), ()]
    for text in ("", '["none"]'):
        with sqlite3.connect(tiny_store.folder / FILE) as connection:
            connection.execute("UPDATE run SET notes = ? WHERE hash = ?", (text, HASHES[0]))
        with pytest.raises(InputError, match=f"notes {HASHES[0]}: its checksum is wrong"):
            tiny_store.runs("tiny")
