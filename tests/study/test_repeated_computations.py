"""Studies, seasons and clearances from their records alone: every number is the same again."""

import json
import shutil
import sys
import warnings
from datetime import datetime, timedelta

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner
from study.study_helpers import tiny_scene

import snowshed
from snowshed import InputError, Scene, Study
from snowshed.analysis.clearance import SnowRanges
from snowshed.base.notes import record_notes
from snowshed.cli.main import cli
from snowshed.season import EXAMPLE_CLIMATE, SeasonSettings, Weather
from snowshed.study import Factor, NamedLaws, SeasonPart, axis, read_table, resume

WINTER = [
    Weather(day, datetime(2024, 12, 1) + timedelta(7 * day), 0.3, None, -4.0 + 0.1 * day)
    for day in range(3)
]
LAW = """
from snowshed.running import LAW_PROTOTYPES, Laws
slippery = LAW_PROTOTYPES["friction"](lambda speed, stress: 0.05)
def laws():
    return Laws("slippery", friction={"panel": slippery})
"""
pytestmark = pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")


def only_record(folder, name, to):
    """Leave nothing of a computation but its record, under another name."""
    record = shutil.copy(folder / name, to / "supplement.json")
    shutil.rmtree(folder)
    return record


def same_table(first, again):
    assert list(first.columns) == list(again.columns) and len(first) == len(again)
    for name in first:
        assert first[name].to_numpy().tobytes() == again[name].to_numpy().tobytes() or (
            first[name].equals(again[name])
        ), name
    for name in ("snowshed_build", "snowshed_version"):
        assert first.attrs.get(name) == again.attrs.get(name)


def studies(folder):
    points = Factor({"panel.height": np.array([0.2, 0.3]), "panel.length": (1.0, np.float64(1.1))})
    lab = tiny_scene(events=1)
    tilts = axis("panel.tilt", [50, 55.0])
    (folder / "slippery_law.py").write_text(LAW)
    sys.path.insert(0, str(folder))
    settings = SeasonSettings(friction=0.5, melt_factor=3.3)
    return {
        "product": Study.product(lab, {"snow.cohesion": [0.1, 0.3]}, seeds=[1, 7]),
        "parts": Study(lab, [[points, tilts], [axis("panel.friction", [0.1 + 0.2])]], name="a/b"),
        "season": Study.product(
            lab, {"panel.height": [0.3, 0.5]}, season=SeasonPart(WINTER, settings)
        ),
        "laws": Study.product(
            lab, {"panel.tilt": [50]}, name="laws", laws=NamedLaws("slippery_law:laws")
        ),
    }


@pytest.mark.parametrize("kind", ["product", "parts", "season", "laws"])
def test_a_study_is_made_again_from_its_record_alone(tmp_path, kind):
    study = studies(tmp_path)[kind]
    first = study.run(tmp_path / "store", jobs=1)
    (name,) = (path.name for path in (tmp_path / "store").glob("*.json"))
    record = only_record(tmp_path / "store", name, tmp_path)
    del study
    with record_notes() as notes:
        again = snowshed.repeat(record, tmp_path / "again", jobs=1)
    same_table(first, again)
    assert not any("another build" in note or "changed" in note for note in notes)
    planned = CliRunner().invoke(cli, ["repeat", str(record), "--dry-run"])
    assert planned.exit_code == 0 and f"{len(again.hash.unique())} runs" in planned.output
    done = CliRunner().invoke(cli, ["repeat", str(record), "-o", str(tmp_path / "third"), "-q"])
    assert done.exit_code == 0, done.output
    same_table(first, read_table(tmp_path / "third"))


