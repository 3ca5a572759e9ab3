"""The table of a study, and its exported files."""

import re
import sqlite3
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import study_helpers
import xarray
from helpers.paths import ROOT
from study_helpers import outcome, tiny_scene, tiny_study

from snowshed import InputError, Shape, _core
from snowshed.base.build import build_id
from snowshed.results.folder import EVENT_COLUMNS
from snowshed.scene.components import Obstacle
from snowshed.study import Factor, Study, export, read_table, to_dataset
from snowshed.study.database import FILE, MEASURED_TYPES, TIMING
from snowshed.study.store import Store
from snowshed.study.table_origin import column_units

computed_folder = study_helpers.computed_folder  # a fixture


def store_with(folder, study, *statuses):
    """Enter a study whose runs have these statuses."""
    with Store.create(folder) as store:
        store.register(study.name, study.axes, study.runs())
        for run, status in zip(study.runs(), statuses):
            if status == "done":
                store.record(outcome(run.hash))
            elif status == "failed":
                store.record(outcome(run.hash, "failed", 1, "broken"))
    return folder


@pytest.fixture
def mixed(tmp_path):
    """Runs that are done, failed in the second event, and not yet computed."""
    return store_with(tmp_path / "store", tiny_study(), "done", "failed", "pending")


def test_one_row_per_run_and_event_in_the_order_of_the_study(computed_folder):
    table = read_table(computed_folder)
    assert table["panel.friction"].tolist() == [0.1, 0.1, 0.2, 0.2, 0.3, 0.3]
    assert table.event.tolist() == [1, 2] * 3
    assert table["hash"].tolist() == [run.hash for run in tiny_study().runs() for _ in range(2)]


def test_every_row_has_its_settings(computed_folder):
    table = read_table(computed_folder)
    assert set(EVENT_COLUMNS) - {"wall_s"} <= set(table.columns)
    assert not {"wall_s", *TIMING} & set(table.columns)
    settings = table.iloc[0][["seed", "dimension", "dx", "precision", "transfer", "flip_ratio"]]
    assert settings.tolist() == [1, 2, 0.02, "float", "flip", 0.99]
    assert {"version", "basis", "courant_factor", "particles_per_voxel", "pattern"} <= set(table)
    timed = read_table(computed_folder, timing=True)
    assert (timed.wall_s > 0).all() and (timed.run_wall_s > 0).all()
    assert (timed.threads == 1).all() and (timed.particles > 0).all()


def test_rows_of_early_versions_have_the_trimming_rule_of_their_time(mixed):
    """An older store gains columns, which are empty in its rows; failed runs have no measures."""
    named = [name for name in MEASURED_TYPES if "trimm" in name or name.startswith("equal_pace")]
    with sqlite3.connect(mixed / FILE) as database:
        database.execute("DROP TABLE checksum")
        database.execute("PRAGMA user_version = 1")
        database.execute(f"UPDATE event SET {', '.join(f'{name} = NULL' for name in named)}")
    table = read_table(mixed)
    measured = table["height_m"].notna()
    assert measured.tolist() == [True, True, True, False]
    assert (table["trimming"][measured] == "equal_pace").all()
    assert not table["trimming"][~measured].notna().any()
    for name in ("height", "length", "head", "tail"):
        same = table[f"equal_pace_{name}_m"] == table[f"{name}_m"]
        assert same[measured].all()


def test_a_store_of_the_last_version_is_read_with_present_names(tmp_path):
    study = Study.product(tiny_scene(), {"numerics.step_factor": [0.5]}, name="tiny")
    folder = store_with(tmp_path / "store", study, "done")
    with sqlite3.connect(folder / FILE) as store:
        ((scene,),) = store.execute("SELECT scene FROM run").fetchall()
        store.execute("DROP TABLE checksum")
        store.execute("PRAGMA user_version = 1")
        store.execute("UPDATE run SET scene = ?", (scene.replace("courant", "step"),))
    store.close()
    table = read_table(folder)
    assert table["numerics.step_factor"].tolist() == table["courant_factor"].tolist() == [0.5, 0.5]


def test_failed_runs_have_an_error_and_missing_runs_no_rows(mixed):
    table = read_table(mixed)
    assert table.event.tolist() == [1, 2, 1, 2]
    assert table.ended.tolist() == ["rest", "rest", "rest", "failed"]
    assert table.error.tolist() == ["", "", "", "broken"]
    assert table.height_m.isna().tolist() == [False, False, False, True]
    assert table.steps.isna().tolist() == [False, False, False, True]


