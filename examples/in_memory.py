"""A slab slides off in memory, without a folder: its front, its fields, and snow thrown in.

    python examples/in_memory.py [FOLDER [DX]]

The particles are read while they move; only their final state goes to a file, FOLDER/last.bin.
"""

import sys
from pathlib import Path

import numpy as np

from snowshed import Scene, Simulation


def main(folder: str = "in-memory", dx: float = 0.01) -> None:
    """Run one event, print the particles' motion, and store their final state in `folder`."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": dx})
    simulation = Simulation(scene)
    simulation.begin_event()

    speed = simulation.fields["velocity"]  # each access reads the present values
    print(f"{simulation.particle_count} particles; velocity in {speed.unit}")
    for time in (0.1, 0.2, 0.3):
        simulation.run(until=time)
        fastest = np.linalg.norm(speed.values, axis=1).max()
        print(f"t = {simulation.time:.2f} s: the fastest moves at {fastest:.2f} m/s")

    x, z = np.meshgrid(np.arange(0.4, 0.45, dx / 2), np.arange(0.5, 0.55, dx / 2))
    simulation.add_snow(np.column_stack([x.ravel(), z.ravel()]), velocity=(0, -1))

    landed = simulation.run(until=lambda now: bool((~now.on_panel()).all()))
    print(f"event {simulation.event}: off the panel, {landed}, at t = {simulation.time:.2f} s")
    simulation.run()
    stack = simulation.measure()
    print(f"a stack of {stack.height:.3f} m by {stack.length:.3f} m, {stack.mass:.1f} kg")

    Path(folder).mkdir(parents=True, exist_ok=True)
    simulation.save(Path(folder) / "last.bin")
    print(f"as it was left: {Simulation.load(Path(folder) / 'last.bin')}")


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:3]))
