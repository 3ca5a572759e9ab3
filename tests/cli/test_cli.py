import json
import re
import signal
import subprocess
import sys

import click
import pytest
from helpers.bad_scenes import bad_scene  # noqa: F401
from helpers.processes import modules_after

from snowshed import _core, read_events
from snowshed.cli import main as cli
from snowshed.cli.commands.panel import panel
from snowshed.cli.deferred import Deferred
from snowshed.cli.main import main
from snowshed.cli.options.scene import PREFIXED_SECTIONS, SHORT_NAMES, option_name
from snowshed.scene.schema import scene_parameters

TINY = [
    *("--preset", "lab-50", "--dim", "2", "--dx", "0.02", "--particles-per-voxel", "8"),
    *("--events", "1", "--max-time", "0.2", "--threads", "1"),
]


def scene_data(capsys, *options):
    assert main(["scene", *options]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_command_of_the_lab_experiment(capsys):
    data = scene_data(
        capsys,
        *("--height", "0.33", "--length", "0.245", "--width", "0.213", "--tilt", "50"),
        *("--thickness", "0.02", "--events", "5", "--dim", "3", "--friction", "0.3"),
    )
    assert data["panel"]["height"] == 0.33
    assert data["panel"]["friction"] == 0.3
    assert data["slab"]["thickness"] == 0.02
    two_thirds_of_the_panel = (0.0, pytest.approx(0.142))
    assert data["slab"]["width"] in two_thirds_of_the_panel
    assert (data["events"]["count"], data["dimension"]) == (5, 3)


def test_every_parameter_has_its_own_option():
    names = [option_name(parameter.path) for parameter in scene_parameters()]
    assert len(set(names)) == len(names)
    paths = {parameter.path for parameter in scene_parameters()}
    assert set(SHORT_NAMES) <= paths
    assert set(PREFIXED_SECTIONS) <= {path.partition(".")[0] for path in paths}
    own = {name for o in panel.params for name in o.opts}
    assert len(own) == sum(len(o.opts) for o in panel.params)
    assert set(names) <= own


def test_options_override_the_snow_and_the_snow_overrides_the_preset(capsys):
    data = scene_data(capsys, "--preset", "lab-50", "--snow", "reference", "--density", "300")
    assert data["snow"]["cohesion"] == 0.1
    assert data["snow"]["density"] == 300
    assert data["panel"]["tilt"] == 50


def test_options_of_every_kind(capsys):
    data = scene_data(
        capsys,
        *("--preset", "geometry", "--panel-thickness", "0.05", "--ground-tilt", "-3"),
        *("--energy", "--domain-min", "-9,-9", "--domain-max", "9,9", "--between", "reseed"),
        *("--obstacle", '{"name": "post", "shape": {"type": "sphere", "radius": 0.2}}'),
    )
    assert data["panel"]["thickness"] == 0.05
    assert data["ground"]["tilt"] == -3
    assert data["output"]["energy"] is True
    assert data["domain"] == {"min": [-9, -9], "max": [9, 9]}
    assert data["obstacles"][0]["name"] == "post"
    assert data["events"]["between"] == "reseed"


def test_former_options_work_and_are_hidden(capsys):
    assert main(["scene", "--preset", "lab-50", "--step-factor", "0.5"]) == 0
    assert json.loads(capsys.readouterr().out)["numerics"]["courant_factor"] == 0.5
    assert (
        main(["scene", "--preset", "lab-50", "--step-factor", "0.5", "--courant-factor", "0.5"])
        == 2
    )
    assert "means the same as" in capsys.readouterr().err
    assert main(["scene", "--accuracy", "5%", "--step-factor", "0.5"]) == 2
    assert "--step-factor: --accuracy chooses" in capsys.readouterr().err
    assert main(["scene", "--preset", "lab-50", "--step-factor", "7"]) == 2
    assert "/numerics/courant_factor): 7 is outside" in capsys.readouterr().err
    main(["scene", "--help"])
    assert "--step-factor" not in capsys.readouterr().out


def test_without_a_command_the_help_is_printed_to_stdout(capsys):
    assert main([]) == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("Usage: snowshed") and len(shown.out.splitlines()) > 10
    assert shown.err == ""


def test_help_is_short_and_help_all_is_complete(capsys):
    assert main(["panel", "--help"]) == 0
    short = capsys.readouterr().out
    assert main(["panel", "--help-all"]) == 0
    complete = capsys.readouterr().out
    assert "--tilt" in short and "--flip-ratio" not in short
    assert "--flip-ratio" in complete and "--step-factor" not in complete
    assert main(["panel", "--help"]) == 0  # unchanged by --help-all
    assert len(short.splitlines()) < 70 < len(complete.splitlines())


def test_unusual_scenes_and_results_are_noted(tmp_path, capsys):
    coarse = ("--dim", "2", "--height", "0.33", "--length", "0.245", "--thickness", "0.02")
    odd = ("--dx", "0.05", "--tilt", "20", "--friction", "2", "--max-time", "0.1")
    allowed = ("--allow-sparse", "--width", "0.2")
    out = str(tmp_path / "out")
    assert main(["panel", *coarse, *odd, *allowed, "-o", out]) == 0
    shown = capsys.readouterr()
    assert "the slab is 20 mm thick, less than two cells of 50 mm" in shown.err
    assert "nothing slid: the snow stays on the panel" in shown.err
    data = json.loads((tmp_path / "out" / "scene.json").read_text())
    del data["ground"]
    (tmp_path / "scene.json").write_text(json.dumps(data))
    assert main(["run", str(tmp_path / "scene.json"), "-o", str(tmp_path / "b")]) == 0
    assert "the scene has no ground" in capsys.readouterr().err


def test_help_names_unit_and_default(capsys):
    assert main(["panel", "--help"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert (
        "--density FLOAT Initial bulk density; sets E and p0 unless given [kg/m3; default 210.0]"
        in text
    )


def test_panel_runs_quietly(tmp_path, capsys):
    assert main(["panel", *TINY, "-q", "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr() == ("", "")
    assert list(read_events(tmp_path / "out").event) == [1]


def test_scene_run_and_table(tmp_path, capsys):
    scene, out = tmp_path / "scene.json", tmp_path / "out"
    assert main(["scene", *TINY, "-o", str(scene)]) == 0
    assert main(["run", str(scene), "-o", str(out)]) == 0
    shown = capsys.readouterr()
    assert "Stack after each event" in shown.out and str(out) in shown.out
    assert json.loads((out / "scene.json").read_text()) == json.loads(scene.read_text())


def test_plan(tmp_path, capsys):
    scene = tmp_path / "scene.json"
    main(["scene", *TINY, "-o", str(scene)])
    assert main(["plan", str(scene)]) == 0
    shown = capsys.readouterr().out
    for line in ("used", "left out", "particles", "memory", "time step", "steps", "run time"):
        assert line in shown
    assert list(tmp_path.iterdir()) == [scene]


def test_schema(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(_core.scene_schema())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--density", "-1"], "--density (/snow/density): -1"),
        (["--density", "nan"], "--density (/snow/density): nan"),
        (["--poissons-ratio", "0.5"], "--poissons-ratio (/snow/poissons_ratio): 0.5"),
        (["--tilt", "91"], "--tilt (/panel/tilt): 91"),
        (["--dim", "4"], "--dim (/dimension): 4"),
        (["--height", "tall"], "'--height': 'tall'"),
        (["--between", "melt"], "'--between': 'melt' is not one of 'carry', 'reseed'"),
        (["--preset", "lab-60"], "lab-50"),
        (["--snow", "wet"], "calibrated"),
        (["--particles-per-voxel", "2"], "/seeding/particles_per_voxel"),
        (["--domain-min", "1,b"], "'1,b' is not a list of numbers"),
        (["--domain-min", "5,5", "--domain-max", "6,6"], "domain"),
        (["--obstacle", "{"], "give a JSON object"),
        (["--obstacle", '{"shape": {"type": "egg"}}'], "/obstacles/0/shape/type"),
        (["--wind", "3"], "--wind"),
        (["--dx", "1e-7"], "memory"),
    ],
)
def test_bad_options_give_one_line_code_2_and_no_files(tmp_path, capsys, options, message):
    out = tmp_path / "out"
    assert main(["panel", *TINY, *options, "-o", str(out)]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("error: ") and shown.err.count("\n") == 1
    assert message in shown.err
    assert not out.exists()


@pytest.mark.parametrize("command", ["run", "plan"])
def test_bad_scenes_are_refused(bad_scene, tmp_path, capsys, command):  # noqa: F811
    file, message = bad_scene
    files_before = sorted(tmp_path.rglob("*"))
    output = ["-o", str(tmp_path / "out")] if command == "run" else []
    assert main([command, str(file), *output]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("error: ") and shown.err.count("\n") == 1, shown.err
    assert message in shown.err
    assert sorted(tmp_path.rglob("*")) == files_before


def test_unusable_files_and_folders_are_refused(tmp_path, capsys, finished):
    scene = str(finished / "scene.json")
    assert main(["run", str(tmp_path / "none.json"), "-o", str(tmp_path / "out")]) == 2
    assert "none.json: no such file" in capsys.readouterr().err
    assert main(["run", scene, "-o", str(finished)]) == 2
    assert "not empty" in capsys.readouterr().err
    assert main(["run", scene, "-o", str(tmp_path / "out"), "--resume"]) == 2
    assert "nothing to resume" in capsys.readouterr().err
    assert main(["panel", "--preset", "lab-40", "-o", str(finished), "--resume"]) == 2
    assert "another scene" in capsys.readouterr().err
    assert main(["run", scene]) == 2
    assert "--output" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_an_unknown_command_is_an_error_and_help_is_not(capsys):
    assert main(["--help"]) == 0
    assert "panel" in capsys.readouterr().out
    assert main(["fly"]) == 2


def test_ctrl_c_says_how_to_resume(tmp_path, capsys, monkeypatch):
    def interrupt(*_):
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("snowshed.running.run._Observer.event_begun", interrupt)
    out = tmp_path / "out"
    assert main(["panel", *TINY, "-q", "-o", str(out)]) == 130
    message = capsys.readouterr().err
    assert f"snowshed run {out / 'scene.json'} -o {out} --resume" in message
    monkeypatch.undo()
    assert main(["run", str(out / "scene.json"), "-o", str(out), "--resume", "-q"]) == 0
    assert len(read_events(out)) == 1


def test_a_failed_simulation_is_code_3(tmp_path, capsys, monkeypatch):
    def fail(*_):
        raise _core.SimulationError("time step underflow")

    monkeypatch.setattr(_core.EventSequence, "run", fail)
    assert main(["panel", *TINY, "-q", "-o", str(tmp_path / "out")]) == 3
    assert capsys.readouterr().err == "error: time step underflow\n"


def test_the_package_runs_as_a_module(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "snowshed", "--version"], capture_output=True, text=True
    )
    assert done.returncode == 0
    assert _core.version in done.stdout


def test_commands_are_imported_when_they_run():
    packages = tuple({f"snowshed.cli.commands.{module}" for _, module, _ in cli.DEFERRED})
    modules = modules_after("from snowshed.cli.main import main; main(['--help'])")
    assert [name for name in modules if name.startswith(packages)] == []


@pytest.mark.parametrize("name", [name for name, _, _ in cli.DEFERRED])
def test_deferred_commands_show_their_own_help(capsys, name):
    assert main([name, "--help"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith(f"Usage: snowshed {name} ")
    assert cli.cli.commands[name].load().name == name


@pytest.mark.parametrize(
    ("former", "now"),
    [
        (["plan"], ["run", "--dry-run"]),
        (["verify"], ["self-test"]),
        (["study", "plan"], ["study", "run", "--dry-run"]),
    ],
)
def test_former_names_of_commands_work_and_are_not_listed(former, now, capsys):
    assert main([*former, "--help"]) == 0
    capsys.readouterr()
    assert main([*former[:-1], "--help"]) == 0
    listed = re.findall(r"^  ([a-z-]+) ", capsys.readouterr().out, re.MULTILINE)
    assert former[-1] not in listed and now[len(former) - 1] in listed


def test_the_former_spelling_of_a_dry_run_works(tmp_path, capsys):
    shown = []
    for option in ("--dry-run", "--plan"):
        assert main(["panel", *TINY, "-o", str(tmp_path / "out"), option]) == 0
        lines = capsys.readouterr().out.splitlines()
        measured = (" run time", " speed")  # these depend on the machine and the moment
        shown.append([line for line in lines if not line.startswith(measured)])
        assert len(shown[-1]) == len(lines) - len(measured)
    assert shown[0] == shown[1] and not (tmp_path / "out").exists()


def test_a_dry_run_prints_the_cost_and_needs_no_folder(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["scene", *TINY, "-q", "-o", "scene.json"]) == 0
    for command in (["panel", *TINY], ["run", "scene.json"], ["slide", "--example"],
                    ["grains", "example"], ["plan", "scene.json"]):  # fmt: skip
        option = [] if command[0] == "plan" else ["--dry-run"]
        assert main([*command, *option]) == 0
        assert "run time" in capsys.readouterr().out
    assert main(["run", "scene.json"]) == 2
    assert "Missing option '-o'" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["scene.json"]


def commands_with_options():
    """Return the options of each command that is not hidden."""

    def walk(command, name):
        command = command.load() if isinstance(command, Deferred) else command
        if isinstance(command, click.Group):
            for child_name, child in command.commands.items():
                if not child.hidden:
                    yield from walk(child, f"{name} {child_name}".strip())
        else:
            yield name, {option for parameter in command.params for option in parameter.opts}

    return dict(walk(cli.cli, ""))


def test_commands_that_compute_have_the_same_options():
    """A dry run and resuming have the same spelling in all commands."""
    computing = {
        name: options
        for name, options in commands_with_options().items()
        if {"--jobs", "--resume", "--dry-run"} & options and not name.startswith("reproduce")
    }
    assert {"panel", "run", "slide", "season", "clearance", "lua", "study run"} <= computing.keys()
    assert {"sensitivity", "calibrate", "grains sensitivity"} <= computing.keys()
    without_resume = {name for name, options in computing.items() if "--resume" not in options}
    assert without_resume == {"study resume"}  # the name says that it resumes
    without_dry_run = {name for name, options in computing.items() if "--dry-run" not in options}
    assert without_dry_run == {"study resume", "regress"}
