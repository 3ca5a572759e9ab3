"""A study file and a store of an earlier version are still read, and its runs are reused."""

import os
import sqlite3
from pathlib import Path

import pytest
import study_helpers

from snowshed import SnowshedNote, _core
from snowshed.base.build import build_id
from snowshed.study import Study
from snowshed.study.database import FILE
from snowshed.study.table import read_table

OLD = Path(__file__).with_name("old_study")

scripted_workers = study_helpers.scripted_workers  # a fixture


@pytest.fixture
def store(tmp_path, monkeypatch):
    monkeypatch.setattr(_core, "version", "0.1.0")  # part of the hashes
    folder = tmp_path / "store"
    folder.mkdir()
    connection = sqlite3.connect(folder / FILE)
    connection.executescript((OLD / "store.sql").read_text())
    connection.close()
    return folder


def test_an_old_study_is_not_computed_again(store, scripted_workers):
    study = Study.load(OLD / "study.toml")
    assert study.scene.numerics.courant_factor == 0.9
    table = study.run(store, same_version=True)
    assert scripted_workers.tasks == []
    assert table["height_m"].tolist() == [0.318458004]
    assert table["build"].tolist() == [""]
    assert table.attrs["snowshed_build"] == "unknown"


def test_by_default_an_old_study_is_computed_again_and_says_so(store, scripted_workers):
    study = Study.load(OLD / "study.toml")
    with pytest.warns(SnowshedNote, match="^1 run of .*: computed by another build of snowshed"):
        table = study.run(store)
    assert len(scripted_workers.tasks) == 1
    assert set(table["build"]) == {build_id()}


@pytest.mark.parametrize("writable", [True, False])
def test_the_table_of_an_old_store_is_read(store, monkeypatch, writable):
    monkeypatch.setattr(os, "access", lambda path, mode: writable)
    (row,) = read_table(store).to_dict("records")
    assert (row["panel.friction"], row["length_m"], row["ended"]) == (
        0.3,
        0.121961517,
        "time_limit",
    )
    assert (row["courant_factor"], row["trimming"]) == (0.9, "equal_pace")
    assert row["notes"] == ""  # unknown
