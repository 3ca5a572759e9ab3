"""``snowshed loads``: of scenes, of results, of slides, and what it refuses."""

import html
import json
import shutil
from pathlib import Path

import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.interrupted_runs import interrupt_at

from snowshed import Results, read_events, run_events
from snowshed.analysis.loads.report import write_loads
from snowshed.base.notes import ResultNote
from snowshed.cli.main import main
from snowshed.io.run_files import unfinished_note
from snowshed.results.grid_export import export_grids
from snowshed.results.video import write_video
from snowshed.study.errors import resume_study_command


def snowshed(*arguments: object) -> int:
    return main([str(argument) for argument in arguments])


def test_a_scene_is_run_with_its_forces(tmp_path, capsys):
    tiny_scene(**{"events.count": 1}).resolve().save(tmp_path / "small.json")
    assert snowshed("loads", tmp_path / "small.json", "-o", tmp_path / "out",
                    "--snow-load", 3) == 0  # fmt: skip
    shown = capsys.readouterr().out
    assert "Largest loads" in shown and "loads.html" in shown
    table = pd.read_csv(tmp_path / "out/largest_loads.csv")
    assert table.obstacle.tolist() == ["ground", "panel"] and (table.peak_10ms_n > 0).all()
    assert snowshed("loads", tmp_path / "out/small", "-q") == 0
    assert (tmp_path / "out/small/loads.html").is_file()


