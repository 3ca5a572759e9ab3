"""Notes of runs: as warnings, on the command line and in run.json, from every interface."""

import html
import json
import warnings

import numpy as np
import pytest
from conftest import tiny_mps, tiny_scene
from helpers.grain_files import VOXEL, write_labels
from helpers.slide_files import plane

from snowshed import InputError, ResultNote, Results, Scene, Simulation, SnowshedNote, run_events
from snowshed.base.notes import record_notes
from snowshed.cli.main import main
from snowshed.io.raster.raster import write_ascii_grid
from snowshed.results.view import write_view
from snowshed.running.run import run
from snowshed.running.scene_notes import notes_after, notes_before, notes_of_beginning
from snowshed.snow.accuracy.stack_errors import error_sentence


def ball_in_ground(**values: object) -> Scene:
    """Half of a ball of snow is below the ground, and the scene allows it."""
    ball = {"shape": {"type": "sphere", "center": [0, 0], "radius": 0.1}}
    scene = Scene.from_data({"snowshed": 2, "dimension": 2, "ground": {}, "bodies": [ball]})
    scene.update({"numerics": {"dx": 0.02, "threads": 1}, "misplaced_snow": "allow"})
    return scene.update({"events": {"max_time": 0.01, "rest_time": 0.0}, **values})


def notes_of(folder):
    return json.loads((folder / "run.json").read_text())["notes"]


def test_run_events_warns_and_records_notes(tmp_path):
    with pytest.warns(SnowshedNote), record_notes() as notes:
        run_events(tiny_scene(**{"panel.friction": 2.0}), tmp_path / "run", pictures=False)
    assert notes == notes_of(tmp_path / "run")
    assert [note.split(":")[0] for note in notes] == [
        "the slab is 20 mm thick, less than two cells of 20 mm",
        "nothing slid",
    ]


def test_a_run_notes_the_error_of_its_stack(tmp_path):
    scene = tiny_scene()
    with pytest.warns(ResultNote, match="error of the stack in recorded runs"):
        run_events(scene, tmp_path / "run", pictures=False)
    sentence = error_sentence(scene.resolve())
    assert notes_of(tmp_path / "run").count(sentence) == 1
    page = html.unescape(write_view(tmp_path / "run").read_text())
    assert sentence in page and sentence in html.unescape(Results(tmp_path / "run")._repr_html_())


def test_every_interface_notes_or_refuses_misplaced_snow(tmp_path, capsys):
    scene = ball_in_ground()
    with pytest.warns(SnowshedNote), record_notes() as in_memory:
        Simulation(scene).begin_event()
    assert len(in_memory) == 1 and "of its particles lie below the ground" in in_memory[0]
    with pytest.warns(SnowshedNote), record_notes() as notes:
        run_events(scene, tmp_path / "run", pictures=False)
    assert notes == in_memory == notes_of(tmp_path / "run")
    file = tmp_path / "scene.json"
    scene.resolve().save(file)
    assert main(["run", str(file), "-o", str(tmp_path / "other")]) == 0
    assert capsys.readouterr().err.count(f"note: {in_memory[0]}\n") == 1
    assert notes_of(tmp_path / "other") == in_memory
    assert main(["plan", str(file)]) == 0
    assert f"note: {in_memory[0]}\n" in capsys.readouterr().err
    scene.set("misplaced_snow", "refuse").resolve().save(file)
    with pytest.raises(InputError, match=r"/bodies/0/shape: .* lie below the ground, such as at"):
        run_events(scene, tmp_path / "refused")
    for arguments in (["run", str(file), "-o", str(tmp_path / "refused")], ["plan", str(file)]):
        assert main(arguments) == 2
        assert "misplaced_snow" in capsys.readouterr().err
    assert not (tmp_path / "refused").exists()


def test_quiet_runs_print_nothing_and_record_their_notes(tmp_path, capsys):
    file = tmp_path / "scene.json"
    ball_in_ground().resolve().save(file)
    assert main(["run", str(file), "-o", str(tmp_path / "run"), "-q"]) == 0
    assert capsys.readouterr().err == ""
    assert len(notes_of(tmp_path / "run")) == 1


def test_a_resumed_run_records_each_note_once(tmp_path):
    scene, folder = ball_in_ground(), tmp_path / "run"
    with pytest.warns(SnowshedNote):
        run_events(scene, folder, pictures=False)
    before = notes_of(folder)
    run_events(scene, folder, resume=True, pictures=False)
    assert notes_of(folder) == before


