import json
from dataclasses import replace

import pytest

from snowshed import InputError, Scene
from snowshed.cli.main import main
from snowshed.cli.options.accuracy import choose
from snowshed.cli.options.scene import option_name
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.schema import scene_parameters
from snowshed.snow.accuracy import recorded
from snowshed.snow.accuracy.measurements import Measured, MeasuredSolution
from snowshed.snow.accuracy.recorded import load_recorded, record
from snowshed.snow.accuracy.recorded_stacks import CASE, QUANTITIES

THICKNESS = 0.02  # of the laboratory's slab, m


def stack(dx, height, length, wall, *, spread=None, **settings):
    """Return a recorded stack with these relative errors."""
    measured = [Measured("height", 0.1, 0.1, height), Measured("length", 0.3, 0.3, length)]
    if spread is not None:
        measured += [Measured(f"{name}_spread", spread, 0.0, spread) for name in QUANTITIES]
    settings = {"dimension": 2, "events": 5, "dx": dx, "transfer": "flip", **settings}
    return MeasuredSolution(CASE, settings, measured, wall_s=wall)


RECORDED = [
    stack(0.02, 0.15, 0.25, 1.0, spread=0.05),
    stack(0.01, 0.08, 0.09, 8.0, spread=0.04),
    stack(0.005, 0.03, 0.06, 60.0, spread=0.03),
    stack(0.02, 0.30, 0.10, 2.0, transfer="apic"),
    stack(0.01, 0.09, 0.04, 7.0, transfer="apic"),
    stack(0.005, 0.02, 0.04, 90.0, transfer="apic", basis="cubic"),
]


def scene_with(**values):
    return Scene.preset("lab-50").update({"dimension": 2, **values})


def test_the_quickest_sufficient_settings_are_chosen():
    for wanted, dx, transfer, basis in (
        (0.30, 0.02, "flip", None),
        (0.10, 0.01, "apic", None),
        (0.06, 0.005, "flip", None),
        (0.04, 0.005, "apic", "cubic"),
    ):
        choice = choose(wanted, scene_with(), RECORDED)
        assert choice.reached
        assert choice.values["numerics.dx"] == dx
        assert choice.values["numerics.transfer"] == transfer
        assert choice.values["numerics.basis"] == basis


def test_cells_are_relative_to_the_slab():
    thick = scene_with(**{"slab.thickness": 0.5})
    choice = choose(0.1, thick, RECORDED)
    assert choice.values["numerics.dx"] == pytest.approx(0.5 * 0.01 / THICKNESS)
    assert "dx 0.25 m (0.5 of the slab's thickness) with scheme thesis, apic." in choice.reason


def test_the_reason_names_the_choice_and_its_errors():
    reason = choose(0.06, scene_with(), RECORDED).reason
    assert reason == (
        "--accuracy 6 %: dx 0.005 m (0.25 of the slab's thickness) with scheme thesis, flip. These "
        "were the quickest in the recorded runs of lab-50 to stay within it: the height of the "
        "stack was off by 3 % and its length by 6 %, relative to the finest recorded grid of the "
        "scheme. Random seedings alone made them differ by 3 % and 3 %."
    )


def test_the_reason_names_an_accuracy_that_no_run_reached():
    choice = choose(0.01, scene_with(), RECORDED)
    assert not choice.reached
    assert choice.values["numerics.basis"] == "cubic"
    assert choice.reason.startswith(
        "--accuracy 1 %: no recorded run of lab-50 was that accurate. The best is dx 0.005 m"
    )
    assert "off by 2 % and its length by 4 %, relative to the finest" in choice.reason
    assert "--accuracy 4% chooses this grid." in choice.reason


def objective(dx, height, length, wall, **settings):
    """Return a recorded stack of the scheme objective, timed on another processor."""
    recorded_stack = stack(dx, height, length, wall, scheme="objective", **settings)
    settings_by_name = {
        name: value for name, value in recorded_stack.settings.items() if name != "transfer"
    }
    return replace(recorded_stack, settings=settings_by_name, machine="another")


OBJECTIVE = [objective(0.01, 0.05, 0.05, 20.0), objective(0.005, 0.03, 0.03, 150.0)]