def test_a_study_of_an_array_in_memory_is_made_again_from_record_and_array(tmp_path):
    x, z = np.linspace(-0.5, 0.5, 21), np.linspace(0, 0.5, 11)
    distances = np.hypot(*np.meshgrid(x, z, indexing="ij")) - 0.2
    shape = snowshed.Shape.from_distances(distances, spacing=0.05, origin=(1.0, 0.0))
    scene = tiny_scene(events=1).append("obstacles", snowshed.Obstacle(shape=shape))
    first = Study.product(scene, {"panel.tilt": [50]}).run(tmp_path / "store", jobs=1)
    data = json.loads((tmp_path / "store/study.json").read_text())
    (file,) = data["inputs"]
    assert file.startswith(str(tmp_path / "store-inputs"))
    record = only_record(tmp_path / "store", "study.json", tmp_path)
    same_table(first, snowshed.repeat(record, tmp_path / "again", jobs=1))


def test_a_record_of_a_study_holds_its_origin_and_the_notes_on_its_runs(tmp_path):
    scene = tiny_scene(events=1).with_({"slab.thickness": 0.02})
    Study.product(scene, {"panel.tilt": [50, 55]}).run(tmp_path, jobs=1)
    record = json.loads((tmp_path / "study.json").read_text())
    facts = {"version", "build", "package", "commit", "compiler", "kernels", "date", "machine"}
    assert facts | {"python", "numpy", "cpu", "inputs", "checksum"} <= set(record)
    notes = {note["note"]: note["runs"] for note in record["notes"]}
    assert 2 in notes.values() and any("stack is coarse" in note for note in notes)
    (tmp_path / "study.json").write_text((tmp_path / "study.json").read_text())
    resume(tmp_path, jobs=1)
    assert json.loads((tmp_path / "study.json").read_text()) == record


def test_a_record_of_another_build_or_changed_files_says_so(tmp_path):
    mesh = tmp_path / "ball.npy"
    axes = np.meshgrid(*[np.linspace(-1, 1, 9)] * 2, indexing="ij")
    np.save(mesh, np.hypot(*axes) - 0.5)
    solid = {"type": "grid", "file": str(mesh), "spacing": 0.25, "origin": [4.0, 4.0]}
    scene = tiny_scene(events=1).with_({"obstacles": [{"shape": solid}]})
    Study.product(scene, {"panel.tilt": [50]}).run(tmp_path / "store", jobs=1)
    record = json.loads((tmp_path / "store/study.json").read_text())
    del record["checksum"]
    record["build"] = "000000000000"
    (tmp_path / "other.json").write_text(json.dumps(record))
    np.save(mesh, np.hypot(*axes) - 0.4)
    with record_notes() as notes:
        Study.load(tmp_path / "other.json")
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        snowshed.repeat(tmp_path / "other.json", tmp_path / "again", jobs=1)
    for text in ("is of another build", "ball.npy has changed since", "its runs are others now"):
        assert any(text in note for note in notes), text
        assert sum(text in str(warning.message) for warning in issued) == 1, text


@pytest.mark.parametrize("fault", ["changed", "cut", "format", "kind"])
def test_a_damaged_record_is_refused(tmp_path, fault):
    study = Study.product(tiny_scene(events=1), {"panel.tilt": [50]})
    study.run(tmp_path / "store", jobs=1)
    file = tmp_path / "store/study.json"
    record = json.loads(file.read_text())
    if fault == "changed":
        file.write_text(file.read_text().replace("50", "60", 1))
    else:
        del record["checksum"]
        record["format"] += fault == "format"
        if fault == "cut":
            del record["study"]["parts"]
        if fault == "kind":
            del record["study"]
        file.write_text(json.dumps(record))
    with pytest.raises(InputError, match=r"study\.json"):
        snowshed.repeat(file, tmp_path / "again")


