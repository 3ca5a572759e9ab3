"""Scenes of version 1, whose "slip" is now "separate"."""

import json

import pytest
from conftest import tiny_scene

from snowshed import MpmSettings, Obstacle, Scene, Shape, _core
from snowshed.cli.main import main
from snowshed.scene.scene import ResolvedScene
from snowshed.scene.schema import with_current_names
from snowshed.study.scene_hash import RunKey, content_hash

OLD = {
    "snowshed": 1,
    "dimension": 2,
    "panel": {"height": 0.33, "length": 0.245, "tilt": 50, "condition": "slip"},
    "slab": {"thickness": 0.02},
}


@pytest.fixture
def old_file(tmp_path):
    file = tmp_path / "old.json"
    file.write_text(json.dumps(OLD))
    return file


def test_slip_of_version_1_is_read_as_separate_with_a_note(old_file):
    with pytest.warns(FutureWarning, match='"slip" of version 1 is read as "separate"'):
        data = ResolvedScene.load(old_file).data
    assert (data["snowshed"], data["panel"]["condition"]) == (2, "separate")
    with pytest.warns(FutureWarning, match="/panel/condition"):
        assert Scene.load(old_file).resolve().data == data


def test_the_command_line_prints_this_note(old_file, capsys):
    assert main(["plan", str(old_file)]) == 0
    lines = capsys.readouterr().err.splitlines()
    (note,) = [line for line in lines if "/panel/condition" in line]
    assert note.startswith(f"note: {old_file}: /panel/condition: ")


@pytest.mark.filterwarnings("error")
def test_slip_of_version_2_stays_slip_with_a_note(tmp_path):
    scene = tiny_scene().set("panel.condition", "slip")
    with pytest.warns(FutureWarning, match='use "separate" for the behaviour of version 1'):
        resolved = scene.resolve()
    assert resolved.data["panel"]["condition"] == "slip"
    resolved.save(tmp_path / "new.json")
    assert ResolvedScene.load(tmp_path / "new.json") == ResolvedScene(resolved.json, str(tmp_path))
    with pytest.warns(FutureWarning, match='use "separate" for the behaviour of version 1'):
        tiny_scene().append(
            "obstacles", Obstacle(shape=Shape.sphere((9, 0), 1), condition="slip")
        ).resolve()


def test_runs_stored_with_version_1_have_the_same_hash():
    present = RunKey.of(tiny_scene().resolve())
    data = json.loads(present.scene)
    assert data["panel"]["condition"] == "separate"
    old = {**data, "snowshed": 1, "panel": {**data["panel"], "condition": "slip"}}
    assert content_hash(old) == present.hash
    # "separate" of version 1 and the present "slip" give other runs.
    hashes = {present.hash}
    for version, condition in ((1, "separate"), (2, "slip"), (2, "sticky")):
        changed = {**data, "snowshed": version}
        hashes.add(content_hash({**changed, "panel": {**data["panel"], "condition": condition}}))
    assert len(hashes) == 4
    assert with_current_names(old) == data


def test_damping_rate_and_flip_ratio_exclude_each_other():
    with pytest.raises(_core.InputError, match="takes the place of flip_ratio; give one"):
        MpmSettings(flip_ratio=0.9, damping_rate=50.0)
    both = {"flip_ratio": 0.9, "damping_rate": 50.0}
    with pytest.raises(_core.InputError, match="/numerics/damping_rate: takes the place"):
        Scene().update({"numerics": both})
    with pytest.raises(_core.InputError, match="/numerics/damping_rate: takes the place"):
        Scene.from_data({"numerics": both})


def test_the_last_of_flip_ratio_and_damping_rate_applies():
    scene = Scene.preset("lab-50").set("numerics.damping_rate", 50.0)
    numerics = scene.resolve().data["numerics"]
    assert numerics["damping_rate"] == 50.0 and "flip_ratio" not in numerics
    numerics = scene.set("numerics.flip_ratio", 0.95).resolve().data["numerics"]
    assert numerics["flip_ratio"] == 0.95 and "damping_rate" not in numerics
    assert MpmSettings(damping_rate=0.0).to_data() == {"damping_rate": 0.0}
