"""A season through Python and the command line, on the coarsest possible grid."""

import dataclasses
import json
import math

import numpy as np
import pandas as pd
import pytest
from helpers.processes import modules_after

from snowshed import InputError, ResultNote, Scene, SnowshedNote, _core
from snowshed.cli.commands.season import print_season
from snowshed.cli.main import main
from snowshed.scene.panel_edge import panel_edge
from snowshed.season import SeasonSettings, accumulate, read_season, run_season
from snowshed.season.driver import season_result_figure, verdict
from snowshed.season.panel_contact import (
    PanelContact,
    below_panel,
    clearance,
    first_reached,
)
from snowshed.season.slabs import season_scene

SEASON = """date,snowfall_m,density_kg_m3,temperature_c
2024-12-01,0.03,200,-4
2024-12-05,0.05,,-2
2024-12-20,0.00,,3
2024-12-24,0.06,240,-1
"""


def panel_scene(**values):
    """The laboratory's panel on cells of 3 cm; soft snow, so that steps are long."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03})
    scene.update({"events.max_time": 3.0, "numerics.threads": 1})
    scene.update({"seeding.particles_per_voxel": 4, "snow.youngs_modulus": 2e5})
    return scene.update(values)


@pytest.fixture(scope="module")
def season_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("season") / "season.csv"
    file.write_text(SEASON)
    return file


@pytest.fixture(scope="module")
def finished(season_file, tmp_path_factory):
    """A season of four rows: two with a release, one held by adhesion, one without snow."""
    folder = tmp_path_factory.mktemp("season") / "results"
    settings = SeasonSettings(friction=0.6, adhesion=20.0, settling="vionnet-2012")
    return run_season(season_file, panel_scene(), folder, settings=settings), folder


def test_a_season_writes_a_table_and_a_figure(finished):
    result, folder = finished
    table = pd.read_csv(folder / "season.csv")
    assert table["released"].tolist() == ["no", "yes", "no", "yes"]
    assert table["date"].tolist()[0] == "2024-12-01"
    assert (folder / "season.png").stat().st_size > 10_000
    summary = json.loads((folder / "season.json").read_text())
    assert summary["releases"] == summary["simulated"] == 2
    assert summary["settings"]["adhesion"] == 20.0
    assert summary["burial_event"] == result.burial_event
    assert any("estimates (hedstrom-pomeroy-1998)" in note for note in summary["notes"])
    assert not any("before the snow rested" in note for note in summary["notes"])


def test_a_season_issues_its_notes_but_not_its_assumptions(season_file, tmp_path):
    scene = panel_scene(**{"events.max_time": 0.05})
    with pytest.warns(SnowshedNote) as notes:
        result = run_season(season_file, scene, tmp_path / "out", pictures=False)
    classes = {str(note.message): note.category for note in notes}

    limits = [note for note in result.notes if "ended before" in note or "estimates" in note]
    assert limits and all(classes[note] is ResultNote for note in limits)
    assert not [note for note in classes if note.startswith("the ground is bare")]


def test_notes_on_unusual_settings_are_in_the_result(season_file, tmp_path):
    scene = panel_scene(**{"panel.tilt": 20})
    with pytest.warns(SnowshedNote, match="adhesion: 0.1 Pa is unusual") as issued:
        settings = SeasonSettings(adhesion=0.1)
        run_season(season_file, scene, tmp_path / "out", settings=settings, pictures=False)
    assert len([note for note in issued if "adhesion: 0.1 Pa" in str(note.message)]) == 1
    notes = json.loads((tmp_path / "out/season.json").read_text())["notes"]
    assert notes.count(settings.notes[0]) == 1


def entries(folder):
    return {path.name: path.read_bytes() for path in folder.glob("season.*")}


def test_a_second_season_overwrites_the_first_on_request_only(season_file, tmp_path):
    flat, folder = panel_scene(**{"panel.tilt": 20}), tmp_path / "out"
    run_season(season_file, panel_scene(**{"events.max_time": 0.05}), folder, pictures=False)
    assert (folder / "run/scene.json").is_file()
    with pytest.raises(InputError, match=r"not empty; .*resume the season .*`overwrite=True`"):
        run_season(season_file, flat, folder, pictures=False)
    with pytest.raises(InputError, match="resume, overwrite: give one of the two"):
        run_season(season_file, flat, folder, resume=True, overwrite=True)
    before = entries(folder)
    result = run_season(season_file, flat, folder, overwrite=True, pictures=False)
    assert result.releases == 0 and sorted(entries(folder)) == sorted(before)
    assert entries(folder) != before and not (folder / "run").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_season_stays_if_the_new_one_cannot_begin_or_other_files_are_there(season_file, tmp_path):
    folder, usual = tmp_path / "out", panel_scene(**{"events.max_time": 0.05})
    run_season(season_file, usual, folder, pictures=False)
    before = entries(folder)
    inside = {"shape": {"type": "sphere", "center": [0, -1], "radius": 0.5}}
    for wrong in (usual.with_({"bodies": [inside]}), usual.with_({"panel": None})):
        with pytest.raises(InputError):
            run_season(season_file, wrong, folder, overwrite=True, pictures=False)
        assert entries(folder) == before and (folder / "run/events.csv").is_file()
    for place in ("thoughts.txt", "run/thoughts.txt"):
        (folder / place).write_text("mine")
        with pytest.raises(InputError, match=r"other files than those of a .*: thoughts\.txt"):
            run_season(season_file, usual, folder, overwrite=True, pictures=False)
        (folder / place).unlink()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_between_events_the_stack_only_settles(finished):
    table = pd.read_csv(finished[1] / "season.csv")
    height, settled = table["stack_height_m"], table["settled_height_m"]
    assert height[0] == 0.0
    assert 0.0 < height[1] == height[2]  # only an event changes the stack
    assert height[3] > 0.0
    assert settled[1] == pytest.approx(height[1])
    assert settled[2] < settled[1]
    assert (table["settled_clearance_m"] >= table["clearance_m"] - 1e-9).all()


def test_the_figure_names_the_event_that_buries_the_panel(finished):
    result, folder = finished
    scene = json.loads((folder / "run" / "scene.json").read_text())
    outlines = pd.read_csv(folder / "run" / "outline.csv")
    buried = dataclasses.replace(result, contact=PanelContact("2024-12-24", 2, "crest"))
    figure = season_result_figure(buried, outlines, scene)
    texts = [text.get_text() for text in figure.axes[1].texts]
    assert "first contact: crest, event 2" in texts
    assert verdict(buried) in figure.get_suptitle()
    assert verdict(buried).endswith("the lower edge, 2024-12-24 (event 2)")


def test_all_released_mass_slides_and_the_table_agrees_with_events(finished):
    result, folder = finished
    table = result.table[result.table["released"] == "yes"]
    events = pd.read_csv(folder / "run" / "events.csv")
    gathered = table["panel_load_kg_m2"].cumsum() * 0.245  # the panel's length
    total = events["mass_kg"] + events["on_panel_kg"]
    np.testing.assert_allclose(total, gathered, rtol=1e-5)
    np.testing.assert_allclose(table["stack_height_m"], events["height_m"], rtol=1e-5)


def test_the_clearance_follows_from_the_outline(finished):
    result, folder = finished
    scene = json.loads((folder / "run" / "scene.json").read_text())
    outline = pd.read_csv(folder / "run" / "outline.csv")
    last = outline[outline["event"] == 2]
    edge = 0.5 * 0.245 * math.cos(math.radians(50.0))
    surface = np.interp(edge, last["x"], last["z"], left=0.0, right=0.0)
    cover = result.table["cover_m"].iloc[-1]
    assert result.table["clearance_m"].iloc[-1] == pytest.approx(max(0.33 - cover - surface, 0.0))
    mean_cover = result.table["cover_m"][result.table["event"].notna()].mean()
    assert scene["panel"]["height"] == pytest.approx(0.33 - mean_cover, rel=1e-5)
    remaining = clearance(scene, last[["x", "z"]].to_numpy(), 0.2, -mean_cover)
    assert remaining.crest == pytest.approx(0.13, rel=1e-4)


def test_resuming_a_finished_season_changes_nothing(finished, season_file):
    result, folder = finished
    before = (folder / "season.csv").read_bytes()
    settings = SeasonSettings(friction=0.6, adhesion=20.0, settling="vionnet-2012")
    resumed = run_season(
        season_file, panel_scene(), folder, settings=settings, resume=True, pictures=False
    )
    assert (folder / "season.csv").read_bytes() == before
    assert resumed.table.equals(result.table)
    with pytest.raises(InputError, match="not empty"):
        run_season(season_file, panel_scene(), folder)


def test_a_scene_may_be_a_file_or_its_data(season_file, tmp_path):
    """A flat panel releases nothing, so nothing is simulated."""
    flat = panel_scene(**{"panel.tilt": 1.0}).resolve()
    flat.save(tmp_path / "scene.json")
    tables = [
        run_season(season_file, scene, tmp_path / name, pictures=False).table
        for name, scene in (("a", flat), ("b", flat.data), ("c", tmp_path / "scene.json"))
    ]
    assert tables[0]["event"].isna().all()
    assert tables[0].equals(tables[1]) and tables[0].equals(tables[2])


def test_slabs_lie_on_the_panel_of_the_core(season_file):
    days = accumulate(read_season(season_file), SeasonSettings(friction=0.1), 50.0)
    for dimension in (2, 3):
        values = {"ground.tilt": 10.0, "seeding.particles_per_voxel": 6}
        base = panel_scene(dimension=dimension, **values).resolve()
        scene = season_scene(base, days)
        simulation = _core.Simulation(scene.json, scene.base_dir)
        frame = simulation.panel_frame()
        np.testing.assert_allclose(
            panel_edge(scene.data).center, np.asarray(frame["center"])[[0, 2]], atol=1e-9
        )
        simulation.begin_event()
        offsets = simulation.positions() - frame["center"]
        thickness = days[0].thickness
        for axis, low, high in (
            (frame["normal"], 0.0, thickness),
            (frame["slope"], -0.1225, 0.1225),
        ):
            distances = offsets @ axis
            assert low <= distances.min() and distances.max() <= high
        assert simulation.masses().sum() == pytest.approx(
            days[0].load * 0.245 * (1.0 if dimension == 2 else 2 / 3 * base.data["panel"]["width"])
        )


def test_snow_above_the_panel_is_excluded_from_the_stack_below():
    scene = Scene.preset("lab-50").resolve().data
    outline = np.array([[0.0, 0.6], [0.05, 0.1], [0.07, 0.45], [0.3, 0.2]])
    np.testing.assert_array_equal(below_panel(scene, outline), outline[[1, 3]])
    assert clearance(scene, outline, 0.2).below == 0.0


def test_burial_is_the_first_event_that_closes_the_clearance():
    assert first_reached([0.5, 0.2, 0.03, 0.1], 0.03) == 3
    assert first_reached([0.5, 0.2], 0.03) is None


def test_snow_on_the_panel_supports_the_next_slabs(season_file, tmp_path):
    """The release criterion lets snow slide, but a panel with more sliding friction holds it."""
    result = run_season(
        season_file,
        panel_scene(**{"panel.friction": 3.0, "events.max_time": 0.2}),
        tmp_path / "results",
        settings=SeasonSettings(friction=0.1),
        pictures=False,
    )
    assert (result.staying_event, result.simulated, result.releases) == (1, 3, 3)
    masses = result.table["left_on_panel_kg"][result.table["released"] == "yes"].tolist()
    assert masses[0] < masses[1] < masses[2]
    assert any("from event 1 on, snow" in note for note in result.notes)


def test_scenes_without_a_panel_or_with_their_own_snow_are_refused(season_file, tmp_path):
    body = {"shape": {"type": "sphere", "center": [0, 1], "radius": 0.1}}
    bare = Scene(dimension=2).append("bodies", body)
    with pytest.raises(InputError, match="a season needs a panel"):
        run_season(season_file, bare, tmp_path / "results")
    with pytest.raises(InputError, match="/bodies: a season lays its own snow"):
        run_season(season_file, panel_scene().append("bodies", body), tmp_path / "results")
    assert not (tmp_path / "results").exists()


def command(season_file, folder, *options):
    panel = ("--height", "0.5", "--length", "1", "--tilt", "30", "--dim", "2", "-o", str(folder))
    return main(["season", str(season_file), *panel, *options])


def test_the_command_reports_the_result(season_file, tmp_path, capsys):
    assert command(season_file, tmp_path / "held", "--release-friction", "0.8") == 0
    output = capsys.readouterr().out
    assert "no snow slid: friction and adhesion held it" in output
    assert "2024-12-24" in output
    assert (tmp_path / "held" / "season.png").is_file()
    assert not (tmp_path / "held" / "run").exists()


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({}, "stacks of lab-50 in 2D, event 2, scheme thesis were"),
        (
            {"numerics.scheme": "objective"},
            "stacks of lab-50 in 2D, event 2, scheme objective were",
        ),
        (
            {"numerics.transfer": "affine_flip"},
            "no runs are recorded for scheme thesis with affine",
        ),
    ],
)
def test_the_error_of_the_grid_follows_from_the_scheme(finished, capsys, values, text):
    result, folder = finished
    print_season(result, folder, panel_scene(**values).resolve())
    output = " ".join(capsys.readouterr().out.split())
    assert f"error of the grid: {text}" in output


def test_the_command_names_bad_files_and_options(season_file, tmp_path, capsys):
    bad = tmp_path / "bad.csv"
    bad.write_text(SEASON + "2024-12-25,lots,,0\n")
    assert command(bad, tmp_path / "a") == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ") and "bad.csv, line 6, column snowfall_m: 'lots'" in error
    assert command(season_file, tmp_path / "a", "--settling", "guess") == 2
    assert "allowed: vionnet-2012, essery-2013" in capsys.readouterr().err
    assert command(season_file, tmp_path / "a", "--width", "-1") == 2
    assert "--width (/panel/width)" in capsys.readouterr().err
    assert not (tmp_path / "a").exists()


def test_errors_in_a_scene_file_name_the_file(season_file, tmp_path, capsys):
    scene = panel_scene().resolve().data
    layered = {**scene, "slab": {"layers": [{"thickness": 0.1}]}}
    for data, message in [
        ({**scene, "panel": {**scene["panel"], "length": -1}}, "/panel/length: -1"),
        ({**layered, "panel": {**scene["panel"], "tilt": 200}}, "/panel/tilt: 200"),
        ({"panle": {}}, "panle"),
    ]:
        file = tmp_path / "scene.json"
        file.write_text(json.dumps(data))
        arguments = ["season", str(season_file), "--scene", str(file), "-o", str(tmp_path / "a")]
        assert main(arguments) == 2
        error = capsys.readouterr().err
        assert error.startswith(f"error: {file}: ") and message in error
        assert error.count(str(file)) == 1


def test_the_season_is_not_imported_with_the_package():
    assert [m for m in modules_after("import snowshed") if "season" in m] == []
