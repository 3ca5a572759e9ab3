"""``snowshed loads``: of scenes, of results, of slides, and what it refuses."""

import json

import pandas as pd
import pytest
from conftest import tiny_scene

from snowshed.cli.main import main


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
