"""Secondary releases, inflows and dams of slides from files."""

import json
import re

import pytest
from helpers.slide_files import box, plane, write_lines, write_polygons

from snowshed import InputError, run
from snowshed.cli.main import main
from snowshed.io.raster.raster import write_ascii_grid
from snowshed.scene import slide_scene

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")


@pytest.fixture
def files(tmp_path):
    write_ascii_grid(tmp_path / "dem.asc", plane(columns=60))
    (tmp_path / "flow.csv").write_text("timestep,thickness,velocity\n0.5,0.3,6\n200,0.3,6\n")
    return {
        "raster": tmp_path / "dem.asc",
        "release": write_polygons(tmp_path / "rel.geojson", thickness=0.5),
        "secondary_release": write_polygons(
            tmp_path / "sec.geojson", box(40, 12, 50, 28), thickness=0.4, name="bowl"
        ),
        "inflow": write_polygons(tmp_path / "in.geojson", box(10, 40, 20, 50), name="gully"),
        "hydrograph": tmp_path / "flow.csv",
        "dams": write_lines(tmp_path / "dam.geojson", [[[70, 4], [74, 50]]], height=9, name="wall"),
    }


def test_all_parts_act_and_notes_say_so(files, tmp_path):
    scene = slide_scene(**files, secondary_thickness=0.6).set("events.max_time", 12.0)
    assert scene.terrain.secondary_release[0].thickness == 0.6
    results = run(scene, tmp_path / "out", pictures=False)
    summary = results.summary
    notes = "\n".join(summary.notes)
    assert re.search(r"Secondary release bowl started after [0-9.]+ s, with [0-9,]+ kg\.", notes)
    assert "Inflow gully brought" in notes
    assert "The slide ended before 200 s, when more snow was to enter." in notes
    assert "Dam wall: no snow passed over it." in notes
    sources = summary.released_kg + summary.secondary_kg + summary.inflow_kg
    assert summary.on_terrain_kg + summary.left_terrain_kg == pytest.approx(sources, rel=1e-9)
    assert summary.secondary_kg > 0.0 and summary.inflow_kg > 0.0


def test_an_inflow_needs_its_hydrograph(files):
    del files["hydrograph"]
    with pytest.raises(InputError, match="give both the polygons of an inflow and its hydrograph"):
        slide_scene(**files)


def test_a_secondary_release_without_contact_is_noted(files, tmp_path):
    parts = {key: files[key] for key in ("raster", "release", "secondary_release")}
    scene = slide_scene(**parts).set("events.max_time", 0.1)
    notes = run(scene, tmp_path / "out", pictures=False).summary.notes
    assert "Secondary release bowl never started: no snow of the slide entered it." in notes


def test_the_command_takes_all_parts(files, tmp_path, undrawn):
    options = {
        "--terrain": files["raster"],
        "--release": files["release"],
        "--secondary-release": files["secondary_release"],
        "--inflow": files["inflow"],
        "--hydrograph": files["hydrograph"],
        "--dams": files["dams"],
    }
    words = [str(word) for pair in options.items() for word in pair]
    out = tmp_path / "out"
    assert main(["slide", *words, "-o", str(out), "-q", "--max-time", "0.2"]) == 0
    terrain = json.loads((out / "scene.json").read_text())["terrain"]
    assert [area["name"] for area in terrain["secondary_release"]] == ["bowl"]
    assert [len(inflow["hydrograph"]) for inflow in terrain["inflows"]] == [2]
    assert [dam["corners"][0]["height"] for dam in terrain["dams"]] == [9.0]
    balance = json.loads((out / "run.json").read_text())["mass_balance"]
    assert balance["secondary_release_kg"] == 0.0
    assert abs(balance["residual_kg"]) < 1e-6 * balance["released_kg"]


def test_an_avaframe_project_refuses_files_beside_it(files, tmp_path, capsys):
    command = ["slide", "--avaframe", str(tmp_path), "--dams", str(files["dams"])]
    assert main([*command, "-o", str(tmp_path / "out")]) == 2
    assert "the project's folders ENT, RES, SECREL, DAM and REL hold" in capsys.readouterr().err