def test_runs_record_forces_on_request(tmp_path, capsys):
    tiny_scene(**{"events.count": 1}).resolve().save(tmp_path / "small.json")
    assert snowshed("run", tmp_path / "small.json", "-o", tmp_path / "run", "--forces") == 0
    assert (tmp_path / "run/loads.csv").is_file() and (tmp_path / "run/forces.png").is_file()
    assert f"loads on what the snow meets: snowshed loads {tmp_path / 'run'}" in " ".join(
        capsys.readouterr().out.split()
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("small.json",), "-o: the scene"),
        (("run", "other"), "-o: several sources"),
        (("run", "--drag", "2"), "--layer, --drag: only with --objects"),
        (("run", "--objects", "a.geojson"), "give their drag coefficient"),
        (("run", "--snow-load", "-3", "-o", "out"), "snow_load: -3 is not allowed"),
        (("run", "--snow-load", "3", "--snow-depth", "0.01"), "at most that of ice"),
        (("nothere", "-o", "out"), "nothere: no such scene file or results folder"),
        (("small.json", "copy/small.json", "-o", "out"), "two scenes are called small"),
        (("run", "--objects", "a.geojson", "--dry-run"), "--objects: only with"),
    ],
)
def test_wrong_calls_are_refused(tmp_path, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(tmp_path)
    tiny_scene(**{"events.count": 1}).resolve().save(tmp_path / "small.json")
    for name in ("run", "other", "copy"):
        (tmp_path / name).mkdir()
    (tmp_path / "copy/small.json").write_text((tmp_path / "small.json").read_text())
    assert snowshed("loads", *arguments) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.fixture()
def everywhere(tmp_path):
    """A file with one object that covers every terrain."""
    pytest.importorskip("shapely")
    corners = [[0, 0], [1e6, 0], [1e6, 1e7], [0, 1e7], [0, 0]]
    feature = {"type": "Feature", "properties": {"name": "everything"},
               "geometry": {"type": "Polygon", "coordinates": [corners]}}  # fmt: skip
    file = tmp_path / "objects.geojson"
    file.write_text(json.dumps(
        {"type": "FeatureCollection", "features": [feature],
         "crs": {"type": "name", "properties": {"name": "EPSG:31287"}}}
    ))  # fmt: skip
    return file


def test_objects_in_the_way_of_a_slide_have_their_loads(tmp_path, capsys, everywhere):
    assert snowshed("slide", "--example", "--max-time", 2, "-o", tmp_path / "slide", "-q") == 0
    summary = json.loads((tmp_path / "slide/slide.json").read_text())
    assert snowshed("loads", tmp_path / "slide", "--objects", everywhere, "--drag", 1.5) == 0
    table = pd.read_csv(tmp_path / "slide/object_loads.csv")
    assert table.object.tolist() == ["everything"]
    assert table.pressure_kpa[0] == pytest.approx(1.5 * summary["peak_pressure_kpa"], rel=1e-3)
    shown = " ".join(capsys.readouterr().out.split())
    assert "upper bound" in shown and "still moving at the time limit" in shown


def test_unfinished_slides_of_many_are_counted_beside_the_loads(tmp_path, capsys, everywhere):
    assert snowshed("slide", "--example", "--max-time", 1, "--range", "mu=0.3:0.5", "--runs", 2,
                    "--jobs", 1, "-o", tmp_path / "maps", "-q") == 0  # fmt: skip
    assert snowshed("loads", tmp_path / "maps", "--objects", everywhere, "--drag", 1.5) == 0
    assert pd.read_csv(tmp_path / "maps/object_loads.csv").slides[0] == 2
    shown = " ".join(capsys.readouterr().out.split())
    assert "In 2 of 2 runs the slide had not come to rest at the time limit." in shown


@pytest.fixture(scope="module")
def unfinished(tmp_path_factory):
    """Return the folder of a run that was interrupted in its second event; its name has a space."""
    folder = tmp_path_factory.mktemp("runs") / "the run"
    scene = tiny_scene(**{"events.count": 3, "output.forces": True})
    with pytest.raises(KeyboardInterrupt):
        run_events(scene, folder, progress=interrupt_at(2, 0.05), pictures=False)
    return folder


def test_the_loads_of_an_unfinished_run_are_marked(unfinished, tmp_path, capsys):
    note = f"{unfinished}: the run is not finished (interrupted): later events are missing"
    assert snowshed("loads", unfinished, "-o", tmp_path / "loads") == 0
    assert f"note: {note}" in capsys.readouterr().err
    assert note in html.unescape((tmp_path / "loads/loads.html").read_text())


def test_other_uses_of_an_unfinished_run_are_noted(unfinished, tmp_path, capsys):
    run_events(tiny_scene(**{"events.count": 4}), tmp_path / "four", pictures=False)
    assert snowshed("compare", unfinished, tmp_path / "four") == 0
    messages = capsys.readouterr().err
    assert "the run is not finished (interrupted)" in messages
    assert "of only one of the two runs left out (" in messages
    assert snowshed("view", unfinished, "-o", tmp_path / "view.html") == 0
    assert "the run is not finished (interrupted)" in capsys.readouterr().err
    shutil.copytree(unfinished, tmp_path / "copy")
    (tmp_path / "copy/run.json").unlink()
    assert snowshed("loads", tmp_path / "copy", "-o", tmp_path / "loads") == 0
    assert "without run.json, so its run may not be finished" in capsys.readouterr().err


def test_python_notes_that_a_run_is_not_finished(unfinished, tmp_path):
    uses = (
        Results,
        read_events,
        lambda folder: export_grids(folder, tmp_path / "grids"),
        lambda folder: write_video(folder, tmp_path / "film.gif", seconds=0.2),
        lambda folder: write_loads([Results(folder)], tmp_path),
    )
    for use in uses:
        with pytest.warns(ResultNote, match="not finished") as notes:
            use(unfinished)
        assert [str(note.message) for note in notes].count(unfinished_note(unfinished)) == 1


def test_commands_in_messages_quote_the_names_of_folders(tmp_path, capsys):
    scene = tiny_scene(**{"events.count": 1}).resolve()
    scene.save(tmp_path / "small.json")
    assert snowshed("run", tmp_path / "small.json", "-o", tmp_path / "my run", "--forces") == 0
    shown = "".join(capsys.readouterr().out.split())
    for command in ("view", "loads"):
        assert f"snowshed{command}'{tmp_path / 'my run'}'".replace(" ", "") in shown
    assert resume_study_command(Path("my study")) == "snowshed study resume 'my study'"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--width", 300), "--width has no effect without --video"),
        (("--seconds", 3), "--seconds has no effect without --video"),
        (("--video", "a.gif", "-o", "a.html"), "--output has no effect with --video"),
    ],
)
def test_options_of_the_other_view_are_refused(unfinished, capsys, options, message):
    assert snowshed("view", unfinished, *options) == 2
    assert message in capsys.readouterr().err
