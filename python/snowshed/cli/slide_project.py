"""Running an AvaFrame project folder on the command line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.interrupt import deferred_interrupts
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.cli.run_scene import run_scene
from snowshed.cli.same_command import same_command
from snowshed.cli.slide_files import refuse_changed_areas, removing_copies, terrain_copy
from snowshed.cli.terminal import say
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    from snowshed.scene.builders.avaframe import AvaFrameSimulation


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

    Raises
    ------
    Stopped
        After an interruption; the message names the command that goes on with all of them.
    Failed
        If results cannot be written after a simulation has ended.
    """
    from snowshed.results.avaframe import simulation_name
    from snowshed.scene.builders.avaframe import avaframe_simulations

    with removing_copies(folder):
        simulations = avaframe_simulations(
            project, settings=settings, thickness=thickness, ascii_copy=terrain_copy(folder)
        )
        if max_time is not None:
            for simulation in simulations:
                simulation.scene.set("events.max_time", max_time)
        ready = [_resolved(simulation) for simulation in simulations]
        if not resume:
            _check_others(simulations[1:], ready[1:])
        with _naming_this_command(folder):
            for number, simulation in enumerate(simulations):
                results = folder if number == 0 else folder / simulation_name(simulation)
                if len(simulations) > 1 and not quiet:
                    say(f"{simulation.release}, {simulation.sim_type}:")
                goes_on = resume and (number == 0 or (results / "scene.json").exists())
                if goes_on:
                    refuse_changed_areas(ready[number], results, simulation.files)
                with _of_the_ini(simulation), deferred_interrupts() as interrupt:
                    run_scene(ready[number], results, goes_on, quiet)
                if interrupt.requested:  # while its pictures were drawn
                    raise KeyboardInterrupt
                _write_outputs(simulation, folder, results, ready[number], steps)


def _resolved(simulation: AvaFrameSimulation) -> ResolvedScene:
    with _of_the_ini(simulation):
        return simulation.scene.resolve()


def _check_others(
    simulations: Sequence[AvaFrameSimulation], ready: Sequence[ResolvedScene]
) -> None:
    """Refuse what a later simulation cannot run with before the first has its results."""
    for simulation, scene in zip(simulations, ready):
        with _of_the_ini(simulation):
            _core.Simulation(scene.core, scene.base_dir)


@contextmanager
def _of_the_ini(simulation: AvaFrameSimulation) -> Iterator[None]:
    """Say where in the ini a setting stands that is refused."""
    try:
        yield
    except InputError as error:
        raise simulation.project.located(error) from None


@contextmanager
def _naming_this_command(folder: Path) -> Iterator[None]:
    """Let the hint after an interruption go on with all simulations, not with one of them."""
    try:
        yield
    except (Stopped, KeyboardInterrupt):
        if not (folder / "scene.json").exists():
            raise  # nothing is there to go on with
        raise Stopped(f"interrupted; go on with: {same_command('--resume')}") from None


def _write_outputs(
    simulation: AvaFrameSimulation,
    folder: Path,
    results: Path,
    ready: ResolvedScene,
    steps: Sequence[int],
) -> None:
    """Write what AvaFrame has beside the results; what is wrong now is no fault of the input."""
    from snowshed.results.avaframe import write_avaframe_outputs
    from snowshed.scene.builders.avaframe_files import copy_inputs

    try:
        copy_inputs(simulation.inputs, folder)
        write_avaframe_outputs(folder, simulation, results)
        if steps:
            write_particles(ready, results, steps)
    except InputError as error:
        raise Failed(
            f"{folder}: the slide has ended, its outputs are not written: {error}"
        ) from None


def write_particles(ready: ResolvedScene, folder: Path, steps: Sequence[int]) -> None:
    """Write the particles after some steps to tables in a results folder."""
    from snowshed.io.csv_table import write_csv
    from snowshed.running.slide_states import particles_at

    for step, table in particles_at(ready, steps).items():
        name = "particles_initial" if step == 0 else f"particles_step{step:05d}"
        write_csv(table, folder / f"{name}.csv", float_format="%.10g")
