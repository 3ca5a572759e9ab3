"""Import results folders of the laboratory into the recorded stacks.

``python -m validation.laboratory.lab_import --machine NAME --date DAY FOLDER...`` reads runs that
other programs made, such as ``snowshed-run`` on a larger machine, and writes them into
``lab_stack.json``. A folder is accepted only if `record` would make the same scene, so that the run
can be repeated. Stacks are measured from the stored particles.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Mapping
from itertools import accumulate
from pathlib import Path
from typing import Any

import click

from snowshed._core import InputError
from snowshed.results.event_particles import EventParticles, read_event_particles
from snowshed.results.folder import RunFolder
from snowshed.scene.scene import ResolvedScene
from snowshed.snow.accuracy.measurements import CaseSettings
from snowshed.snow.stack.measure import StackMeasure
from snowshed.study.scene_hash import RunKey
from validation.laboratory.lab_records import (
    FILE,
    REFERENCES,
    entry,
    is_of,
    keys_of,
    read_entries,
    write_entries,
)
from validation.laboratory.lab_stack import Cost, LabRun, lab_scene, measure_lab

#: Settings that identify an entry.
SETTINGS = ("dimension", "dx", "seed", "events", "scheme", "sleep_speed")


def imported(folder: Path, machine: str, date: str) -> dict[str, Any]:
    """Return the entry of a results folder for the recorded stacks.

    Parameters
    ----------
    folder
        The results of one run.
    machine, date
        Machine and date of the run.

    Raises
    ------
    InputError
        If the run is not finished or does not belong to `REFERENCES`.
    """
    results = RunFolder(folder)
    facts = results.read_run()
    if facts.get("status") != "finished":
        raise InputError(f"{folder}: the run is not finished")
    settings = settings_of(ResolvedScene.load(results.scene), str(folder))
    run, counts = LabRun(), []
    for _, particles in read_event_particles(folder):
        run.stacks.append(_measured(particles))
        counts.append(len(particles.masses))
    events = facts["finished_events"]
    costs = _costs(events, counts, int(facts["particle_updates"]), alone=facts["threads"] == 1)
    origin = (str(facts["version"]), date, machine)
    return entry(settings, run, [event["ended"] for event in events], costs, origin)


def settings_of(scene: ResolvedScene, where: str) -> CaseSettings:
    """Return the settings with which `record` makes the run of a scene.

    Raises
    ------
    InputError
        If no recorded run has this scene.
    """
    numerics = scene.data["numerics"]
    place = (scene.data["dimension"], numerics["dx"], scene.data["seeding"]["seed"])
    reference = REFERENCES[numerics["scheme"]]
    for grid in reference.grids:
        for key in keys_of(grid, reference.settings):
            if place == (key["dimension"], key["dx"], key["seed"]) and (
                RunKey.of(lab_scene(key).resolve()).hash == RunKey.of(scene).hash
            ):
                return key
    raise InputError(f"{where}: the scene is that of no recorded run")


def _measured(particles: EventParticles) -> StackMeasure:
    return measure_lab(
        particles.positions,
        particles.masses,
        particles.densities,
        particles.on_panel,
        particles.dimension,
        particles.dx,
    )


def _costs(
    events: Iterable[Mapping[str, Any]], particles: Iterable[int], updates: int, *, alone: bool
) -> list[Cost]:
    """Return the cost up to the end of each event; updates are known only for the whole run."""
    event_rows = list(events)
    steps = accumulate(int(event["steps"]) for event in event_rows)
    times = accumulate(float(event["wall_s"]) if alone else 0.0 for event in event_rows)
    costs = [Cost(*cost) for cost in zip(times, [0] * len(event_rows), steps, particles)]
    last = costs[-1]
    return [*costs[:-1], Cost(last.wall_s, updates, last.steps, last.particles)]


@click.command()
@click.option("--machine", required=True, help="Machine that made the runs.")
@click.option("--date", default=datetime.date.today().isoformat(), help="Day of the runs.")
@click.argument("folders", nargs=-1, type=click.Path(exists=True, path_type=Path))
def main(machine: str, date: str, folders: tuple[Path, ...]) -> None:
    """Import results folders into the recorded stacks."""
    runs = read_entries(FILE)
    for folder in folders:
        new = imported(folder, machine, date)
        key = {name: value for name, value in new.items() if name in SETTINGS}
        runs = [run for run in runs if not is_of(run, key)] + [new]
    write_entries(runs, FILE)


if __name__ == "__main__":
    main()