@pytest.mark.parametrize(
    ("wanted", "scheme", "dx"),
    [(0.10, None, 0.01), (0.05, "objective", 0.01), (0.03, "objective", 0.005)],
)
def test_the_cheaper_scheme_is_chosen(wanted, scheme, dx):
    choice = choose(wanted, scene_with(), [*RECORDED[:5], *OBJECTIVE])
    assert choice.reached
    assert (choice.values["numerics.scheme"], choice.values["numerics.dx"]) == (scheme, dx)


def test_the_reason_compares_the_schemes():
    recorded_runs = [*RECORDED[:5], *OBJECTIVE]
    quicker = choose(0.07, scene_with(), recorded_runs).reason
    assert "with scheme objective. These were the quickest" in quicker
    assert quicker.endswith(
        "Scheme thesis needed dx 0.005 m and 60 s for it in place of 20 s, timed on another "
        "processor."
    )
    unreached = choose(0.05, scene_with(), recorded_runs).reason
    assert unreached.endswith("Scheme thesis stays within 6 % at best.")
    missing = choose(
        0.3, scene_with(dimension=3), [*OBJECTIVE, stack(0.01, 0.2, 0.2, 9.0, dimension=3)]
    )
    assert "No runs of scheme objective are recorded for such a scene." in missing.reason


def test_a_chosen_scheme_has_the_settings_of_the_recorded_runs():
    """A chosen scheme replaces all settings that belong to a scheme."""
    recorded_scene = (
        scene_with(**{"numerics.scheme": "objective", "numerics.dx": 0.01}).resolve().data
    )
    apic = scene_with(**{"numerics.transfer": "apic", "numerics.contact": "touch"})
    chosen = apic.update(choose(0.05, apic, OBJECTIVE).values).resolve().data
    assert chosen["numerics"] == recorded_scene["numerics"]
    damped = scene_with(**{"numerics.scheme": "objective", "numerics.damping_length": 0.02})
    chosen = damped.update(choose(0.10, damped, RECORDED[:2]).values).resolve().data
    thesis_scene = scene_with(**{"numerics.dx": 0.01}).resolve().data
    assert chosen["numerics"] == thesis_scene["numerics"]


def test_lengths_that_do_not_scale_with_the_slab_are_named():
    thick_slab = scene_with(**{"slab.thickness": 0.2})
    assert choose(0.05, thick_slab, OBJECTIVE).reason.endswith(
        "(0.01 m) are 50 % of the recorded slab's thickness, 5 % of this one's."
    )
    assert "lengths" not in choose(0.05, scene_with(), OBJECTIVE).reason
    assert "lengths" not in choose(0.10, thick_slab, RECORDED).reason


def test_a_lucky_coarse_run_is_not_chosen():
    lucky = [stack(0.02, 0.01, 0.01, 1.0), *RECORDED[1:3]]
    assert choose(0.07, scene_with(), lucky).values["numerics.dx"] == 0.005


def test_runs_like_the_scene_are_preferred_and_differences_are_named():
    spatial = [*RECORDED, stack(0.01, 0.2, 0.2, 99.0, dimension=3)]
    choice = choose(0.3, scene_with(dimension=3), spatial)
    assert choice.values["numerics.dx"] == 0.01
    assert "Unlike" not in choice.reason
    assert "those runs were made with 2D" in choose(0.3, scene_with(dimension=3), RECORDED).reason
    assert (
        "those runs were made with events 5"
        in choose(0.3, scene_with(**{"events.count": 9}), RECORDED).reason
    )


def test_chosen_values_can_be_set():
    choice = choose(0.04, scene_with(**{"numerics.precision": "double"}), RECORDED)
    data = scene_with().update(choice.values).resolve().data
    assert data["numerics"]["dx"] == 0.005
    assert data["numerics"]["basis"] == "cubic"
    assert choice.values["numerics.precision"] is None  # as in the recorded runs: the default
    assert set(choice.values) == set(ACCURACY.values())
    assert set(ACCURACY.values()) <= {parameter.path for parameter in scene_parameters()}


def test_an_accuracy_needs_a_slab_and_recorded_runs():
    bodies = [{"shape": {"type": "sphere", "center": [0, 1], "radius": 0.1}}]
    with pytest.raises(InputError, match="--accuracy: the scene has no slab"):
        choose(0.1, Scene(dimension=2, bodies=bodies), RECORDED)
    failed = MeasuredSolution(CASE, {"dx": 0.1}, [], failure="no")
    for nothing in ([], [failed], [MeasuredSolution("bar", {"dx": 0.1}, [])]):
        with pytest.raises(InputError, match="nothing is recorded"):
            choose(0.1, scene_with(), nothing)


