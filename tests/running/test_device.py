"""The choice between processor and graphics card, on a machine without a card or one that hides
it."""

import json
import subprocess
import sys
import warnings

import pytest
from click.testing import CliRunner
from helpers.processes import EXECUTABLE, modules_after

import snowshed._core as _core
from snowshed import InputError, Scene, Simulation
from snowshed.base import compiler_folders as packages
from snowshed.cli.main import cli
from snowshed.study import Study, axis
from snowshed.study.scene_hash import RunKey

NO_DRIVER = "no NVIDIA driver: /nonexistent/libcuda.so.1"


@pytest.fixture(autouse=True)
def without_driver(monkeypatch):
    monkeypatch.setenv("SNOWSHED_CUDA", "/nonexistent/libcuda.so.1")


def scene(device):
    return Scene.preset("lab-50").update(
        {
            **{"dimension": 2, "numerics.dx": 0.02, "numerics.device": device},
            **{"slab.thickness": 0.06, "events.max_time": 0.06},  # no note on a coarse slab
        }
    )


def test_a_card_that_is_missing_is_an_error_that_says_what_to_install():
    with pytest.raises(InputError, match=f"^/numerics/device: {NO_DRIVER}.*install the driver"):
        Simulation(scene("gpu"))


def test_the_automatic_choice_falls_back_and_says_why():
    with pytest.warns(UserWarning, match=f'device "auto": computed on the processor: {NO_DRIVER}'):
        simulation = Simulation(scene("auto"))
    assert simulation.particle_count == 0


def test_the_processor_is_the_default_and_needs_no_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Simulation(scene("cpu"))
    assert Scene.preset("lab-50").resolve().data["numerics"]["device"] == "cpu"


@pytest.mark.parametrize("command", ["snowshed", "snowshed-run"])
def test_without_a_card_a_program_exits_with_code_2_and_writes_nothing(command, tmp_path):
    scene("gpu").resolve().save(tmp_path / "scene.json")
    run = [sys.executable, "-m", "snowshed", "run"] if command == "snowshed" else [EXECUTABLE]
    arguments = [tmp_path / "scene.json", "-o", tmp_path / "out"]
    done = subprocess.run([*run, *arguments], capture_output=True, text=True)
    assert done.returncode == 2
    assert NO_DRIVER in done.stderr.replace("\n", " ")
    assert not (tmp_path / "out").exists()


def test_the_record_of_a_run_has_the_device_and_the_reason(tmp_path):
    arguments = ["panel", "--preset", "lab-50", "--dim", "2", "--dx", "0.02", "--max-time", "0.06"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        done = CliRunner().invoke(cli, [*arguments, "--device", "auto", "-o", str(tmp_path / "o")])
    assert done.exit_code == 0, done.output
    record = json.loads((tmp_path / "o" / "run.json").read_text(encoding="utf-8"))
    assert record["device"] == "cpu"
    assert any(NO_DRIVER in note for note in record["notes"])


def test_a_plan_tells_the_memory_that_a_card_would_need():
    on_either = scene("auto").resolve()
    plan = _core.plan(on_either.core, on_either.base_dir)
    assert plan["device"] == "cpu"
    assert plan["card_memory_bytes"] == int(226.52 * plan["particles_total"])
    on_processor = scene("cpu").resolve()
    assert _core.plan(on_processor.core, on_processor.base_dir)["card_memory_bytes"] == 0


def test_a_run_may_be_resumed_on_another_device(tmp_path):
    scene("cpu").resolve().save(tmp_path / "first.json")
    scene("auto").resolve().save(tmp_path / "second.json")
    for file, more in (("first.json", []), ("second.json", ["--resume"])):
        command = [EXECUTABLE, tmp_path / file, "-o", tmp_path / "out", "--quiet", *more]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_a_result_is_the_same_run_on_any_device():
    assert RunKey.of(scene("cpu").resolve()).hash == RunKey.of(scene("auto").resolve()).hash
    with pytest.raises(InputError, match=r"numerics\.device"):
        Study(scene("cpu"), [[axis("numerics.device", ["cpu", "auto"])]])


def test_the_packages_of_the_compiler_are_sought_where_python_looks(tmp_path, monkeypatch):
    folder = tmp_path / "nvidia" / "cu13" / "lib"
    folder.mkdir(parents=True)
    monkeypatch.syspath_prepend(str(tmp_path))
    assert packages.compiler_folders()[0] == str(folder)


def test_importing_snowshed_looks_for_no_card():
    modules = modules_after("import snowshed, snowshed._core")
    assert "snowshed.base.compiler_folders" not in modules
    assert not any(name.partition(".")[0] == "nvidia" for name in modules)
