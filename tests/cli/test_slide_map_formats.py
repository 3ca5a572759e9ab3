"""``snowshed slide --map-format`` and ``snowshed maps``: the same maps in other formats."""

import json
import sys

import numpy as np
import pytest

import snowshed
from snowshed import InputError, Results, Scene
from snowshed.cli.main import main
from snowshed.results import write_maps

rasterio = pytest.importorskip("rasterio")
xarray = pytest.importorskip("xarray")

pytestmark = [
    pytest.mark.usefixtures("undrawn"),
    pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote"),
]
STEMS = ("peaks/pft", "peaks/pfv", "peaks/ppr", "flow/FT", "flow/FV")


def slide(*arguments):
    return main(["slide", "--example", "--max-time", "1", "-q", *map(str, arguments)])


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Return the results of a slide with maps as text and as GeoTIFF."""
    base = tmp_path_factory.mktemp("slides")
    for form in ("ascii", "geotiff"):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("snowshed.methods.slide.run.SlideRun.draw", lambda _: None)
            assert slide("-o", base / form, "--map-format", form) == 0
    return base


def test_the_maps_are_the_same_up_to_the_digits_of_the_text(folders):
    text, binary = (Results(folders / form).maps for form in ("ascii", "geotiff"))
    for name in binary.data_vars:
        np.testing.assert_allclose(binary[name], text[name], rtol=1e-8)
    assert binary.peak_speed.max() > 1.0
    for stem in STEMS:
        assert (folders / f"geotiff/{stem}.tif").is_file()
        assert not (folders / f"geotiff/{stem}.asc").exists()
        assert not (folders / f"ascii/{stem}.tif").exists()


def test_a_geotiff_holds_the_maps_of_the_simulation_exactly(folders):
    simulation = snowshed.Simulation(Scene.load(folders / "geotiff/scene.json"))
    simulation.begin_event()
    simulation.run(until="rest")
    stored, present = Results(folders / "geotiff").maps, simulation.maps
    for name in present.data_vars:
        assert stored[name].to_numpy().tobytes() == present[name].to_numpy().tobytes()


def test_a_resumed_run_replaces_the_maps_of_the_other_format(tmp_path):
    assert slide("-o", tmp_path / "out", "--map-format", "geotiff") == 0
    assert main(["slide", "--resume", "-o", str(tmp_path / "out"), "-q"]) == 0
    assert (tmp_path / "out/peaks/pft.asc").is_file()
    assert not (tmp_path / "out/peaks/pft.tif").exists()


def test_probabilities_have_the_format_too(tmp_path):
    options = ["--range", "mu=0.3:0.5", "--runs", "2", "--map-format", "geotiff"]
    assert slide("-o", tmp_path / "maps", *options) == 0
    names = {file.suffix for file in (tmp_path / "maps/probability").iterdir()}
    assert names == {".tif"}
    with rasterio.open(tmp_path / "maps/percentiles/pft_p95.tif") as file:
        assert 0.4 < file.read(1).max() < 1.0


def test_without_rasterio_nothing_runs(folders, tmp_path, monkeypatch, capsys):
    scene = Scene.load(folders / "ascii/scene.json")
    monkeypatch.setitem(sys.modules, "rasterio", None)
    assert slide("-o", tmp_path / "out", "--map-format", "geotiff") == 2
    assert "needs rasterio" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError, match="needs rasterio"):
        snowshed.run(scene, tmp_path / "out", map_format="geotiff")


def test_a_method_without_maps_has_no_format_of_maps(tmp_path):
    with pytest.raises(InputError, match='map_format: the method "mpm" has no maps'):
        snowshed.run(Scene.preset("lab-50"), tmp_path / "out", map_format="geotiff")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", ["ascii", "geotiff"])
def test_the_netcdf_is_the_dataset_of_the_maps(folders, form, capsys):
    assert main(["maps", str(folders / form), "-o", str(folders / f"{form}.nc")]) == 0
    assert f"{form}.nc: " in capsys.readouterr().out
    maps = Results(folders / form).maps
    with xarray.open_dataset(folders / f"{form}.nc", decode_coords="all") as again:
        xarray.testing.assert_equal(again.load(), maps)
        assert again.peak_pressure.attrs["units"] == "kPa"
        assert again.attrs["title"] == "Slide on an example slope"
        assert json.loads(again.attrs["scene"])["method"] == "slide"


def test_the_file_has_a_place_of_its_own(folders):
    assert main(["maps", str(folders / "ascii"), "-q"]) == 0
    assert (folders / "ascii/maps.nc").is_file()
    assert write_maps(folders / "ascii", folders / "b.nc4") == folders / "b.nc4"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "nowhere: no results"),
        (["ascii", "-o", "a.tif"], "a.tif: not the name of a NetCDF file"),
    ],
)
def test_bad_input_is_refused(folders, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(folders)
    assert main(["maps", *arguments]) == 2
    assert message in capsys.readouterr().err
