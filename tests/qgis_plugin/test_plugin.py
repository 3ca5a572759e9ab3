"""The QGIS plugin: its metadata, command lines, processes and styles, and, with QGIS, its runs."""

import configparser
import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest
from helpers.paths import ROOT
from tools import qgis_styles

import snowshed
from snowshed.cli.commands.release_areas import release_areas
from snowshed.cli.commands.slide import slide
from snowshed.io.raster.output import write_raster
from snowshed.plot.slide_figure import PEAKS
from snowshed.scene.builders.hillside import hillside

PLUGIN = ROOT / "qgis" / "snowshed_qgis"
SYSTEM_PYTHON = "/usr/bin/python3"


def module(name):
    """Import a module of the plugin that needs no QGIS."""
    spec = importlib.util.spec_from_file_location(f"plugin_{name}", PLUGIN / f"{name}.py")
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = loaded
    spec.loader.exec_module(loaded)
    return loaded


commands, process = module("command_lines"), module("process")


class Feedback:
    """Records what the plugin shows; cancels after a number of questions."""

    def __init__(self, patience=10**9):
        self.patience, self.progress, self.texts = patience, [], []

    def isCanceled(self):  # noqa: N802
        self.patience -= 1
        return self.patience < 0

    def setProgress(self, progress):  # noqa: N802
        self.progress.append(progress)

    def pushInfo(self, info):  # noqa: N802
        self.texts.append(info)


# --- metadata, archive, styles ------------------------------------------------------------------


def test_the_metadata_are_complete():
    parser = configparser.ConfigParser()
    parser.read(PLUGIN / "metadata.txt", encoding="utf-8")
    general = parser["general"]
    for key in ("name", "qgisMinimumVersion", "description", "about", "author", "email"):
        assert general[key]
    assert general["version"] == snowshed.__version__
    assert general["hasProcessingProvider"] == "yes"


def test_the_archive_holds_the_plugin_alone(tmp_path):
    archive = tmp_path / "plugin.zip"
    code = [sys.executable, "-m", "tools.qgis_archive", str(archive)]
    subprocess.run(code, cwd=ROOT, check=True)
    names = zipfile.ZipFile(archive).namelist()
    assert {name.split("/")[0] for name in names} == {"snowshed_qgis"}
    sources = [f for f in PLUGIN.rglob("*") if f.is_file() and "__pycache__" not in f.parts]
    assert sorted(names) == sorted(f.relative_to(PLUGIN.parent).as_posix() for f in sources)


@pytest.mark.parametrize("quantity", qgis_styles.CLASSES)
def test_the_styles_have_the_colours_of_the_pictures(quantity):
    import matplotlib as mpl

    name = qgis_styles.CLASSES[quantity][0]
    text = (PLUGIN / "styles" / f"{name}.qml").read_text(encoding="utf-8")
    assert text == qgis_styles.style(quantity)  # `python -m tools.qgis_styles` writes it
    first, *items = ET.fromstring(text).iter("item")
    assert first.get("alpha") == "0"
    darkest = mpl.colors.to_hex(mpl.colormaps[PEAKS[quantity][1]](1.0))
    assert items[-1].get("color") == darkest
    values = [float(item.get("value")) for item in items]
    assert values == sorted(values) and values[-1] == float("inf")


def test_every_loaded_map_has_a_style():
    assert {style for _, style, _ in commands.MAPS} == {f.name for f in PLUGIN.glob("styles/*")}


# --- command lines ------------------------------------------------------------------------------


def parsed(command, arguments):
    """Return the options that the command line of snowshed understands."""
    return command.make_context("test", list(arguments)).params


def test_the_command_line_of_a_slide_is_understood():
    forest = commands.Polygons("wood.gpkg", "pines")
    words = commands.slide_command(
        "dem.tif", commands.Polygons("a b.gpkg", "a"), "out", thickness=0.5, friction=0.4,
        turbulence=2000.0, resistance=forest, further="--max-time 8 --columns 'across_flow'",
        program="/opt/snowshed",
    )  # fmt: skip
    assert words[:2] == ["/opt/snowshed", "slide"]
    options = parsed(slide, words[2:])
    expected = {
        "terrain": Path("dem.tif"), "release": Path("a b.gpkg"), "layer": "a", "thickness": 0.5,
        "friction": 0.4, "turbulence": 2000.0, "resistance_areas": Path("wood.gpkg"),
        "resistance_layer": "pines", "map_format": "geotiff", "max_time": 8.0,
        "columns": "across_flow", "folder": Path("out"),
    }  # fmt: skip
    assert {key: options[key] for key in expected} == expected


def test_what_is_not_given_has_the_default_of_the_program():
    words = commands.slide_command("dem.asc", commands.Polygons("a.shp"), "out")
    options = parsed(slide, words[2:])
    for name in ("thickness", "friction", "turbulence", "resistance_areas", "layer"):
        assert options[name] is None


def test_the_command_line_of_release_areas_is_understood():
    words = commands.release_areas_command(
        "dem.tif", "a.gpkg", slopes=(30.0, 55.5), smallest=1e6, gap=100.0, sectors=4,
        thickness=0.7, forest=commands.Polygons("wood.shp"), further="--cell 5",
    )  # fmt: skip
    options = parsed(release_areas, words[2:])
    expected = {
        "slope": "30:55.5", "min_area": 1e6, "max_gap": 100.0, "sectors": 4, "thickness": 0.7,
        "forest": Path("wood.shp"), "cell": 5.0, "file": Path("a.gpkg"),
    }  # fmt: skip
    assert {key: options[key] for key in expected} == expected


