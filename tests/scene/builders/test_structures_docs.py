"""The scripts in the documentation of seasons, relations and structures run."""

import re

import numpy as np
from helpers.paths import DOCS

GUIDES = DOCS / "guides"


def scripts(page):
    return re.findall(r"^```python\n(.*?)^```", (GUIDES / page).read_text(), re.M | re.S)


def test_the_script_that_draws_and_saves_a_roof(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(scripts("structures.md")[0], {})
    assert (tmp_path / "roof.png").stat().st_size > 10_000
    assert (tmp_path / "roof.json").is_file()


def test_the_script_that_puts_a_panel_on_terrain(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    heights = np.tile(-0.3 * np.arange(60.0), (60, 1))
    header = "ncols 60\nnrows 60\nxllcorner 2600090\nyllcorner 1200185\ncellsize 1\n"
    rows = "\n".join(" ".join(f"{z:.2f}" for z in row) for row in heights)
    (tmp_path / "hill.asc").write_text(header + rows + "\n")
    variables = {}
    exec(scripts("structures.md")[1], variables)
    assert variables["scene"].resolve().data["obstacles"][0]["name"] == "terrain"


def test_the_script_on_relations(capsys):
    exec(scripts("../methods/snow-relations.md")[0], {})
    assert "density 90 kg/m3 (110 to 363)" in capsys.readouterr().out
