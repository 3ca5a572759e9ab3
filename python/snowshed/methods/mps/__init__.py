"""The moving particle semi-implicit method."""

from snowshed.methods.method import Method
from snowshed.methods.mps.settings import MpsSettings

METHOD = Method(
    name="mps",
    title="Flowing snow",
    settings=MpsSettings,
    run="snowshed.running.stack_run:StackRun",
    results={
        "stack": "snowshed.results.event_particles:last_stack",
        "forces": "snowshed.results.obstacle_forces:read_forces",
        "loads": "snowshed.results.obstacle_forces:read_loads",
        "pressures": "snowshed.results.obstacle_forces:read_pressures",
    },
    in_memory={"forces": "snowshed.results.obstacle_forces:present_forces"},
)
