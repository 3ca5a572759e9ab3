"""The moving particle semi-implicit method."""

from snowshed.methods.method import Method
from snowshed.methods.mps.settings import MpsSettings

METHOD = Method(
    name="mps",
    title="Flowing snow",
    settings=MpsSettings,
    run="snowshed.running.stack_run:StackRun",
    results={"stack": "snowshed.results.event_particles:last_stack"},
)
