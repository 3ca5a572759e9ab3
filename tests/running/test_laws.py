"""Laws of one's own, compiled by the C compiler that builds snowshed."""

import ctypes
import shutil
import subprocess
from contextlib import nullcontext
from functools import partial

import numpy as np
import pytest
from helpers.interrupted_runs import interrupt_at
from helpers.paths import ROOT

from snowshed import InputError, Interrupted, Scene, Simulation, SnowshedNote, run
from snowshed.running import LAW_PROTOTYPES, Laws

COMPILER = shutil.which("cc") or shutil.which("gcc")
pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")

SOURCE = """
#include <stdint.h>
void fluid_float(int64_t n, float* p, float* q, float* e, const uint8_t* s, double dt) {
  for (int64_t i = 0; i < n; ++i) q[i] = 0;
}
void fluid_double(int64_t n, double* p, double* q, double* e, const uint8_t* s, double dt) {
  for (int64_t i = 0; i < n; ++i) q[i] = 0;
}
double constant(double speed, double stress) { return 0.3; }
#include "EXAMPLES/own_laws.c"
DRUCKER_PRAGER(sand_pq, double, bulk_2d)
DRUCKER_PRAGER_TENSOR(sand_tensor, double, 2, 3, bulk_2d)
DRUCKER_PRAGER_TENSOR(sand_tensor_3d, double, 3, 6, bulk_3d)
BRITTLE(brittle_double, double)
void count(int64_t n, double* e, double* s, double* p, double* own, const uint8_t* k, double dt) {
  for (int64_t i = 0; i < n; ++i) {
    s[i] = s[n + i] = 1e6 * (e[i] + e[n + i]);
    s[2 * n + i] = 0;
    if (dt > 0) own[i] += 1;
  }
}
void lift(int64_t n, const double* x, const double* y, const double* z, double t,
          double* ax, double* ay, double* az) {
  for (int64_t i = 0; i < n; ++i) az[i] = 9.81;
}
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    folder = tmp_path_factory.mktemp("laws")
    (folder / "laws.c").write_text(SOURCE.replace("EXAMPLES", str(ROOT / "examples")))
    command = [COMPILER, "-O2", "-shared", "-fPIC", "laws.c", "-o", "laws.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return ctypes.CDLL(str(folder / "laws.so"))


def of_type(library, name, kind):
    return ctypes.cast(getattr(library, name), LAW_PROTOTYPES[kind])


def positions(scene, laws):
    with pytest.warns(SnowshedNote, match="laws of the user") if laws else nullcontext():
        simulation = Simulation(scene, laws=laws)
    simulation.begin_event()
    simulation.step(200)
    return simulation.positions()


@pytest.mark.parametrize("precision", ["float", "double"])
def test_a_law_of_the_material_is_called_in_the_precision_of_the_scene(tiny, library, precision):
    scene = tiny.with_({"numerics.precision": precision})
    law = of_type(library, f"fluid_{precision}", f"material_{precision}")
    assert not np.array_equal(positions(scene, Laws("fluid", material=law)), positions(scene, None))


def test_a_law_of_another_precision_is_refused(tiny, library):
    law = of_type(library, "fluid_double", "material_double")
    with pytest.raises(InputError, match="material: the function has other arguments"):
        Simulation(tiny.with_({"numerics.precision": "float"}), laws=Laws("fluid", material=law))


def test_the_friction_of_the_scene_as_a_function_gives_the_same_bits(tiny, library):
    scene = tiny.with_({"panel.friction": 0.3})
    law = of_type(library, "constant", "friction")
    laws = Laws("constant", friction={"panel": law})
    assert np.array_equal(positions(scene, laws), positions(scene, None))


def test_an_address_is_enough(tiny, library):
    address = ctypes.cast(library.lift, ctypes.c_void_p).value
    floating = positions(tiny.with_({"panel.tilt": 0}), Laws("lift", body_force=address))
    assert np.isfinite(floating).all()


def test_results_and_checkpoints_name_the_laws(tiny, library, tmp_path):
    laws = Laws("constant", friction={"panel": of_type(library, "constant", "friction")})
    with pytest.warns(SnowshedNote, match="laws of the user: constant"):
        results = run(tiny, tmp_path / "out", laws=laws, pictures=False)
    assert any("laws of the user: constant" in note for note in results.run["notes"])
    with pytest.raises(InputError, match='laws of the user "constant", which a checkpoint'):
        Simulation.load(tmp_path / "out/checkpoint.bin")
    loaded = Simulation.load(tmp_path / "out/checkpoint.bin", laws=laws)
    assert loaded.event == results.events.event.max()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"name": "none"}, "there is none"),
        ({"name": "", "material": 1}, "not a name"),
        ({"name": "text", "material": "law"}, "material: 'law'; needed: "),
        ({"name": "python", "friction": {"panel": lambda v, s: 0.1}}, "friction of panel: a value"),
        ({"name": "both", "material": 1, "constitutive": 1}, "both material and constitutive"),
        ({"name": "numbers", "constitutive": 1, "own_numbers": 9}, "own_numbers: 9; allowed"),
        ({"name": "numbers", "constitutive": 1, "own_numbers": -1}, "own_numbers: -1; allowed"),
        ({"name": "numbers", "material": 1, "own_numbers": 1}, "only a constitutive law"),
        ({"name": "text", "constitutive": "law"}, "constitutive: 'law'; needed: "),
        ({"name": "null", "body_force": 0}, "body_force: a value of type int"),
    ],
)
def test_wrong_laws_are_refused(given, message):
    with pytest.raises(InputError, match=message):
        Laws(**given)


def test_laws_of_unknown_obstacles_and_other_methods_are_refused(tiny, library):
    law = of_type(library, "constant", "friction")
    with pytest.raises(InputError, match='no obstacle is called "pannel"'):
        Simulation(tiny, laws=Laws("typo", friction={"pannel": law}))
    ball = {"shape": {"type": "sphere", "center": [0, 1], "radius": 0.1}}
    water = Scene.from_data({"snowshed": 2, "dimension": 2, "method": "mps", "bodies": [ball]})
    with pytest.raises(InputError, match='the method "mps" takes no laws'):
        Simulation(water, laws=Laws("mps", friction={"ground": law}))


def test_numba_functions_are_taken(tiny):
    numba = pytest.importorskip("numba")
    from snowshed.running import LAW_SIGNATURES

    @numba.cfunc(LAW_SIGNATURES["friction"])
    def friction(speed, stress):
        return 0.3

    laws = Laws("numba", friction={"panel": friction})
    scene = tiny.with_({"panel.friction": 0.3})
    assert np.array_equal(positions(scene, laws), positions(scene, None))


# --- constitutive laws: stress and state as tensors -------------------------------------------


def call(library, name, strain, *, own=0, time_step=1e-4, kind="constitutive_double"):
    """Call a law for the columns of `strain`; return strain, stress, plastic strain and numbers."""
    strain = np.array(strain, dtype=float)
    stress, count = np.zeros_like(strain), strain.shape[1]
    plastic, numbers = np.zeros(count), np.full(count, float(own))
    snow = (ctypes.c_uint8 * count)()

    def pointer(array):
        return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))

    of_type(library, name, kind)(
        count, pointer(strain), pointer(stress), pointer(plastic), pointer(numbers), snow, time_step
    )
    return strain, stress, plastic, numbers


def test_a_constitutive_law_agrees_with_the_same_law_of_pressure_and_shear(tiny, library):
    box = {"type": "box", "center": [0, 0.11], "size": [0.3, 0.2]}
    fallen = {"bodies": [{"shape": box, "velocity": [0, -3]}], "ground": {}}
    scene = Scene.from_data({"snowshed": 2, "dimension": 2, **fallen, "numerics": {"dx": 0.02}})
    scene.set("numerics.precision", "double")
    pq = Laws("pq", material=of_type(library, "sand_pq", "material_double"))
    law = of_type(library, "sand_tensor", "constitutive_double")
    tensor = Laws("tensor", constitutive=law)
    both = positions(scene, pq), positions(scene, tensor)
    assert np.abs(both[0] - both[1]).max() < 1e-8
    assert np.abs(both[0] - positions(scene, None)).max() > 1e-4


def test_brittle_snow_cracks_at_its_strength_in_every_direction(library):
    """A uniaxial stress in any direction, below the strength and above it."""
    young, poisson, strength = 1e6, 0.3, 2000.0
    plane = young / (1 - poisson**2)
    for angle in np.linspace(0, np.pi, 13):
        n = np.array([np.cos(angle), np.sin(angle)])
        for share in (0.999, 1.001):
            along = share * strength / plane
            across = -poisson / (1 - poisson) * along
            e = along * np.outer(n, n) + across * (np.eye(2) - np.outer(n, n))
            given = [[e[0, 0]], [e[1, 1]], [e[0, 1]]]
            strain, stress, plastic, cracked = call(library, "brittle_double", given)
            tau = np.array([[stress[0, 0], stress[2, 0]], [stress[2, 0], stress[1, 0]]])
            if share < 1:
                assert np.allclose(tau, share * strength * np.outer(n, n), atol=1e-6)
                assert (cracked, plastic) == (0, 0) and np.array_equal(strain, given)
            else:
                assert np.abs(tau @ n).max() < 1e-6 and cracked == 1
                t = np.array([-n[1], n[0]])
                assert t @ tau @ t == pytest.approx(plane * across)  # across, with no stress along
                assert plastic == pytest.approx(along + across - strain[0] - strain[1])


def test_with_a_time_step_of_zero_the_example_laws_change_nothing(library):
    rng = np.random.default_rng(1)
    for name, size in (("sand_tensor", 3), ("sand_tensor_3d", 6), ("brittle_double", 3)):
        given = rng.normal(scale=0.01, size=(size, 40))
        returned = call(library, name, given)
        assert not np.array_equal(returned[0], given)
        strain, stress, plastic, own = call(library, name, returned[0], own=2, time_step=0.0)
        assert np.array_equal(strain, returned[0])
        assert (
            np.allclose(stress, returned[1], atol=1e-6) and not plastic.any() and (own == 2).all()
        )


def test_own_numbers_are_fields_and_resume(tiny, library, tmp_path):
    scene = tiny.with_({"numerics.precision": "double", "numerics.sleep_speed": 0})
    counting = Laws(
        "count", constitutive=of_type(library, "count", "constitutive_double"), own_numbers=1
    )
    with pytest.warns(SnowshedNote, match="laws of the user"):
        simulation = Simulation(scene, laws=counting)
    simulation.begin_event()
    simulation.step(64)
    assert set(simulation.fields["own_0"].values.tolist()) == {64.0}
    simulation.save(tmp_path / "checkpoint.bin")
    loaded = Simulation.load(tmp_path / "checkpoint.bin", laws=counting)
    for each in (loaded, simulation):
        each.step(36)
        assert set(each.fields["own_0"].values.tolist()) == {100.0}
    assert np.array_equal(loaded.positions(), simulation.positions())
    two = Laws("count", constitutive=counting.constitutive, own_numbers=2)
    with pytest.raises(InputError, match='"count" that has 1 numbers of its own'):
        Simulation.load(tmp_path / "checkpoint.bin", laws=two)


def test_a_constitutive_law_is_not_in_the_energy_balance(tiny, library):
    law = of_type(library, "sand_tensor", "constitutive_double")
    with pytest.raises(InputError, match="/output/energy: a constitutive law"):
        Simulation(
            tiny.with_({"output.energy": True, "numerics.precision": "double"}),
            laws=Laws("tensor", constitutive=law),
        )


def test_numba_compiles_constitutive_laws(tiny, library):
    numba = pytest.importorskip("numba")
    from snowshed.running import LAW_SIGNATURES

    @numba.cfunc(LAW_SIGNATURES["constitutive_double"])
    def liquid(count, strain, stress, plastic_strain, own, snow, time_step):
        e = numba.carray(strain, (3, count))
        s = numba.carray(stress, (3, count))
        for i in range(count):
            s[0, i] = s[1, i] = 1e6 * (e[0, i] + e[1, i])
            s[2, i] = 0.0

    scene = tiny.with_({"numerics.precision": "double"})
    c = of_type(library, "count", "constitutive_double")
    mine = positions(scene, Laws("numba", constitutive=liquid))
    assert np.array_equal(mine, positions(scene, Laws("C", constitutive=c, own_numbers=1)))


# --- laws that have changed ----------------------------------------------------------------

CHANGED = "double constant(double speed, double stress) { return FRICTION; }"


def friction_of(folder, value, name="law"):
    """Return a law of the same name whose function returns a value."""
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.c").write_text(CHANGED.replace("FRICTION", value))
    command = [COMPILER, "-O2", "-shared", "-fPIC", f"{name}.c", "-o", f"{name}.so"]
    subprocess.run(command, cwd=folder, check=True)
    function = ctypes.CDLL(str(folder / f"{name}.so")).constant
    return Laws("rough", friction={"panel": ctypes.cast(function, LAW_PROTOTYPES["friction"])})


def begun(scene, laws):
    simulation = Simulation(scene, laws=laws)
    simulation.begin_event()
    return simulation


def notes_on(action):
    with pytest.warns(SnowshedNote) as log:
        action()
    return [str(note.message) for note in log if "rough;" in str(note.message)]


def test_a_changed_law_of_the_same_name_is_told(tiny, tmp_path):
    then = friction_of(tmp_path / "then", "0.3")
    same, changed = friction_of(tmp_path / "same", "0.3"), friction_of(tmp_path / "changed", "0.4")
    assert then.digest("double") == same.digest("double") != changed.digest("double")
    notes_on(lambda: run(tiny, tmp_path / "out", laws=then, pictures=False))
    begun(tiny, then).save(tmp_path / "saved.bin")
    again = [
        lambda laws: Simulation.load(tmp_path / "out/checkpoint.bin", laws=laws),
        lambda laws: Simulation.load(tmp_path / "saved.bin", laws=laws),
        lambda laws: run(tmp_path / "out/run.json", None, laws=laws, pictures=False),
    ]
    for repeat in again:
        usual = notes_on(partial(repeat, same))
        assert usual and not any("code has changed" in note for note in usual)
        assert any("code has changed since" in note for note in notes_on(partial(repeat, changed)))


def test_a_run_that_resumes_with_a_changed_law_says_so_in_its_record(tiny, tmp_path):
    laws, stop = friction_of(tmp_path / "then", "0.3"), interrupt_at(2, 0.0)
    with pytest.raises(Interrupted), pytest.warns(SnowshedNote):
        run(tiny, tmp_path / "out", laws=laws, pictures=False, progress=stop)
    changed = friction_of(tmp_path / "now", "0.4")
    results = run(tiny, tmp_path / "out", laws=changed, pictures=False, resume=True)
    assert any("their code has changed since" in note for note in results.run["notes"])


def test_a_law_without_known_code_is_told_as_such(tiny, tmp_path):
    def rough(speed, stress):
        return 0.3

    laws = Laws("rough", friction={"panel": LAW_PROTOTYPES["friction"](rough)})
    assert laws.digest("double") is None
    begun(tiny, laws).save(tmp_path / "saved.bin")
    notes = notes_on(lambda: Simulation.load(tmp_path / "saved.bin", laws=laws))
    assert any("known by this name only" in note for note in notes)


def test_a_law_of_numba_is_known_by_its_source_and_its_values():
    numba = pytest.importorskip("numba")

    def digest(friction):
        @numba.cfunc("float64(float64, float64)")
        def rough(speed, stress):
            return friction

        return Laws("rough", friction={"panel": rough}).digest("double")

    assert digest(0.3) is not None and digest(0.3) == digest(0.3) != digest(0.4)