def test_parameters_that_a_part_does_not_vary_come_from_the_scene(tmp_path):
    parts = [[Factor({"panel.tilt": [40]})], [Factor({"panel.height": [1.0]})]]
    study = Study(tiny_scene(), parts)
    table = read_table(store_with(tmp_path / "store", study, "done", "done"))
    rows = table[table.event == 1][["panel.tilt", "panel.height"]]
    assert rows.to_numpy().tolist() == [[40, 0.33], [50, 1]]


def test_vectors_become_text_and_missing_parts_empty_cells(tmp_path):
    scene = tiny_scene()
    obstacles = [[], [Obstacle(shape=Shape.sphere((3, 0), 0.1), friction=0.7)]]
    domain = {"domain": [{"min": [-9, -9], "max": [9, 9]}]}
    study = Study(scene, [[Factor({"obstacles": obstacles}), Factor(domain)]])
    folder = store_with(tmp_path / "store", study, "done", "done")
    with Store.open(folder) as store:
        store.register("study", ["obstacles.0.friction", "domain.min"], study.runs())
    table = read_table(folder)
    assert table["domain.min"].tolist() == ["[-9.0, -9.0]"] * 4
    assert table["obstacles.0.friction"].isna().tolist() == [True, True, False, False]


def test_a_table_without_rows_has_its_columns(tmp_path):
    table = read_table(store_with(tmp_path / "store", tiny_study(), "pending"))
    assert len(table) == 0 and {"panel.friction", "height_m", "dx"} <= set(table)


@pytest.mark.parametrize("form", ["csv", "parquet", "nc"])
def test_an_axis_that_is_also_a_setting_is_a_single_column(tmp_path, form):
    study = Study.product(tiny_study().scene, {"dimension": [2, 3]}, name="both")
    folder = store_with(tmp_path / "store", study, "done", "done")
    assert list(read_table(folder)).count("dimension") == 1
    export(folder, tmp_path / f"table.{form}")


def test_netcdf_needs_a_run_that_is_done(tmp_path):
    folder = store_with(tmp_path / "store", tiny_study(), "pending")
    with pytest.raises(InputError, match="no run is done yet"):
        export(folder, tmp_path / "table.nc")
    assert not (tmp_path / "table.nc").exists()


def test_one_of_several_studies_must_be_named(tmp_path):
    store_with(tmp_path / "store", tiny_study(), "done", "done", "done")
    store_with(tmp_path / "store", tiny_study("other", (0.3, 0.5)))
    with pytest.raises(InputError, match="name one of: other, tiny"):
        read_table(tmp_path / "store")
    assert read_table(tmp_path / "store", "other")["panel.friction"].tolist() == [0.3, 0.3]


def test_csv_and_parquet_preserve_the_table(mixed, tmp_path):
    table = read_table(mixed)
    export(mixed, tmp_path / "t.csv")
    export(mixed, tmp_path / "t.parquet")
    from_csv = pd.read_csv(tmp_path / "t.csv", dtype={"steps": "Int64"}, keep_default_na=True)
    pd.testing.assert_frame_equal(
        from_csv.fillna({"error": "", "notes": ""}), table, check_dtype=False
    )
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "t.parquet"), table)


def test_netcdf_has_runs_and_events_as_dimensions(mixed, tmp_path):
    export(mixed, tmp_path / "t.nc", timing=True)
    with xarray.open_dataset(tmp_path / "t.nc") as dataset:
        assert dict(dataset.sizes) == {"run": 2, "event": 2}
        assert dataset.event.values.tolist() == [1, 2]
        assert dataset["panel.friction"].dims == ("run",)
        assert dataset["panel.friction"].values.tolist() == [0.1, 0.2]
        assert dataset.height_m.dims == ("run", "event")
        assert dataset.height_m.attrs["units"] == "m"
        assert dataset.density_kg_m3.attrs["units"] == "kg/m3"
        assert dataset.error.values.tolist() == [["", ""], ["", "broken"]]
        assert np.isnan(dataset.height_m.values).tolist() == [[False, False], [False, True]]
        assert dataset.steps.values[1, 1] == 0
        assert dataset.wall_s.values[0].tolist() == [0.5, 0.5]


def test_a_product_unfolds_into_a_dimension_per_parameter(tmp_path):
    study = Study.product(tiny_scene(), {"panel.tilt": [40, 50], "panel.height": [1.0, 2.0, 3.0]})
    table = read_table(store_with(tmp_path / "store", study, *["done"] * 6))
    grid = to_dataset(table).set_index(run=["panel.tilt", "panel.height"]).unstack("run")
    assert grid.height_m.sizes == {"panel.tilt": 2, "panel.height": 3, "event": 2}


