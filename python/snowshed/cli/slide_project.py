"""Running an AvaFrame project folder on the command line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.interrupt import deferred_interrupts
from snowshed.base.notes import held_notes, issue_notes_on_failure
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.cli.options.same_command import same_command
from snowshed.cli.options.slide_files import notes_for_summary, refuse_changed_areas
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.output.terminal import say
from snowshed.cli.run_scene import run_scene
from snowshed.io.raster.output import MapFormat
from snowshed.scene.builders.terrain_copy import copies_removed_on_failure, terrain_copy
from snowshed.scene.scene import ResolvedScene

if TYPE_CHECKING:
    from snowshed.scene.builders.avaframe.project import AvaFrameSimulation


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
    map_format: MapFormat = "ascii",
) -> None:
    """Run the simulations of an AvaFrame project.

    The results of the first simulation, with all areas, are in `folder`; those of the others are in
    subfolders with their names. ``Inputs`` and ``Outputs`` in `folder` are those of an AvaFrame
    project.

    Raises
    ------
    Stopped
        After an interruption; the message names the command that resumes all of them.
    Failed
        If results cannot be written after a simulation has ended.
    """
    from snowshed.results.avaframe import simulation_name

    with copies_removed_on_failure(folder):
        with held_notes() as notes:
            simulations = _simulations(project, folder, settings, thickness, max_time)
            scenes = [_resolve_scene(simulation) for simulation in simulations]
        in_summary = notes_for_summary(notes, *(simulation.scene for simulation in simulations))
        if not resume:
            _check_others(simulations[1:], scenes[1:])
        with _naming_this_command(folder), issue_notes_on_failure(in_summary):
            for number, simulation in enumerate(simulations):
                results = folder if number == 0 else folder / simulation_name(simulation)
                if len(simulations) > 1 and not quiet:
                    say(f"{simulation.release}, {simulation.sim_type}:")
                resumes = resume and (number == 0 or (results / "scene.json").exists())
                if resumes:
                    refuse_changed_areas(scenes[number], results, simulation.files)
                with _locating_in_ini(simulation), deferred_interrupts() as interrupt:
                    run_scene(scenes[number], results, resumes, quiet, map_format)
                if interrupt.requested:  # an interrupt came while pictures were drawn
                    raise KeyboardInterrupt
                _write_outputs(simulation, folder, results, scenes[number], steps)


def print_project_cost(
    project: Path,
    folder: Path,
    *,
    quiet: bool,
    settings: Mapping[str, object],
    thickness: Optional[float],
    max_time: Optional[float],
) -> None:
    """Print the cost of each simulation of an AvaFrame project."""
    for simulation in _simulations(project, folder, settings, thickness, max_time):
        if not quiet:
            say(f"{simulation.release}, {simulation.sim_type}:")
        print_cost(_resolve_scene(simulation))


def _simulations(
    project: Path,
    folder: Path,
    settings: Mapping[str, object],
    thickness: Optional[float],
    max_time: Optional[float],
) -> list[AvaFrameSimulation]:
    from snowshed.scene.builders.avaframe.project import avaframe_simulations

    simulations = avaframe_simulations(
        project, settings=settings, thickness=thickness, ascii_copy=terrain_copy(folder)
    )
    if max_time is not None:
        for simulation in simulations:
            simulation.scene.set("events.max_time", max_time)
    return simulations


def _resolve_scene(simulation: AvaFrameSimulation) -> ResolvedScene:
    with _locating_in_ini(simulation):
        return simulation.scene.resolve()


def _check_others(
    simulations: Sequence[AvaFrameSimulation], scenes: Sequence[ResolvedScene]
) -> None:
    """Refuse errors of later simulations before the first one runs."""
    for simulation, scene in zip(simulations, scenes):
        with _locating_in_ini(simulation):
            _core.Simulation(scene.core, scene.base_dir)


@contextmanager
def _locating_in_ini(simulation: AvaFrameSimulation) -> Iterator[None]:
    """Add the position in the ini file to errors of settings."""
    try:
        yield
    except InputError as error:
        raise simulation.project.located(error) from None


@contextmanager
def _naming_this_command(folder: Path) -> Iterator[None]:
    """Replace the hint after an interruption by a command that resumes all simulations."""
    try:
        yield
    except (Stopped, KeyboardInterrupt):
        if not (folder / "scene.json").exists():
            raise  # there is nothing to resume
        raise Stopped(f"interrupted; resume with: {same_command('--resume')}") from None


def _write_outputs(
    simulation: AvaFrameSimulation,
    folder: Path,
    results: Path,
    scene: ResolvedScene,
    steps: Sequence[int],
) -> None:
    """Write the outputs of AvaFrame beside the results; errors do not count as bad input."""
    from snowshed.results.avaframe import write_avaframe_outputs
    from snowshed.scene.builders.avaframe.files import copy_inputs

    try:
        copy_inputs(simulation.inputs, folder)
        write_avaframe_outputs(folder, simulation, results)
        if steps:
            write_particles(scene, results, steps)
    except InputError as error:
        raise Failed(
            f"{folder}: the slide has ended, but its outputs could not be written: {error}"
        ) from None


def write_particles(scene: ResolvedScene, folder: Path, steps: Sequence[int]) -> None:
    """Write tables of the particles after given steps into a results folder."""
    from snowshed.io.csv_table import write_csv
    from snowshed.methods import slide_states
    from snowshed.results.avaframe import particle_table

    for state in slide_states(scene, steps=steps):
        name = "particles_initial" if state.steps == 0 else f"particles_step{state.steps:05d}"
        write_csv(particle_table(state.quantities), folder / f"{name}.csv", float_format="%.10g")
