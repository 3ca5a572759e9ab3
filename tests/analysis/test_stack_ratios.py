import shutil

import pandas as pd
import pytest

from snowshed import InputError, Scene
from snowshed.analysis import dimension_ratio
from snowshed.analysis.stack_ratios import compare_folders
from snowshed.cli.main import main


def heights(*values):
    return pd.DataFrame({"event": range(1, len(values) + 1), "height_m": values, "other": 0})


def test_ratios_cover_the_events_of_both_runs():
    table = dimension_ratio(heights(0.2, 0.3), heights(0.4, 0.4, 0.5))
    assert list(table.columns) == ["event", "height_3d_m", "height_2d_m", "ratio"]
    assert list(table.ratio) == pytest.approx([0.5, 0.75])


@pytest.fixture
def pair(tmp_path):
    """Folders that look like a 3D and a 2D run."""
    for dimension, values in ((3, (0.2, 0.3)), (2, (0.4, 0.4))):
        folder = tmp_path / f"{dimension}d"
        folder.mkdir()
        Scene.preset("lab-50").set("dimension", dimension).resolve().save(folder / "scene.json")
        heights(*values).to_csv(folder / "events.csv", index=False)
    return tmp_path / "3d", tmp_path / "2d"


def test_folders_in_either_order(pair):
    pd.testing.assert_frame_equal(compare_folders(*pair), compare_folders(*pair[::-1]))


def test_two_runs_of_the_same_dimension_are_refused(pair, tmp_path):
    shutil.copytree(pair[0], tmp_path / "other")
    with pytest.raises(InputError, match="both 3D"):
        compare_folders(pair[0], tmp_path / "other")


def test_the_command_compares_runs_of_the_same_dimension(pair, tmp_path, capsys):
    shutil.copytree(pair[0], tmp_path / "other")
    assert main(["compare", str(pair[0]), str(tmp_path / "other")]) == 0
    assert "1.00" in capsys.readouterr().out


def test_command(pair, capsys, tmp_path):
    assert main(["compare", str(pair[0]), str(pair[1])]) == 0
    shown = capsys.readouterr().out
    assert "0.50" in shown and "0.75" in shown and "0.67" in shown
    assert main(["compare", str(pair[0]), str(tmp_path / "none")]) == 2
