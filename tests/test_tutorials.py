"""The tutorials in docs/start/tutorials: their cells run, with the results in their text."""

import json
from pathlib import Path
from typing import Any

import matplotlib
import pytest

FOLDER = Path(__file__).parents[1] / "docs" / "start" / "tutorials"


@pytest.fixture
def run_notebook(tmp_path, monkeypatch):
    """Return a function that runs the cells of a tutorial, and returns their names."""
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)

    def run(name: str) -> dict[str, Any]:
        names: dict[str, Any] = {}
        cells = json.loads((FOLDER / name).read_text(encoding="utf-8"))["cells"]
        for number, cell in enumerate(cells):
            if cell["cell_type"] == "code":
                code = compile("".join(cell["source"]), f"{name}, cell {number}", "exec")
                exec(code, names)  # the tutorials are ours
        return names

    yield run
    matplotlib.pyplot.close("all")


def test_a_first_stack(run_notebook, capsys):
    names = run_notebook("first-stack.ipynb")
    assert "unknown key; allowed: height" in capsys.readouterr().out
    spread = names["spread"]["height_m"]
    assert (spread["std"] < 0.3 * spread["mean"]).all()


def test_a_snow_slide(run_notebook):
    names = run_notebook("snow-slide.ipynb")
    broken = [row["bonds broken, %"] for row in names["rows"]]
    assert broken[0] > broken[-1]


def test_the_strength_of_snow(run_notebook):
    names = run_notebook("strength-of-snow.ipynb")
    assert names["again"].mean_stress_5_10_pa > names["summary"].mean_stress_5_10_pa


def test_every_tutorial_has_a_test_and_an_entry_in_the_contents():
    tutorials = sorted(file.stem for file in FOLDER.glob("*.ipynb"))
    assert tutorials == ["first-stack", "snow-slide", "strength-of-snow"]
    contents = (FOLDER / "index.md").read_text(encoding="utf-8")
    assert all(f"\n{name}\n" in contents for name in tutorials)
