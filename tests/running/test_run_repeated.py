"""Runs without a folder, over an earlier run, and from a run.json alone."""

import json
import logging
import shutil
import warnings

import numpy as np
import pytest
from click.testing import CliRunner

import snowshed
from snowshed import InputError, Results, Scene, Simulation, SnowshedNote
from snowshed.base.build import build_id
from snowshed.cli.main import cli
from snowshed.results import InlineView
from snowshed.running import Ageing, Interval

TINY = Scene.preset("lab-50").with_(
    {"dimension": 2, "numerics.dx": 0.02, "events": {"count": 2, "max_time": 0.1}}
)
AGEING = Ageing({2: [Interval(86400.0, -5.0)]}, settling="vionnet-2012")


def heights(results):
    return results.events.height_m.tolist()


@pytest.fixture(autouse=True)
def _quiet(recwarn):
    """The tiny scene has notes."""


def test_a_run_without_a_folder_is_removed_with_its_results():
    results = snowshed.run(TINY, pictures=False)
    folder = results.folder
    assert len(results.events) == 2 and folder.is_dir()
    del results
    assert not folder.exists() and not folder.parent.exists()


@pytest.mark.parametrize("options", [{"resume": True}, {"overwrite": True}])
def test_a_run_without_a_folder_is_not_resumed(options):
    with pytest.raises(InputError, match="folder: missing"):
        snowshed.run(TINY, **options)


def test_a_second_run_overwrites_the_first_on_request_only(tmp_path):
    first = snowshed.run(TINY, tmp_path / "out", pictures=False)
    with pytest.raises(InputError, match="not empty"):
        snowshed.run(TINY, tmp_path / "out", pictures=False)
    steep = TINY.with_({"panel.tilt": 60})
    second = snowshed.run(steep, tmp_path / "out", overwrite=True, pictures=False)
    assert second.scene.data["panel"]["tilt"] == 60
    assert first.folder == second.folder
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_results_stay_if_the_new_run_cannot_begin(tmp_path):
    snowshed.run(TINY, tmp_path / "out", pictures=False)
    before = (tmp_path / "out/events.csv").read_bytes()
    inside = {"shape": {"type": "sphere", "center": [0, -1], "radius": 0.5}}
    with pytest.raises(InputError, match="below the ground"):
        snowshed.run(TINY.with_({"bodies": [inside]}), tmp_path / "out", overwrite=True)
    assert (tmp_path / "out/events.csv").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize(
    ("place", "overwrite"),
    [("new", False), ("new", True), ("empty", False), ("empty", True), ("old", True)],
)
def test_a_run_that_a_note_refuses_leaves_nothing(tmp_path, place, overwrite):
    folder = tmp_path / "out"
    if place == "empty":
        folder.mkdir()
    if place == "old":
        snowshed.run(TINY, folder, pictures=False)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    coarse = TINY.with_({"slab.thickness": 0.01})
    with warnings.catch_warnings():
        warnings.simplefilter("error", SnowshedNote)
        with pytest.raises(SnowshedNote, match="its stack is coarse"):
            snowshed.run(coarse, folder, overwrite=overwrite, pictures=False)
    after = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert after == before and folder.exists() == (place != "new")
    snowshed.run(coarse, folder, overwrite=place == "old", pictures=False)
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_foreign_files_are_never_overwritten(tmp_path):
    snowshed.run(TINY, tmp_path / "out", pictures=False)
    (tmp_path / "out/thoughts.txt").write_text("mine")
    with pytest.raises(InputError, match=r"other files than those of a run: thoughts\.txt"):
        snowshed.run(TINY, tmp_path / "out", overwrite=True)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/events.csv").write_text("mine")
    with pytest.raises(InputError, match="holds no run"):
        snowshed.run(TINY, tmp_path / "mine", overwrite=True)
    assert (tmp_path / "mine/events.csv").read_text() == "mine"


def test_a_run_json_alone_makes_every_number_again(tmp_path):
    first = snowshed.run(TINY, tmp_path / "first", ageing=AGEING, pictures=False)
    tables = {
        name: (tmp_path / "first" / name).read_bytes() for name in ("outline.csv", "ageing.csv")
    }
    expected = heights(first)
    shutil.copy(tmp_path / "first/run.json", tmp_path / "run.json")
    shutil.rmtree(tmp_path / "first")
    again = snowshed.run(tmp_path / "run.json", tmp_path / "again", pictures=False)
    assert heights(again) == expected
    for name, content in tables.items():
        assert (tmp_path / "again" / name).read_bytes() == content