# --- processes ----------------------------------------------------------------------------------


def program(tmp_path, code):
    """Write a program for tests; return its command line."""
    file = tmp_path / "program.py"
    file.write_text(code)
    return [sys.executable, str(file)]


def test_progress_notes_and_output_are_shown(tmp_path):
    code = (
        "import sys, time\n"
        "for share in (10, 55, 100):\n"
        "    sys.stderr.write(f'\\x1b[2K\\rrelease ━━━ {share}%'); sys.stderr.flush()\n"
        "    time.sleep(0.1)\n"
        "print('\\nnote: steps were divided', file=sys.stderr)\n"
        "print('\\x1b[1mSnow slide\\x1b[0m')\n"
    )
    feedback = Feedback()
    assert process.run_program(program(tmp_path, code), feedback) == "Snow slide"
    assert feedback.progress == [10.0, 55.0, 100.0]
    assert "note: steps were divided" in feedback.texts


def test_an_error_is_the_message_of_the_program(tmp_path):
    code = "import sys; print('error: --tilt: 95', file=sys.stderr); sys.exit(2)"
    with pytest.raises(process.ProgramError, match=r"^error: --tilt: 95$"):
        process.run_program(program(tmp_path, code), Feedback())


def test_a_missing_program_says_how_to_install_it():
    with pytest.raises(process.ProgramError, match="/nowhere: No such file or directory; install"):
        process.run_program(["/nowhere"], Feedback())


def test_much_output_on_both_streams_does_not_block(tmp_path):
    code = "import sys; sys.stderr.write('x' * 10**6); sys.stdout.write('y' * 10**6)"
    assert process.run_program(program(tmp_path, code), Feedback()) == "y" * 10**6


def test_a_cancelled_program_is_interrupted_and_may_clean_up(tmp_path):
    mark = tmp_path / "interrupted"
    code = (
        "import pathlib, time\n"
        "try:\n    time.sleep(60)\n"
        f"except KeyboardInterrupt:\n    pathlib.Path({str(mark)!r}).touch()\n"
    )
    begin = time.monotonic()
    with pytest.raises(process.ProgramError, match="cancelled"):
        process.run_program(program(tmp_path, code), Feedback(patience=8))
    assert mark.exists() and time.monotonic() - begin < 30.0


def test_the_progress_of_snowshed_itself_is_read(tmp_path):
    main = "import sys; from snowshed.cli.main import main; sys.exit(main(sys.argv[1:]))"
    words = ["slide", "--example", "--max-time", "40", "-o", str(tmp_path / "out")]
    feedback = Feedback()
    process.run_program([sys.executable, "-c", main, *words], feedback)
    assert len(feedback.progress) > 1
    assert feedback.progress == sorted(feedback.progress) and feedback.progress[-1] == 100.0
    assert "Snow slide" in feedback.texts[-1]


# --- QGIS ---------------------------------------------------------------------------------------


def has_qgis():
    """Return whether the system's Python has QGIS."""
    if not Path(SYSTEM_PYTHON).exists():
        return False
    done = subprocess.run([SYSTEM_PYTHON, "-c", "import qgis.core"], capture_output=True)
    return done.returncode == 0


def test_qgis_runs_both_algorithms(tmp_path):
    if not has_qgis():
        pytest.skip("QGIS is not installed (python3-qgis)")
    pytest.importorskip("rasterio")
    ground = hillside()
    write_raster(
        tmp_path / "dem.tif",
        type(ground)(ground.heights, ground.east, ground.north, ground.cell, crs="EPSG:31287"),
    )
    starter = tmp_path / "snowshed"
    starter.write_text(
        f"#!{sys.executable}\nimport sys\nfrom snowshed.cli.main import main\nsys.exit(main())\n"
    )
    starter.chmod(0o755)
    results = tmp_path / "results"
    results.mkdir()
    script = ROOT / "tests" / "qgis_plugin" / "headless.py"
    done = subprocess.run(
        [SYSTEM_PYTHON, script, PLUGIN.parent, tmp_path / "dem.tif", results, starter],
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True, text=True, timeout=300, start_new_session=True,
    )  # fmt: skip
    lines = [line[6:] for line in done.stdout.splitlines() if line.startswith("FACTS ")]
    assert lines, (signal.Signals(-done.returncode) if done.returncode < 0 else "", done.stderr)
    facts = json.loads(lines[0])
    assert facts["algorithms"] == ["snowshed:release_areas", "snowshed:slide"]
    assert facts["release_areas"][0] and facts["release_areas"][1] >= 1
    assert facts["slide"] == [True, 100.0]
    assert facts["refused"] == [False, True]
    assert set(facts["layers"]) == {title for _, _, title in commands.MAPS}
    for quantity, (_, unit, ends) in qgis_styles.CLASSES.items():
        title = next(t for t in facts["layers"] if t.startswith(quantity.replace("_", " ")))
        crs, items = facts["layers"][title]
        assert crs == "EPSG:31287"
        assert [item[0] for item in items] == [*ends, float("inf")]
        assert [item[1] for item in items[1:]] == qgis_styles.colours(quantity)
        assert items[-1][2] == f"above {ends[-1]:g} {unit}"
    for name in ("peak speed", "peak thickness", "peak pressure"):
        assert (results / f"{name}.png").stat().st_size > 1000
