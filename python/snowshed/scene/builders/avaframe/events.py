"""Dams and time-dependent releases of AvaFrame's projects, as AvaFrame 2.1 takes them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.notes import InputNote, issue_note
from snowshed.scene.builders.avaframe.ini import ProjectSettings
from snowshed.scene.builders.hydrographs import read_hydrograph
from snowshed.scene.terrain_components import Inflow, Pulse, Terrain


def time_dependent_release(file: Path, project: ProjectSettings) -> list[Pulse]:
    """Return the pulses of a hydrograph, the first at the start."""
    if project.release_thickness is not None:
        raise InputError(f"{file}: timeDependentRelease needs relThFromFile = True")
    pulses = read_hydrograph(file)
    if pulses[0].time != 0.0:
        raise InputError(f"{file}: AvaFrame needs a row for the time 0")
    return pulses


def set_inflows(terrain: Terrain, pulses: Sequence[Pulse]) -> None:
    """Let the snow of a hydrograph enter the release areas after that of its first row."""
    terrain.release_speed = pulses[0].speed
    areas = terrain.release or []
    if len(pulses) < 2:
        return
    terrain.inflows = [
        Inflow(name=area.name, outline=area.outline, hydrograph=list(pulses[1:])) for area in areas
    ]
    if len(areas) > 1:
        issue_note(
            f"{len(areas)} release areas: the later snow is seeded area by area, and in AvaFrame "
            "in all areas together; their numbers of particles may differ",
            InputNote,
        )


def set_dam(terrain: Terrain, project: ProjectSettings, file: Optional[Path]) -> None:
    """Set what AvaFrame takes from the ini, and refuse dams that it does not take."""
    if file is None or not terrain.dams:
        return
    if len(terrain.dams) > 1:
        raise InputError(f"{file}: {len(terrain.dams)} lines; AvaFrame takes one dam")
    (dam,) = terrain.dams
    if "slope" not in dam.given():
        raise InputError(f'{file}: the dam needs a field "slope", degrees')
    dam.restitution = float(int(project.restitution))
    if dam.restitution != project.restitution:
        issue_note(
            f"restitutionCoefficient = {project.restitution:g} is taken as 0, as in AvaFrame 2.1, "
            "which cuts it to a whole number",
            InputNote,
        )
