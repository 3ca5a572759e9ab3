"""AvaFrame projects on the command line: interruption, resuming, and refusals."""

import html
import json
import re
import shlex
import signal
import subprocess
import sys
import time

import pytest
from helpers.slide_files import box, write_polygons, write_project

from snowshed.cli.main import main
from snowshed.methods.slide.run import SlideRun

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")
pytest.importorskip("rasterio")

pytestmark = pytest.mark.usefixtures("undrawn")

PROGRAM = [sys.executable, "-m", "snowshed"]


def slide(project, out, *options):
    return main(["slide", "--avaframe", str(project), "-o", str(out), *map(str, options)])


def interrupted(project, out, number, *options):
    """Interrupt a project's first slide, and return the command that resumes it."""
    words = ["slide", "--avaframe", project, "-o", out, "-q", *options]
    run = subprocess.Popen([*PROGRAM, *map(str, words)], stderr=subprocess.PIPE, text=True)
    while not (out / "film.bin").exists() and run.poll() is None:
        time.sleep(0.01)
    run.send_signal(number)
    messages = run.communicate()[1]
    assert run.returncode == 130
    (hint,) = re.findall(r"interrupted; resume with: (.*)", messages)
    program, *resume = shlex.split(hint)
    assert (program, resume[0], resume[-1]) == ("snowshed", "slide", "--resume")
    assert {*map(str, options), str(project), str(out)} <= {*resume}
    return resume


def test_the_hint_after_an_interrupt_resumes_all_simulations(tmp_path):
    """The hint repeats the options of the command line."""
    ini = "tEnd = 6\ndeltaTh = 0.02\n"
    project = write_project(tmp_path / "a project", ini, releases=("north", "south"))
    out = tmp_path / "out"
    options = ["--no-bonds", "--stop-ratio", "0.0", "--thickness", "0.75"]
    resume = interrupted(project, out, signal.SIGINT, *options)
    assert not list(out.glob("south_*"))
    assert main(resume) == 0
    names = {file.name.split("_")[0] for file in out.glob("Outputs/com1DFA/peakFiles/*.asc")}
    assert names == {"north", "south"}
    for scene in (out / "scene.json", *out.glob("south_*/scene.json")):
        (area,) = json.loads(scene.read_text())["terrain"]["release"]
        assert area["thickness"] == 0.75
    assert (out / "Inputs/dem.asc").is_file()


def test_an_interrupt_while_pictures_are_drawn_stops_the_next_slide(
    tmp_path, capsys, monkeypatch, drawn
):
    project = write_project(tmp_path / "project", "tEnd = 0.05\n", releases=("a", "b"))
    draw = SlideRun.draw

    def interrupt(*arguments):
        signal.raise_signal(signal.SIGTERM)
        draw(*arguments)

    monkeypatch.setattr(SlideRun, "draw", interrupt)
    assert slide(project, tmp_path / "out", "-q") == 130
    assert "interrupted; resume with: " in capsys.readouterr().err
    assert not list((tmp_path / "out").glob("b_*"))
    assert (tmp_path / "out/slide.html").is_file()


def test_an_invalid_later_release_is_refused_before_the_first_slide(tmp_path, capsys):
    project = write_project(tmp_path / "project", "tEnd = 0.05\n", releases=("a", "b"))
    write_polygons(project / "Inputs/REL/b.geojson", box(60, 10, 90, 30), thickness=0.5)
    assert slide(project, tmp_path / "out", "-q") == 2
    assert "reaches beyond the terrain" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_settings_that_the_scene_refuses_are_located_in_the_ini(tmp_path, capsys):
    project = write_project(tmp_path / "project", "deltaTh = 1e-12\n")
    assert slide(project, tmp_path / "out", "-q") == 2
    message = capsys.readouterr().err
    assert (
        "com5SnowSlideCfg.ini, line 3: deltath: /numerics/layer_thickness: 1e-12 m makes" in message
    )
    assert not (tmp_path / "out").exists()


