"""Results of AvaFrame's projects: names, folders and settings as AvaFrame's tools read them.

AvaFrame needs libraries of other versions than these tests. If SNOWSHED_AVAFRAME_PYTHON names a
Python with AvaFrame, AvaFrame itself reads the results.
"""

import configparser
import csv
import json
import os
import re
import subprocess

import numpy as np
import pytest
from conftest import leave_out_drawings
from helpers.slide_files import box, plane, write_polygons, write_project

from snowshed.cli.main import main
from snowshed.io.raster.raster import read_raster
from snowshed.methods import slide_states

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")

NAME = re.compile(r"(rel|up_hill_AF)_([0-9a-f]{10})_com5_C_L_(null|res)_ssl")


def run(project, folder, *options):
    assert main(["slide", "--avaframe", str(project), "-o", str(folder), "-q", *options]) == 0
    return folder


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Two releases with and without forest: four simulations of a tenth of a second."""
    folder = tmp_path_factory.mktemp("avaframe")
    ini = "tEnd = 0.1\ntSteps = 0|0.05\nresType = ppr|pft|pfv|FT\n"
    project = write_project(folder / "project", ini, releases=("rel", "up_hill"))
    write_polygons(project / "Inputs/RES/res.geojson", box(50, 10, 60, 30))
    with pytest.MonkeyPatch.context() as patch:
        leave_out_drawings(patch)
        return run(project, folder / "out", "--particles-at", "1")


@pytest.mark.parametrize("module", ["com1DFA", "com5SnowSlide"])
def test_every_simulation_has_its_maps_and_settings(results, module):
    outputs = results / "Outputs" / module
    names = {path.stem.rsplit("_", 1)[0] for path in outputs.glob("peakFiles/*.asc")}
    matches = [NAME.fullmatch(name) for name in names]
    assert len(names) == 4
    assert {(m[1], m[3]) for m in matches} == {
        (rel, kind) for rel in ("rel", "up_hill_AF") for kind in ("null", "res")
    }
    assert len({m[2] for m in matches}) == 4  # no two simulations have the same hash
    with (outputs / "configurationFiles/allConfigurations.csv").open(newline="") as table:
        assert {row["simName"] for row in csv.DictReader(table)} == names
    for name in names:
        times = {path.stem.rsplit("_t", 1)[1] for path in outputs.rglob(f"{name}_ppr_t*.asc")}
        assert times == {"0.00", "0.05", "0.11"}
        ini = configparser.ConfigParser()
        ini.optionxform = str
        ini.read(outputs / f"configurationFiles/{name}.ini")
        assert ini["GENERAL"]["relTh0"] == "0.5"
        assert ini["GENERAL"]["simTypeActual"] == NAME.fullmatch(name)[3]


def test_maps_have_the_values_of_their_time(results):
    maps = {
        time: read_raster(next(results.glob(f"Outputs/com1DFA/*/*/rel_*_null_*_pfv_t{time}.asc")))
        for time in ("0.00", "0.05", "0.11")
    }
    assert maps["0.00"].heights.max() == 0
    # The speed of a node is a mean over particles; the slide accelerates.
    (state,) = slide_states(results / "scene.json", steps=[5])
    expected = np.linalg.norm(state.quantities["velocity"], axis=1).max()
    assert 0.7 * expected < maps["0.05"].heights.max() < expected
    assert maps["0.11"].heights.max() > 1.5 * expected
    final = next(results.glob("Outputs/com1DFA/peakFiles/rel_*_null_*_pfv.asc"))
    assert (read_raster(final).heights == maps["0.11"].heights).all()


def test_the_first_simulation_writes_into_the_folder_itself(results):
    assert (results / "particles_step00001.csv").is_file()
    assert json.loads((results / "scene.json").read_text())["terrain"]["resistance"]
    assert (results / "Inputs" / "dem.asc").is_file()  # AvaFrame's pictures need it


def test_maps_have_the_format_and_reference_system_of_the_terrain(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    project = write_project(tmp_path / "project", "tEnd = 0.06\n")
    (project / "Inputs/dem.asc").unlink()
    raster = plane()
    rows, columns = raster.heights.shape
    with rasterio.open(
        project / "Inputs/dem.tif", "w", driver="GTiff", height=rows, width=columns, count=1,
        dtype="float32", crs="EPSG:31287", transform=rasterio.Affine(2, 0, -1, 0, -2, 59),
    ) as target:  # fmt: skip
        target.write(raster.heights[::-1].astype(np.float32), 1)
    out = run(project, tmp_path / "out")
    (file,) = out.glob("Outputs/com1DFA/peakFiles/*_pft.tif")
    with rasterio.open(file) as written:
        assert written.crs.to_epsg() == 31287
        assert tuple(written.transform)[:6] == (2, 0, -1, 0, -2, 59)
        assert written.read(1)[::-1] == pytest.approx(read_raster(out / "peaks/pft.asc").heights)
    assert "MGI_Austria_Lambert" in (out / "peaks/pft.prj").read_text()


def test_maps_of_the_changed_ground_are_written_on_request(tmp_path):
    ini = "tEnd = 1.5\nadaptSfcEntrainment = 1\nthresholdAdaptSfc = 0\nentEroEnergy = 50\n"
    ini += "resType = sfcChange|demAdapted\nsimTypeList = ent\n"
    project = write_project(tmp_path / "project", ini)
    write_polygons(project / "Inputs/ENT/ent.geojson", box(31, 5, 60, 35), thickness=0.4)
    out = run(project, tmp_path / "out")
    change, terrain = (
        read_raster(next(out.glob(f"Outputs/com1DFA/peakFiles/*_{kind}.asc"))).heights
        for kind in ("sfcChange", "demAdapted")
    )
    assert change.min() < -1e-3
    assert change.max() == 0.0
    np.testing.assert_allclose(terrain, plane().heights + change, atol=1e-4)
    (settings,) = out.glob("Outputs/com1DFA/configurationFiles/*_ent_ssl.ini")
    assert "adaptSfcEntrainment = 1\n" in settings.read_text()


READ_BY_AVAFRAME = """
import json, pathlib, sys
import matplotlib
matplotlib.use("Agg")
from avaframe.in3Utils import cfgUtils, fileHandlerUtils
from avaframe.out1Peak import outPlotAllPeak
project = pathlib.Path(sys.argv[1])
flags = cfgUtils.getGeneralConfig()["FLAGS"]
tables = {}
for module in ("com1DFA", "com5SnowSlide"):
    table, kinds = fileHandlerUtils.makeSimFromResDF(project, module)
    settings = cfgUtils.createConfigurationInfo(project, comModule=module)
    pictures = outPlotAllPeak.plotAllPeakFields(project, flags, module)
    tables[module] = [sorted(table["simName"]), sorted(settings["simName"]), sorted(pictures),
                      sorted(kinds), sorted(table["releaseArea"])]
print("TABLES" + json.dumps(tables))
"""


def test_avaframe_reads_the_results(results):
    python = os.environ.get("SNOWSHED_AVAFRAME_PYTHON")
    if not python:
        pytest.skip("SNOWSHED_AVAFRAME_PYTHON names no Python with AvaFrame")
    done = subprocess.run(
        [python, "-c", READ_BY_AVAFRAME, str(results)], capture_output=True, text=True, check=True
    )
    for module, tables in json.loads(done.stdout.rpartition("TABLES")[2]).items():
        names, settings, pictures, kinds, releases = tables
        assert len(names) == 4, module
        assert names == settings == pictures
        assert kinds == ["FT", "pft", "pfv", "ppr"]
        assert releases == ["rel", "rel", "up_hill", "up_hill"]
