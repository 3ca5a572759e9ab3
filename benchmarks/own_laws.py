"""Compare the time of a step with laws of one's own, compiled from C, and with the built-in ones.

Usage: python -m benchmarks.own_laws

A body of 100 000 particles hits the ground, so that nearly all yield. The cases alternate on one
thread, and the processor time of the fastest of five repetitions counts; nothing else should run on
the machine meanwhile.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import time
import warnings
from typing import Any, Optional

from snowshed import Scene, Simulation, SnowshedNote
from snowshed.running import LAW_PROTOTYPES, Laws

REPETITIONS, STEPS = 5, 100
SOURCE = "examples/own_laws.c"


def body(dimension: int) -> Scene:
    """Return a body of about 100 000 particles above the ground."""
    plane = dimension == 2
    box = {"type": "box", "center": [0, 0.6] if plane else [0, 0, 0.5],
           "size": [2.0, 1.05] if plane else [1.0, 0.5, 0.82]}  # fmt: skip
    return Scene.from_data(
        {
            "snowshed": 2,
            "dimension": dimension,
            "bodies": [{"shape": box, "velocity": [0, -4] if plane else [0, 0, -4]}],
            "ground": {},
            "numerics": {"dx": 0.0112 if plane else 0.032, "sleep_speed": 0, "threads": 1},
        }
    ).set("numerics.precision", "float")


def laws_of(library: ctypes.CDLL, dimension: int) -> dict[str, Optional[Laws]]:
    """Return the laws that are compared, by name."""

    def function(name: str, kind: str) -> Any:
        return ctypes.cast(getattr(library, name), LAW_PROTOTYPES[kind])

    material = function(f"drucker_prager_{dimension}d", "material_float")
    tensor = function(f"drucker_prager_tensor_{dimension}d", "constitutive_float")
    brittle = {}
    if dimension == 2:
        law = function("brittle_2d", "constitutive_float")
        brittle["brittle, tensor"] = Laws("brittle", constitutive=law, own_numbers=1)
    return {
        "built-in": None,
        "Drucker-Prager": Laws("material", material=material),
        "Drucker-Prager, tensor": Laws("tensor", constitutive=tensor),
        **brittle,
        "friction": Laws("friction", friction={"ground": function("melting", "friction")}),
        "body force": Laws("force", body_force=function("wind", "body_force")),
    }


def main() -> None:
    """Print the ratios of the times."""
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/laws.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", SOURCE, "-o", file, "-lm"], check=True)
        library = ctypes.CDLL(file)
    for dimension in (2, 3):
        fastest: dict[str, float] = {}
        for _ in range(REPETITIONS):
            for name, laws in laws_of(library, dimension).items():
                simulation = Simulation(body(dimension), laws=laws)
                simulation.begin_event()
                simulation.step(40)
                started = time.process_time()
                simulation.step(STEPS)
                taken = time.process_time() - started
                fastest[name] = min(fastest.get(name, taken), taken)
        ratios = ", ".join(f"{n} {t / fastest['built-in']:.3f}" for n, t in fastest.items())
        print(f"{dimension}D, {simulation.particle_count} particles: {ratios}")


if __name__ == "__main__":
    warnings.simplefilter("ignore", SnowshedNote)
    main()
