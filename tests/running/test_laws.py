"""Laws of one's own, compiled by the C compiler that builds snowshed."""

import ctypes
import shutil
import subprocess
from contextlib import nullcontext

import numpy as np
import pytest

from snowshed import InputError, Scene, Simulation, SnowshedNote, run
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
void lift(int64_t n, const double* x, const double* y, const double* z, double t,
          double* ax, double* ay, double* az) {
  for (int64_t i = 0; i < n; ++i) az[i] = 9.81;
}
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    folder = tmp_path_factory.mktemp("laws")
    (folder / "laws.c").write_text(SOURCE)
    command = [COMPILER, "-O2", "-shared", "-fPIC", "laws.c", "-o", "laws.so"]
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