def test_a_copy_of_a_run_json_repeats_the_ageing_under_any_name(tmp_path):
    expected = heights(snowshed.run(TINY, tmp_path / "first", ageing=AGEING, pictures=False))
    copied = shutil.copy(tmp_path / "first/run.json", tmp_path / "supplement.json")
    assert heights(snowshed.run(copied, tmp_path / "again", pictures=False)) == expected
    done = CliRunner().invoke(cli, ["run", str(copied), "-o", str(tmp_path / "third"), "-q"])
    assert done.exit_code == 0
    assert heights(Results(tmp_path / "third")) == expected


def test_a_scene_without_the_ageing_of_its_run_is_told(tmp_path):
    snowshed.run(TINY, tmp_path / "first", ageing=AGEING, pictures=False)
    with pytest.warns(SnowshedNote, match="its run had ageing, which a scene does not hold"):
        snowshed.run(tmp_path / "first/scene.json", pictures=False)
    copied = shutil.copy(tmp_path / "first/run.json", tmp_path / "supplement.json")
    with pytest.warns(SnowshedNote, match="its run had ageing, which a scene does not hold"):
        Scene.load(copied)
    with pytest.warns(SnowshedNote, match="the ageing of its run is left out"):
        Simulation(copied)


def test_a_damaged_run_json_is_refused_under_any_name(tmp_path):
    snowshed.run(TINY, tmp_path / "first", pictures=False)
    text = (tmp_path / "first/run.json").read_text()
    (tmp_path / "supplement.json").write_text(text.replace('"tilt": 50', '"tilt": 70'))
    for read in (snowshed.run, Scene.load, Simulation):
        with pytest.raises(InputError, match="its checksum is not that of its content"):
            read(tmp_path / "supplement.json")


def test_a_run_json_of_another_build_or_with_changed_files_says_so(tmp_path):
    axis = np.linspace(-1, 1, 9)
    z, y, x = np.meshgrid(axis, axis + 1, axis, indexing="ij")
    distances = np.sqrt(x**2 + y**2 + z**2) - 0.5
    np.save(tmp_path / "ball.npy", distances)
    solid = {"type": "grid", "file": str(tmp_path / "ball.npy"), "spacing": 0.25}
    solid["origin"] = [4.0, 4.0]
    snowshed.run(TINY.with_({"obstacles": [{"shape": solid}]}), tmp_path / "out", pictures=False)
    record = json.loads((tmp_path / "out/run.json").read_text())
    assert list(record["inputs"]) == [str(tmp_path / "ball.npy")]
    record["build"] = "000000000000"
    (tmp_path / "run.json").write_text(json.dumps(record))
    np.save(tmp_path / "ball.npy", distances + 0.1)
    with pytest.warns(SnowshedNote) as notes:
        again = snowshed.run(tmp_path / "run.json", pictures=False)
    texts = [str(note.message) for note in notes]
    assert any("is of another build of snowshed" in text for text in texts)
    assert any("ball.npy has changed since the run" in text for text in texts)
    assert any("ball.npy has changed" in text for text in again.run["notes"])


def test_tables_and_datasets_name_their_origin(tmp_path):
    results = snowshed.run(TINY, tmp_path / "out", pictures=False)
    for table in (results.events, results.particles(), results.particle_table(), results.grid()):
        assert table.attrs["snowshed_build"] == build_id()
        assert json.loads(table.attrs["scene"])["panel"]["tilt"] == 50
    record = Results(tmp_path / "out").run
    assert {"commit", "compiler", "date", "python", "numpy", "machine", "cpu"} <= set(record)


def test_particles_are_read_as_a_table_with_a_row_each(tmp_path):
    results = snowshed.run(TINY, tmp_path / "out", pictures=False)
    table, dataset = results.particle_table(1), results.particles(1)
    assert table.index.tolist() == dataset.particle.values.tolist()
    assert np.array_equal(table.position_z, dataset.position.sel(component="z"))


def test_results_show_their_table_in_notebooks(tmp_path):
    results = snowshed.run(TINY, tmp_path / "out")
    html = results._repr_html_()
    assert "height_m" in html and "data:image/png;base64" in html and "note:" in html


def test_the_moving_view_is_shown_in_a_cell(tmp_path):
    results = snowshed.run(TINY, tmp_path / "out", pictures=False)
    html = InlineView(results)._repr_html_()
    assert html.startswith("<iframe srcdoc=") and "&lt;canvas" in html
    assert InlineView(tmp_path / "out").page == InlineView(results).page
    assert not (tmp_path / "out/view.html").exists()


def test_the_course_of_a_run_is_logged(tmp_path, caplog):
    with caplog.at_level(logging.INFO, logger="snowshed"):
        snowshed.run(TINY, tmp_path / "out", pictures=False)
    texts = [record.getMessage() for record in caplog.records]
    assert sum(text.startswith("event ") for text in texts) == 2
    assert texts[-1] == f"finished in {tmp_path / 'out'}"
    assert any(text.startswith("note: ") for text in texts)
