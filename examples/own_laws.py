"""Laws of one's own: two laws of the snow, friction, a body force and a motion, compiled from C.

Usage: python own_laws.py [folder] [dx in metres]
"""

import ctypes
import subprocess
import sys
from pathlib import Path

from snowshed import Scene, run_events
from snowshed.running import LAW_PROTOTYPES, Laws

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "own-laws")
dx = float(sys.argv[2]) if len(sys.argv) > 2 else 0.01
folder.mkdir(exist_ok=True)

# Any compiler will do; numba.cfunc makes such functions from Python.
source, library = Path(__file__).with_suffix(".c"), folder.absolute() / "own_laws.so"
subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
compiled = ctypes.CDLL(str(library))


def function(name, kind):
    """Return a function of the library with the type of a law."""
    return ctypes.cast(getattr(compiled, name), LAW_PROTOTYPES[kind])


every_law = {
    "sand": {"material": function("drucker_prager_2d", "material_float")},
    "brittle": {"constitutive": function("brittle_2d", "constitutive_float"), "own_numbers": 1},
    "film of water": {"friction": {"panel": function("melting", "friction")}},
    "wind": {"body_force": function("wind", "body_force")},
    "earthquake": {"motion": {"panel": function("shaking", "motion")}},
}
scene = Scene.preset("lab-50").with_(
    {"dimension": 2, "numerics.dx": dx, "numerics.precision": "float", "events.count": 1}
)
print("laws            event  height, m  length, m")
for name, law in every_law.items():
    table = run_events(scene, folder / name.replace(" ", "-"), laws=Laws(name, **law))
    last = table.iloc[-1]
    print(f"{name:15s} {last.event:5d} {last.height_m:10.3f} {last.length_m:10.3f}")
