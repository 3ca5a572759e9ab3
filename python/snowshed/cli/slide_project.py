"""Running an AvaFrame project folder on the command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Optional

from snowshed.cli.run_scene import run_scene
from snowshed.cli.slide_files import refuse_changed_areas, removing_copies, terrain_copy
from snowshed.cli.terminal import say
from snowshed.scene.scene import ResolvedScene


def run_project(
    project: Path,
    folder: Path,
    *,
    resume: bool,
    quiet: bool,
    settings: Mapping[str, object],
    thickness: Optional[float],
    max_time: Optional[float],
    steps: Sequence[int],
) -> None:
    """Run the simulations of an AvaFrame project.

    The first, with all areas, has its results in `folder`, the others in folders of their names
    within; ``Inputs`` and ``Outputs`` in `folder` are those of an AvaFrame project.
    """
    from snowshed.run.avaframe_outputs import (
        copy_inputs,
        simulation_name,
        write_avaframe_outputs,
    )
    from snowshed.scene.builders.avaframe import avaframe_simulations

    with removing_copies(folder):
        simulations = avaframe_simulations(
            project, settings=settings, thickness=thickness, ascii_copy=terrain_copy(folder)
        )
        if max_time is not None:
            for simulation in simulations:
                simulation.scene.set("events.max_time", max_time)
        for number, simulation in enumerate(simulations):
            results = folder if number == 0 else folder / simulation_name(simulation)
            ready = simulation.scene.resolve()
            if len(simulations) > 1 and not quiet:
                say(f"{simulation.release}, {simulation.sim_type}:")
            goes_on = resume and (number == 0 or (results / "scene.json").exists())
            if goes_on:
                refuse_changed_areas(ready, results, simulation.files)
            run_scene(ready, results, goes_on, quiet)
            copy_inputs(project, folder)
            write_avaframe_outputs(folder, simulation, results)
            if steps:
                write_particles(ready, results, steps)


def write_particles(ready: ResolvedScene, folder: Path, steps: Sequence[int]) -> None:
    """Write the particles after some steps to tables in a results folder."""
    from snowshed.io.csv_table import write_csv
    from snowshed.run.slides import particles_at

    for step, table in particles_at(ready, steps).items():
        name = "particles_initial" if step == 0 else f"particles_step{step:05d}"
        write_csv(table, folder / f"{name}.csv", float_format="%.10g")
