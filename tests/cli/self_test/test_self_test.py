"""The self-test passes here, and each check fails if the checked code is broken."""

import json

import pytest

import snowshed.cli.self_test
from snowshed import _core
from snowshed.cli.main import main
from snowshed.cli.self_test import (
    CHECKS,
    Check,
    motion,
    return_mapping,
    run_checks,
    same_bits,
    slide,
)

BROKEN = Check("a broken core", 0.0, lambda: 0.5)


def check_result(measure):
    """Run the check with this measuring function."""
    (check,) = (check for check in CHECKS if check.measure is measure)
    (result,) = run_checks([check])
    return result


@pytest.fixture
def core(monkeypatch):
    """Replace the core's simulation by one whose scene a function has changed."""
    real = _core.Simulation

    def replace(changed, **options):
        def simulation(text, base_dir="."):
            data = json.loads(text)
            changed(data)
            return real(json.dumps(data), base_dir)

        simulation.load = options.get("load", real.load)
        monkeypatch.setattr(_core, "Simulation", simulation)

    return replace


def test_the_self_test_passes(capsys):
    assert main(["self-test"]) == 0
    shown = capsys.readouterr().out
    assert f"snowshed {_core.version}, " in shown and " kernels, " in shown
    assert all(check.title in shown for check in CHECKS)
    assert shown.count(" ok ") == len(CHECKS) and "FAILED" not in shown


def test_the_exit_code_is_1_if_a_check_fails(capsys, monkeypatch):
    monkeypatch.setattr(snowshed.cli.self_test, "CHECKS", (BROKEN,))
    assert main(["self-test"]) == 1
    (row,) = (line for line in capsys.readouterr().out.splitlines() if BROKEN.title in line)
    assert row.split()[-3:] == ["0.5", "0", "FAILED"]


def test_a_check_that_raises_an_error_fails_and_says_why(capsys, monkeypatch):
    def measure():
        raise _core.SimulationError("time step underflow")

    check = Check("a core that stops", 1.0, measure)
    monkeypatch.setattr(snowshed.cli.self_test, "CHECKS", (check, BROKEN))
    assert main(["self-test"]) == 1
    shown = capsys.readouterr().out
    assert "FAILED time step underflow" in shown and BROKEN.title in shown


def test_former_options_name_their_replacement(capsys):
    assert main(["self-test", "--full", "--case", "incline", "-o", "my out"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: self-test takes no options; the validation, a larger suite")
    assert message.endswith("run `python -m validation --full --case incline -o 'my out'` there\n")


class Softer:
    """A law whose return mapping or hardening is off by a part in a million."""

    def __init__(self, law, **factors):
        self._law, self._factors = law, factors

    def __getattr__(self, name):
        return getattr(self._law, name)

    def return_map(self, p, q, ev):
        mapped = self._law.return_map(p, q, ev)
        factors = (self._factors.get(name, 1.0) for name in ("p", "q", "ev"))
        return tuple(value * factor for value, factor in zip(mapped, factors))

    def preconsolidation(self, ev):
        return self._law.preconsolidation(ev) * self._factors.get("p0", 1.0)


@pytest.mark.parametrize(
    ("measure", "wrong"),
    [
        *((return_mapping.hardening_error, wrong) for wrong in ("p", "ev", "p0")),
        *((return_mapping.critical_state_error, wrong) for wrong in ("p", "q", "ev")),
    ],
)
def test_a_wrong_return_mapping_fails(measure, wrong, monkeypatch):
    real = _core.CamClay
    monkeypatch.setattr(_core, "CamClay", lambda *a: Softer(real(*a), **{wrong: 1 + 1e-6}))
    assert not check_result(measure).holds


def test_wrong_gravity_fails(core):
    core(lambda data: data.update(gravity=9.8101))
    assert not check_result(motion.fall_error).holds


def test_wrong_friction_fails(core):
    core(lambda data: data["obstacles"][0].update(friction=1.05 * motion.FRICTION))
    assert not check_result(motion.friction_error).holds


@pytest.mark.parametrize("wrong", [{"density": 220}, {"poissons_ratio": 0.27}])
def test_wrong_stress_in_a_column_fails(wrong, core):
    core(lambda data: data["snow"].update(wrong))
    assert not check_result(motion.column_error).holds


@pytest.mark.parametrize(
    ("measure", "wrong"),
    [
        (slide.coulomb_error, {"friction": 1.02 * slide.FRICTION}),
        (slide.voellmy_error, {"friction": 1.02 * slide.FRICTION}),
        (slide.voellmy_error, {"turbulence": 0.97 * slide.TURBULENCE}),
    ],
)
def test_wrong_friction_of_a_snow_slide_fails(measure, wrong, core):
    core(lambda data: data["numerics"].update(wrong))
    assert not check_result(measure).holds


def test_threads_that_change_a_bit_fail(core):
    def changed(data):
        data["gravity"] += 1e-4 * (data["numerics"]["threads"] - 1)

    core(changed)
    assert not check_result(same_bits.threads_error).holds


def test_a_checkpoint_with_changed_gravity_fails(core):
    real = _core.Simulation

    def load(path):
        scene = json.loads(real.load(path).scene)
        changed = real(json.dumps({**scene, "gravity": 9.82}))
        changed.begin_event()
        return changed

    core(lambda data: None, load=load)
    assert not check_result(same_bits.checkpoint_error).holds


def test_an_executable_with_other_results_fails(core):
    core(lambda data: data.update(gravity=9.82))
    assert not check_result(same_bits.executable_error).holds


def test_a_missing_executable_fails(tmp_path, monkeypatch):
    monkeypatch.setattr(same_bits.sysconfig, "get_path", lambda name: str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path))
    result = check_result(same_bits.executable_error)
    assert not result.holds
    assert result.failure == f"snowshed-run is neither in {tmp_path} nor on the search path"


def test_the_error_of_an_executable_is_reported(tmp_path, monkeypatch):
    script = tmp_path / "snowshed-run"
    script.write_text("#!/bin/sh\necho 'error: no such kernel' >&2\nexit 3\n")
    script.chmod(0o755)
    monkeypatch.setattr(same_bits.sysconfig, "get_path", lambda name: str(tmp_path))
    result = check_result(same_bits.executable_error)
    assert not result.holds
    assert result.failure == "exit code 3: error: no such kernel"
