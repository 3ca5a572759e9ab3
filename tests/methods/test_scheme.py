import json

import pytest

from snowshed import InputError, MpmSettings, Scene, Study
from snowshed.cli.main import main


def numerics(scene):
    return scene.resolve().data["numerics"]


def test_a_scheme_overrides_the_settings_of_a_preset():
    """A preset states all settings, which would contradict another scheme."""
    scene = Scene.preset("lab-50").set("numerics.scheme", "objective")
    settings = numerics(scene)
    assert (settings["transfer"], settings["damping_rate"], settings["contact"]) == (
        "affine_flip",
        380.0,
        "touch",
    )
    assert numerics(scene.set("numerics.scheme", "thesis")) == numerics(Scene.preset("lab-50"))


def test_a_scheme_overrides_earlier_settings():
    slower = Scene.preset("lab-50").set("numerics.damping_rate", 95.0)
    assert numerics(slower.set("numerics.scheme", "objective"))["damping_rate"] == 380.0


@pytest.mark.parametrize("order", [1, -1])
def test_a_scheme_and_settings_may_be_given_in_any_order(order):
    given = {"numerics.scheme": "objective", "numerics.damping_length": 0.02}
    scene = Scene.preset("lab-50").update(dict(list(given.items())[::order]))
    assert numerics(scene)["damping_length"] == 0.02
    data = {"scheme": "objective", "damping_length": 0.02}
    settings = MpmSettings.from_data(dict(list(data.items())[::order]))
    assert settings == MpmSettings(damping_length=0.02, scheme="objective")


@pytest.mark.parametrize("order", [1, -1])
def test_a_scheme_and_factors_of_a_study_may_be_given_in_any_order(order):
    factors = {"numerics.scheme": ["objective"], "numerics.damping_length": [0.02]}
    study = Study.product(Scene.preset("lab-50"), dict(list(factors.items())[::order]))
    (run,) = study.runs()
    assert json.loads(run.scene)["numerics"]["damping_length"] == 0.02


def test_setting_the_same_scheme_again_changes_nothing():
    scene = Scene.preset("lab-50").set("numerics.flip_ratio", 0.95)
    assert numerics(scene.set("numerics.scheme", "thesis"))["flip_ratio"] == 0.95


def test_a_mechanism_that_contradicts_the_scheme_is_an_error():
    scene = Scene.preset("lab-50")
    scene.update({"numerics.scheme": "objective", "numerics.transfer": "flip"})
    with pytest.raises(InputError, match="/numerics/transfer"):
        scene.resolve()


def test_the_command_takes_a_scheme(tmp_path, capsys):
    coarse = ["--dim", "2", "--dx", "0.02", "--events", "1"]
    command = ["panel", "--preset", "lab-50", *coarse, "--scheme", "objective"]
    assert main([*command, "-o", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr()
    assert "damping 380 1/s over 0.01 m" in " ".join(shown.out.split())
    assert "lab-50 in 2D, event 1, scheme objective" in shown.err