@pytest.fixture
def packaged(tmp_path, monkeypatch):
    """Make the commands read synthetic measurements instead of those of the package."""
    path = tmp_path / "recorded.json"
    record(RECORDED, path)
    monkeypatch.setattr(recorded, "PACKAGED_FILE", path)


def test_recorded_measurements_are_read_back(tmp_path):
    path = tmp_path / "recorded.json"
    record([*RECORDED, MeasuredSolution("bar", {}, [], failure="no")], path)
    assert [solution.to_json() for solution in load_recorded(path)] == [
        solution.to_json() for solution in RECORDED
    ]


def test_the_command_chooses_and_gives_the_reason(packaged, capsys):
    options = ["--preset", "lab-50", "--dim", "2", "--thickness", "0.04", "--accuracy", "6%"]
    assert main(["scene", *options]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["numerics"]["dx"] == 0.01
    assert err.startswith("--accuracy 6 %: dx 0.01 m (0.25 of the slab's thickness")


def test_panel_runs_the_chosen_settings(packaged, tmp_path, capsys):
    options = ["--preset", "lab-50", "--dim", "2", "--events", "1", "--max-time", "0.05"]
    command = ["panel", *options, "--accuracy", "0.3", "-q", "-o", str(tmp_path / "out")]
    assert main(command) == 0
    assert capsys.readouterr() == ("", "")
    scene = json.loads((tmp_path / "out" / "scene.json").read_text())
    assert scene["numerics"]["dx"] == 0.02


def test_an_accuracy_overrides_the_settings_of_the_file(packaged, tmp_path, capsys):
    path = tmp_path / "scene.json"
    scene_with(**{"numerics.dx": 0.02}).resolve().save(path)
    assert main(["plan", str(path)]) == 0
    coarse = capsys.readouterr().out
    assert main(["plan", str(path), "--accuracy", "5%"]) == 0
    out, err = capsys.readouterr()
    assert "dx 0.005 m" in err

    per_event = [line for line in out.splitlines() if "per event" in line]
    assert per_event != [line for line in coarse.splitlines() if "per event" in line]


@pytest.mark.parametrize("command", ["scene", "plan", "run"])
def test_an_accuracy_that_no_run_reached_is_refused(packaged, tmp_path, capsys, command):
    path = tmp_path / "scene.json"
    scene_with().resolve().save(path)
    out = tmp_path / "out"
    options = {
        "scene": ["--preset", "lab-50", "--dim", "2"],
        "plan": [str(path)],
        "run": [str(path), "-q", "-o", str(out)],
    }[command]
    assert main([command, *options, "--accuracy", "1%"]) == 2
    shown, error = capsys.readouterr()
    assert shown == "" and not out.exists()
    assert error.startswith(
        "error: --accuracy 1 %: no recorded run of lab-50 was that accurate. The best is dx 0.005 m"
    )


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("numerics.scheme", "objective"),
        ("numerics.dx", "0.01"),
        ("numerics.transfer", "apic"),
        ("seeding.pattern", "regular"),
    ],
)
def test_options_that_the_accuracy_chooses_are_refused(packaged, capsys, path, value):
    option = option_name(path)
    assert main(["scene", "--accuracy", "5%", option, value]) == 2
    error = capsys.readouterr().err
    assert error == f"error: {option}: --accuracy chooses grid and scheme; give one of the two\n"


@pytest.mark.parametrize("text", ["5", "0", "-3%", "100%", "five", "nan", ""])
def test_invalid_accuracies_are_refused(capsys, text):
    assert main(["scene", f"--accuracy={text}"]) == 2
    assert "is not an accuracy; give a percentage such as 5%" in capsys.readouterr().err


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_package_contains_recorded_runs(dimension):
    choice = choose(0.5, scene_with(dimension=dimension))
    assert 0 < choice.values["numerics.dx"] <= THICKNESS
    assert choice.reason.startswith("--accuracy 50 %: dx ")


def test_recorded_runs_have_the_present_names():
    names = {name for solution in load_recorded() for name in solution.settings}
    assert "courant_factor" in names and "step_factor" not in names
