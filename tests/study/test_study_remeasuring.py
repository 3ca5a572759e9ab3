"""Stacks measured again from the particles in a store."""

import sqlite3

import numpy as np
import pandas as pd
import pytest
from study_helpers import SEQUENTIAL, outcome, tiny_scene, tiny_study

from snowshed import InputError
from snowshed.cli.main import main
from snowshed.results.event_particles import EventParticles
from snowshed.results.folder import WORDS
from snowshed.snow.stack.quantities import MEASURES, QUANTITIES
from snowshed.study import Study, read_table, remeasure, resume
from snowshed.study.database import FILE
from snowshed.study.store import Store


@pytest.fixture(scope="module")
def store_with_particles(tmp_path_factory):
    """A run whose slabs have slid off, and one whose slabs stay, with their particles."""
    folder = tmp_path_factory.mktemp("kept") / "store"
    study = Study.product(tiny_scene(0.45), {"panel.friction": [0.1, 1.5]}, name="kept")
    study.compute(folder, keep_particles=True, **SEQUENTIAL)
    return folder


def test_a_remeasured_table_equals_the_measured_table(store_with_particles):
    measured, remeasured = read_table(store_with_particles), remeasure(store_with_particles)
    assert list(remeasured.columns) == list(measured.columns)
    assert (measured["on_panel_kg"] > 0).any() and (measured["mass_kg"] > 0).any()
    for name in measured:
        if measured[name].dtype.kind == "f":
            np.testing.assert_allclose(remeasured[name], measured[name], rtol=1e-5, atol=1e-6)
        else:
            assert remeasured[name].tolist() == measured[name].tolist()


def test_another_trimming_rule_takes_the_columns_without_a_prefix(store_with_particles):
    default, equal_pace = (
        remeasure(store_with_particles),
        remeasure(store_with_particles, trimming="equal_pace"),
    )
    assert set(equal_pace["trimming"]) == {"equal_pace"}
    for quantity in QUANTITIES:
        named = MEASURES["equal_pace"].column(quantity)
        pd.testing.assert_series_equal(
            equal_pace[f"{quantity}_m"], default[named], check_names=False
        )
    assert (equal_pace["length_m"] != default["length_m"]).any()


def test_custom_measures_are_evaluated(store_with_particles):
    def highest(particles):
        return {"highest_m": float(particles.positions[~particles.on_panel, 2].max(initial=0.0))}

    table = remeasure(store_with_particles, "kept", measure=highest)
    assert (table["highest_m"] >= table["height_m"] - 1e-6).all()
    assert (table["highest_m"] > 0).any()


def test_particles_in_3d_are_read_back_as_stored():
    random = np.random.default_rng(1)
    ones = np.ones(1003, dtype=np.float32)
    particles = EventParticles(
        random.normal(size=(1003, 3)).astype(np.float32),
        ones,
        200 * ones,
        random.uniform(size=1003) < 0.3,
        3,
        0.02,
        12.5,
    )
    unpacked = EventParticles.unpacked(particles.packed())
    for name, value in vars(particles).items():
        np.testing.assert_array_equal(getattr(unpacked, name), value)
    assert repr(unpacked.measure()) == repr(particles.measure())


def test_particles_are_stored_only_on_request(tmp_path, store_with_particles):
    study = tiny_study(frictions=(0.1,))
    study.compute(tmp_path / "store", **SEQUENTIAL)
    with pytest.raises(InputError, match=r"no particles of 2 of 2 stacks.*without keep_particles"):
        remeasure(tmp_path / "store")
    study.compute(
        tmp_path / "store", keep_particles=True, **SEQUENTIAL
    )  # already computed: no particles to store
    with Store.open(tmp_path / "store") as store:
        assert store.particles(study.runs()[0].hash) == {}


def test_a_resumed_study_stores_particles_as_requested(tmp_path):
    study = tiny_study(frictions=(0.1,))
    with Store.create(tmp_path / "store") as store:
        store.register(study.name, study.axes, study.runs(), keep_particles=True)
    resume(tmp_path / "store", **SEQUENTIAL)
    assert len(remeasure(tmp_path / "store")) == 2


def test_a_failed_run_keeps_its_row_without_a_stack(tmp_path):
    study = tiny_study()
    runs = study.runs()
    with Store.create(tmp_path / "store") as store:
        store.register(study.name, study.axes, runs, keep_particles=True)
        store.record(outcome(runs[0].hash, "failed", 0, "broken"))
    resume(tmp_path / "store", **SEQUENTIAL)
    table = remeasure(tmp_path / "store")
    assert table["ended"].tolist()[0] == "failed" and len(table) == 5
    assert table["height_m"].isna().tolist() == [True] + 4 * [False]
    with Store.open(tmp_path / "store") as store:
        store.reset([runs[0].hash])


def test_failed_runs_that_are_reset_lose_their_particles(tmp_path):
    study = tiny_study()
    hash_ = study.runs()[0].hash
    with Store.create(tmp_path / "store") as store:
        store.register(study.name, study.axes, study.runs(), keep_particles=True)
        failed = outcome(hash_, "failed", 1, "broken")
        store.record(type(failed)(**{**vars(failed), "particles": {1: b"packed"}}))
        assert store.particles(hash_) == {1: b"packed"}
        store.reset([hash_])
        assert store.particles(hash_) == {}


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", r"particles \w+: its checksum is wrong"),
        (b"PK\x03\x04 nothing", r"particles \w+: its checksum is wrong"),
        ("a text", r"run \w+.*its particles are no bytes"),
    ],
)
def test_damaged_particles_are_refused(tmp_path, data, message):
    study = tiny_study(frictions=(0.1,))
    study.compute(tmp_path / "store", keep_particles=True, **SEQUENTIAL)
    with sqlite3.connect(tmp_path / "store" / FILE) as database:
        database.execute("UPDATE event_particles SET data = ? WHERE event = 2", (data,))
    with pytest.raises(InputError, match=rf"store\.sqlite: damaged: {message}"):
        remeasure(tmp_path / "store")


def test_the_commands_store_and_remeasure_particles(tmp_path, capsys):
    tiny_study(frictions=(0.1,)).save(tmp_path / "study.toml")
    store, table = str(tmp_path / "store"), str(tmp_path / "table.csv")
    command = ["study", "run", str(tmp_path / "study.toml"), "-o", store, "--jobs", "1", "-q"]
    assert main([*command, "--keep-particles"]) == 0
    assert main(["study", "remeasure", store, "-o", table, "--trimming", "equal_pace"]) == 0
    assert pd.read_csv(table)["trimming"].tolist() == ["equal_pace"] * 2
    assert main(["study", "remeasure", store, "-o", table, "--trimming", "mine"]) == 2
    assert "'outermost_first', 'equal_pace'" in capsys.readouterr().err
    assert "trimming" in WORDS