def test_the_example_of_the_guide_works_with_files(tmp_path):
    """xarray reads texts of a file lazily, and cannot make dimensions of such texts."""
    study = Study.product(tiny_scene(), {"panel.tilt": [40, 50], "panel.height": [1.0, 2.0]})
    export(store_with(tmp_path / "store", study, *["done"] * 4), tmp_path / "t.nc")
    guide = (ROOT / "docs" / "reference" / "study-table.md").read_text(encoding="utf-8")
    (recipe,) = re.findall(r"^`(xarray\..*t\.nc.*)` makes", guide, re.M)
    script = recipe.replace('"t.nc"', repr(str(tmp_path / "t.nc")))
    grid = eval(script, {"xarray": xarray})
    assert grid.height_m.sizes == {"panel.tilt": 2, "panel.height": 2, "event": 2}


def test_the_format_follows_from_the_ending_or_the_option(mixed, tmp_path):
    export(mixed, tmp_path / "table.txt", form="csv")
    assert (tmp_path / "table.txt").read_text().startswith("hash,panel.friction,seed,event,")
    with pytest.raises(InputError, match=r"unknown format .* allowed: csv, parquet, netcdf"):
        export(mixed, tmp_path / "table.xls")
    assert not (tmp_path / "table.xls").exists()


@pytest.mark.parametrize(("form", "library"), [("parquet", "pyarrow"), ("netcdf", "xarray")])
def test_without_its_library_a_format_says_what_to_install(mixed, tmp_path, hide, form, library):
    hide(library)
    with pytest.raises(InputError, match=r'pip install "snowshed\[study\]"'):
        export(mixed, tmp_path / "table", form=form)
    assert not (tmp_path / "table").exists()


def test_all_measures_except_counts_and_words_have_units():
    units = column_units(pd.DataFrame(columns=["panel.tilt", *MEASURED_TYPES]))
    assert units["panel.tilt"] == "degrees" and units["volume_m3"] == "m3"
    assert {name for name in MEASURED_TYPES if name not in units} == {
        "joined",
        "steps",
        "ended",
        "trimming",
    }


def test_tables_have_the_origin_and_the_units_of_results(mixed, tmp_path):
    table = read_table(mixed)
    origin = {"snowshed_version": _core.version, "snowshed_build": build_id()}
    assert {name: table.attrs[name] for name in origin} == origin
    units = table.attrs["units"]
    assert (units["height_m"], units["dx"], units["damping_rate_per_s"]) == ("m", "m", "1/s")
    dataset = to_dataset(table)
    assert dataset.attrs == origin
    assert dataset["dx"].attrs["units"] == "m"
    with sqlite3.connect(mixed / FILE) as connection:  # as if another build had computed a run
        connection.execute("UPDATE run SET build = 'other' WHERE status = 'failed'")
    builds = sorted([build_id(), "other"])
    assert read_table(mixed).attrs["snowshed_build"] == builds
    assert to_dataset(read_table(mixed)).attrs["snowshed_build"] == builds
    export(mixed, tmp_path / "t.nc")
    with xarray.open_dataset(tmp_path / "t.nc") as stored:
        assert stored.attrs["snowshed_build"] == ", ".join(builds)


def test_a_table_without_builds_or_rows_has_no_origin(tmp_path):
    empty = read_table(store_with(tmp_path / "store", tiny_study(), "pending"))
    assert set(empty.attrs) == {"units"}
    table = pd.DataFrame({"hash": ["a"], "event": [1], "height_m": [0.1]})
    assert to_dataset(table).attrs == {}


def test_the_table_has_the_notes_of_each_run_in_every_form(tmp_path):
    folder, study = tmp_path / "store", tiny_study(frictions=(0.1, 0.2))
    with Store.create(folder) as store:
        runs = study.runs()
        store.register(study.name, study.axes, runs)
        for run, notes in zip(runs, (("thin slab", "snow stays"), ())):
            store.record(replace(outcome(run.hash, events=1), notes=notes))
    table = read_table(folder)
    assert table["notes"].tolist() == ["thin slab; snow stays", ""]
    assert to_dataset(table)["notes"].values.tolist() == ["thin slab; snow stays", ""]
    export(folder, tmp_path / "table.csv")
    assert "thin slab; snow stays" in (tmp_path / "table.csv").read_text()
