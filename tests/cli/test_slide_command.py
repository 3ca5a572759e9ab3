"""``snowshed slide`` with ranges, and its pages."""

import json

import pytest
from helpers.pages import Page
from plot.browser import check_page

from snowshed.cli.main import main
from snowshed.io.raster.raster import read_raster


def snowshed(*arguments: object) -> int:
    return main([str(argument) for argument in arguments])


def test_ranges_give_maps_page_and_summary_and_are_resumed(tmp_path, capsys):
    command = ("slide", "--example", "--max-time", 1.0, "--range", "mu=0.3:0.5",
               "--range", "thickness=0.4:0.6", "--runs", 2, "--jobs", 1,
               "-o", tmp_path / "maps")  # fmt: skip
    assert snowshed(*command, "--dry-run") == 0
    assert "2 runs" in capsys.readouterr().out and not (tmp_path / "maps").exists()
    assert snowshed(*command) == 0
    facts = json.loads((tmp_path / "maps/hazard.json").read_text())
    assert facts["runs"] == 2 and list(facts["ranges"]) == [
        "numerics.friction", "terrain.release.0.thickness",
    ]  # fmt: skip
    folder = tmp_path / "maps"
    low, middle, high = (
        read_raster(folder / f"probability/pft_above_0.1m{end}.asc").heights
        for end in ("_low", "", "_high")
    )
    assert (low <= middle + 1e-12).all() and (middle <= high + 1e-12).all() and middle.max() == 1
    page = Page((folder / "hazard.html").read_text())
    assert all(source.startswith("data:") for source in page.sources)
    assert any("Of 2 slides" in text for text in page.text)
    store = (folder / "runs/store.sqlite").read_bytes()
    assert snowshed(*command) == 0  # nothing is computed again
    assert len(store) == (folder / "runs/store.sqlite").stat().st_size


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("mux=1:2", "'mux' is none of mu, xi, E, thickness"),
        ("mu=0.3", "not of the form NAME=LOW:HIGH"),
        ("mu=0.5:0.3", "the upper end 0.3 is not above the lower end 0.5"),
        ("mode=0:1", "'mode' is none of"),
        ("cell=1:4", "'cell' is none of"),
    ],
)
def test_wrong_ranges_are_refused_and_leave_no_files(tmp_path, capsys, option, message):
    assert snowshed("slide", "--example", "--range", option, "-o", tmp_path / "maps") == 2
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_impossible_sample_is_refused_and_leaves_no_files(tmp_path, capsys):
    command = ("slide", "--example", "--range", "mu=0.3:0.5", "--sampling", "sobol", "--runs", 5)
    assert snowshed(*command, "-o", tmp_path / "maps") == 2
    assert "5 is not a power of two" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_the_page_of_a_slide_is_self_contained_and_has_its_notes(tmp_path, capsys):
    assert snowshed("slide", "--example", "--max-time", 1.0, "-o", tmp_path / "out") == 0
    note = "was still moving at the time limit"
    assert note in capsys.readouterr().err
    assert note in json.loads((tmp_path / "out/slide.json").read_text())["notes"][-1]
    html = (tmp_path / "out/slide.html").read_text()
    page = Page(html)
    assert note in html and "://" not in html
    assert all(source.startswith("data:") for source in page.sources)
    assert ["slab", "0.5"] in [row[:2] for row in page.rows]
    assert ["friction", "0.325"] in [row[:2] for row in page.rows]


def test_the_pages_are_readable_on_telephone_and_screen(tmp_path):
    assert snowshed("slide", "--example", "--max-time", 1.0, "-q", "-o", tmp_path / "out") == 0
    check_page(tmp_path / "out/slide.html")
    ranges = ("--range", "mu=0.3:0.5", "--runs", 2, "--jobs", 1, "-q")
    command = ("slide", "--example", "--max-time", 1.0, *ranges, "-o", tmp_path / "maps")
    assert snowshed(*command) == 0
    check_page(tmp_path / "maps/hazard.html")