def test_a_season_is_made_again_from_its_season_json_alone(tmp_path):
    weather = tmp_path / "winter.csv"
    weather.write_text(
        "date,snowfall_m,temperature_c,snow_depth_m\n2024-12-01,0.31,-4,0.1\n"
        "2024-12-08,0.27,-3.3,\n2024-12-20,0,2.5,0.2\n2024-12-28,0.4,-6,\n"
    )
    scene = Scene.preset("lab-50").with_({"dimension": 2, "numerics.dx": 0.03, "panel.height": 0.8})
    settings = SeasonSettings(friction=0.6, adhesion=30.0, sintering="podolskiy-2014")
    first = snowshed.run_season(weather, scene, tmp_path / "first", settings=settings)
    files = {
        name: (tmp_path / "first" / name).read_bytes()
        for name in ("season.csv", "run/outline.csv", "run/ageing.csv")
    }
    events = snowshed.read_events(tmp_path / "first/run").drop(columns="wall_s")
    record = only_record(tmp_path / "first", "season.json", tmp_path)
    weather.unlink()
    again = snowshed.repeat(record, tmp_path / "again")
    assert again.notes == first.notes and again.contact == first.contact
    planned = CliRunner().invoke(cli, ["repeat", str(record), "--dry-run"])
    assert planned.exit_code == 0 and f"{first.releases} releases" in planned.output
    run = ["repeat", str(record), "-o", str(tmp_path / "third"), "-q"]
    done = CliRunner().invoke(cli, run)
    assert done.exit_code == 0, done.output
    for folder in ("again", "third"):
        for name, content in files.items():
            assert (tmp_path / folder / name).read_bytes() == content, name
        measured = snowshed.read_events(tmp_path / folder / "run").drop(columns="wall_s")
        pd.testing.assert_frame_equal(measured, events, check_exact=True)
    third = json.loads((tmp_path / "third/season.json").read_text())
    assert third["season"] == json.loads(record.read_text())["season"]


def test_a_clearance_is_made_again_from_its_clearance_json_alone(tmp_path):
    options = {"slope_length": 2.0, "tilt": 60.0, "heights": [0.6, 1.0], "jobs": 1}
    ranges = SnowRanges({"friction": (0.4, 0.6), "adhesion": (0.0, 100.0)}, draws=1, seed=3)
    winters = EXAMPLE_CLIMATE.winters(2, seed=7)
    scene = {"numerics.dx": 0.1, "events.max_time": 1.0}
    first = snowshed.clearance(winters, tmp_path / "runs", ranges=ranges, scene=scene, **options)
    record = only_record(tmp_path / "runs", "clearance.json", tmp_path)
    (again,) = snowshed.repeat(record, tmp_path / "again", jobs=1)
    same_table(first.table(), again.table())
    assert np.array_equal(first.required, again.required)
    planned = CliRunner().invoke(cli, ["repeat", str(record), "--dry-run"])
    assert planned.exit_code == 0 and "2 winters, 1 panel" in planned.output
    done = CliRunner().invoke(
        cli, ["repeat", str(record), "-o", str(tmp_path / "third"), "-q", "--jobs", "1"]
    )
    assert done.exit_code == 0, done.output
    written = json.loads((tmp_path / "third/clearance.json").read_text())
    assert written["clearance"] == json.loads(record.read_text())["clearance"]
    assert [panel["worst_winter"]["height"] for panel in written["panels"]] == [first.highest[0]]


def test_what_is_no_record_is_refused(tmp_path):
    (tmp_path / "scene.json").write_text('{"snowshed": 2, "dimension": 2}')
    done = CliRunner().invoke(cli, ["repeat", str(tmp_path / "scene.json"), "-o", str(tmp_path)])
    assert isinstance(done.exception, InputError) and "no record of a run" in str(done.exception)
    with pytest.raises(InputError, match="no record of a run"):
        snowshed.repeat(tmp_path / "scene.json", tmp_path / "out")


def test_a_record_of_a_study_is_not_taken_for_a_scene(tmp_path):
    Study.product(tiny_scene(events=1), {"panel.tilt": [50]}).run(tmp_path / "s", jobs=1)
    with pytest.raises(InputError, match=r"study\.json"):
        snowshed.run(tmp_path / "s/study.json", tmp_path / "out")
