"""The material point method."""

from snowshed.methods.method import Method
from snowshed.methods.mpm.settings import MpmSettings

METHOD = Method(
    name="mpm",
    title="Snow in motion",
    settings=MpmSettings,
    run="snowshed.running.stack_run:StackRun",
    results={"stack": "snowshed.results.event_particles:last_stack"},
    ages=True,
    has_grid=True,
)