def test_outputs_that_cannot_be_written_give_code_3(tmp_path, capsys, monkeypatch):
    from snowshed import InputError

    def fail(*_):
        raise InputError("no rasterio")

    project = write_project(tmp_path / "project", "tEnd = 0.05\n")
    monkeypatch.setattr("snowshed.results.avaframe.write_avaframe_outputs", fail)
    assert slide(project, tmp_path / "out", "-q") == 3
    message = capsys.readouterr().err
    assert "the slide has ended, but its outputs could not be written: no rasterio" in message


def test_links_out_of_the_project_are_refused(tmp_path, capsys):
    project = write_project(tmp_path / "project", "tEnd = 0.05\n")
    (project / "Inputs/LINES").symlink_to("/")
    assert slide(project, tmp_path / "out", "-q") == 2
    assert "Inputs/LINES: a link that leads out of the project" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["project"]


def test_quiet_silences_the_notes_of_readers(tmp_path, capsys):
    """Warnings of GDAL become notes."""
    pyogrio = pytest.importorskip("pyogrio")
    import numpy as np
    import shapely

    ring = shapely.to_wkb(shapely.box(10, 10, 30, 30))
    project = write_project(tmp_path / "project", "tEnd = 0.05\n")
    (project / "Inputs/REL/rel.geojson").unlink()
    file = project / "Inputs/REL/rel.shp"
    pyogrio.raw.write(
        *(file, np.array([ring], dtype=object), [np.array([0.5])], np.array(["d0"])),
        crs="EPSG:31287", geometry_type="Polygon",
    )  # fmt: skip
    content = bytearray(file.read_bytes())
    content[36:100] = bytes(64)  # bounds; GDAL may warn about them
    file.write_bytes(content)
    assert slide(project, tmp_path / "out", "-q") == 0
    assert not capsys.readouterr().err
    assert slide(project, tmp_path / "loud") == 0
    printed = capsys.readouterr()
    assert "note: " in printed.out + printed.err


def test_layers_are_chosen_on_the_command_line(tmp_path, capsys):
    pyogrio = pytest.importorskip("pyogrio")
    import numpy as np
    import shapely

    project = write_project(tmp_path / "project")
    file = tmp_path / "areas.gpkg"
    for name, west in (("old", 10), ("new", 40)):
        ring = shapely.to_wkb(shapely.box(west, 10, west + 10, 30))
        pyogrio.raw.write(
            *(file, np.array([ring], dtype=object), [np.array([0.5])], np.array(["thickness"])),
            crs="EPSG:31287", geometry_type="Polygon", layer=name, append=file.exists(),
        )  # fmt: skip
    command = ["slide", "--terrain", project / "Inputs/dem.asc", "--release", file, "-q"]
    command = [str(word) for word in (*command, "--max-time", 0.05, "-o", tmp_path / "out")]
    assert main(command) == 2
    assert "has 2 layers: 'old', 'new'; choose one (--layer)" in capsys.readouterr().err
    forest = ["--layer", "new", "--resistance-areas", str(file)]
    assert main([*command, *forest]) == 2
    assert "choose one (--resistance-layer)" in capsys.readouterr().err
    assert main([*command, *forest, "--resistance-layer", "old"]) == 0
    terrain = json.loads((tmp_path / "out/scene.json").read_text())["terrain"]
    assert terrain["release"][0]["outline"][0][0] in (40, 50)
    assert terrain["resistance"][0]["outline"][0][0] in (10, 20)


def test_simulations_that_ranges_leave_out_are_told_and_recorded(tmp_path, capsys):
    project = write_project(tmp_path / "project", releases=("north", "south"))
    ranges = ["--range", "mu=0.3:0.5", "--runs", 2, "--jobs", 1, "--max-time", 0.2]
    assert slide(project, tmp_path / "out", "--thickness", 0.5, *ranges, "--no-bonds") == 0
    message = (
        "of the project's 2 simulations, these slides are north (null); left out: south (null)"
    )
    assert f"note: {message}" in capsys.readouterr().err
    assert message in json.loads((tmp_path / "out" / "hazard.json").read_text())["notes"]
    page = html.unescape((tmp_path / "out" / "hazard.html").read_text())
    assert message in page