def test_the_command_scene_prints_the_notes_of_panel(tmp_path, capsys):
    options = ["--preset", "lab-50", "--dim", "2", "--dx", "0.02"]
    assert main(["scene", *options, "-o", str(tmp_path / "scene.json")]) == 0
    output = capsys.readouterr().err
    assert output.startswith("note: the slab is 20 mm thick, less than two cells of 20 mm")
    assert notes_of_beginning(tiny_scene().resolve())[0] in output


@pytest.mark.parametrize("kind", ["column", "mps slab"])
def test_notes_refer_to_parts_of_the_scene(kind):
    if kind == "column":
        assert notes_before(tiny_mps().resolve().data) == []
        return
    slab = tiny_mps(panel={"height": 0.5, "length": 1.0}, slab={"thickness": 0.05}, bodies=[])
    (note,) = notes_before(slab.resolve().data)
    assert note.endswith("two spacings of 50 mm: its stack is coarse; try spacing = 0.025 m")


def test_no_notes_on_parts_that_the_scene_lacks():
    import pandas as pd

    table = pd.DataFrame({"mass_kg": [1.0], "on_panel_kg": [0.0], "on_structures_kg": [1.0]})
    shelf = {"obstacles": [{"name": "shelf"}]}
    assert notes_after(table, shelf) == ["50 % of the snow stays on structures"]
    table = pd.DataFrame({"mass_kg": [1.0], "on_panel_kg": [0.9], "on_structures_kg": [0.1]})
    bare = {"panel": {}, "obstacles": []}
    assert notes_after(table, bare) == ["50 % of the snow stays on the panel"]
    assert notes_after(table, {**bare, **shelf}) == [
        "50 % of the snow stays on the panel or on structures"
    ]


def test_a_stack_that_still_moves_is_told(tiny, tmp_path):
    with pytest.warns(ResultNote, match="^2 of 2 events ended before the snow rested; allow a lo"):
        run_events(tiny.with_({"events.max_time": 0.1}), tmp_path / "out", pictures=False)
    assert "2 of 2 events ended before the snow rested" in " ".join(notes_of(tmp_path / "out"))


def test_added_snow_must_not_overlap_ground_or_snow():
    simulation = Simulation(ball_in_ground(misplaced_snow="refuse", bodies=[
        {"shape": {"type": "sphere", "center": [0, 0.1], "radius": 0.1}}
    ]))  # fmt: skip
    simulation.begin_event()
    before = simulation.particle_count
    with warnings.catch_warnings():
        warnings.simplefilter("error", SnowshedNote)
        simulation.add_snow([[0.3, 0.1], [0.3, 0.11]])
    for position in ([0.3, -0.1], [0.0, 0.1]):
        with pytest.raises(InputError, match=r"^positions: 100 % of its particles lie"):
            simulation.add_snow([position])
    assert simulation.particle_count == before + 2


@pytest.mark.parametrize("position", ["beside", "hole"])
def test_a_release_beside_the_terrain_or_over_a_hole_is_refused(tmp_path, position):
    raster = plane()
    if position == "hole":
        raster.heights[10, 10] = np.nan
    write_ascii_grid(tmp_path / "dem.asc", raster)
    west = -10 if position == "beside" else 10
    outline = [[west, 10], [west + 20, 10], [west + 20, 30], [west, 30]]
    release = [{"outline": outline, "thickness": 0.5}]
    data = {"snowshed": 2, "method": "slide", "misplaced_snow": "allow"}
    terrain = {"file": str(tmp_path / "dem.asc"), "release": release}
    scene = Scene.from_data({**data, "terrain": terrain})
    with pytest.raises(InputError, match=r"/terrain/release/0: (reaches beyond|the terrain has a)"):
        run(scene, tmp_path / "run", pictures=False)


def test_grains_begin_between_their_plates_and_below_the_cone(tmp_path):
    labels = write_labels(tmp_path)
    scene = Scene.from_data(
        {
            "snowshed": 2,
            "method": "grains",
            "gravity": 0,
            "sample": {"file": str(labels), "voxel_size": VOXEL},
            "loading": [{"kind": "penetrate", "strain": 0.01, "speed": 0.01}],
        }
    )
    simulation = Simulation(scene)
    simulation.begin_event()
    spheres, _ = simulation._core.grains_spheres()
    height = 12 * VOXEL
    radius = VOXEL / 2
    assert spheres[:, 2].min() >= radius * (1 - 1e-9)
    assert spheres[:, 2].max() <= (height - radius) * (1 + 1e-9)
    row = {name: values[0] for name, values in simulation._core.grains_curve().items()}
    assert row["cone_force_n"] == pytest.approx(0.0, abs=1e-9)
    with record_notes() as notes:
        summary = run(scene, tmp_path / "run", pictures=False).summary
    assert notes == notes_of(tmp_path / "run") == list(summary.notes)  # none of the beginning
