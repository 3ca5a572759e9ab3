"""Deviations of the default settings from the thesis, each with its reason.

The preset ``thesis`` undoes all deviations; each can be undone alone. A choice where the thesis
leaves a value open, such as the panel's friction, is not a deviation; the docs state these choices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Optional

from snowshed._core import InputError
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING

#: Stands for all deviations together.
ALL = "all"
#: Frames of an event by the thesis's chapters: Tables 3.2.1, 4.1.1, 5.1.1.
FRAMES: Mapping[int, int] = {3: 50, 4: 60, 5: 100}
#: Frames in a second, which is not published, but usual.
FRAME_RATE = 24.0
#: Size of the thesis's grid cells, m.
THESIS_DX = 0.01


@dataclass(frozen=True)
class Deviation:
    """A deviation from the thesis.

    Attributes
    ----------
    name
        Name of the deviation in options.
    thesis, here, reason
        Choice of the thesis, our default, and its reason; sentences.
    settings
        Settings of the thesis by dotted paths; those of ``frames`` hold for chapter 5.
    trimming
        The trimming rule (A.4.2) for measuring stacks, if the deviation changes it.
    """

    name: str
    thesis: str
    here: str
    reason: str
    settings: Mapping[str, object] = field(default_factory=dict)
    trimming: Optional[str] = None

    @property
    def simulated(self) -> bool:
        """Whether the deviation changes the simulation, and not only the measuring."""
        return self.trimming is None


DEVIATIONS: Mapping[str, Deviation] = {
    deviation.name: deviation
    for deviation in (
        Deviation(
            "slip",
            "The panel is SLIP: the normal speed of snow on it is zero.",
            "Snow may leave the panel's face.",
            "With SLIP taken literally, snow leaves the panel's plane only over its edge, and the "
            "rear of a slab that tips over the edge is held down.",
            {"panel.condition": "slip"},
        ),
        Deviation(
            "damping",
            "FLIP has a share of 0.99 per step, for any size of step.",
            "Panels of chapter 5 are damped at the rate of this share with the thesis's cells.",
            "A share in each step makes the damping depend on the step, and so on the cells: a "
            "shorter step damps more.",
            {"numerics.transfer": "flip", "numerics.flip_ratio": 0.99},
        ),
        Deviation(
            "reseed",
            "Between events, the stack becomes a solid and is reseeded.",
            "The particles stay as they are.",
            "Reseeding heals broken bonds, discards compaction, and moves the stack.",
            {"events.between": "reseed"},
        ),
        Deviation(
            "grid",
            "Cells of 1 cm.",
            "Cells of 1.5 cm for the panels of chapter 5, 1 cm elsewhere.",
            "Cells of 1 cm take 3.4 times as long; we use this time for more seedings.",
            {"numerics.dx": THESIS_DX},
        ),
        Deviation(
            "frames",
            "An event is over after 50, 60 and 100 frames in chapters 3, 4 and 5: "
            "2.1, 2.5 and 4.2 s at 24 frames a second (the rate is not printed).",
            "An event is over when the snow rests.",
            "A long slab on a rough panel slides longer than that, and snow in motion is no stack "
            "yet.",
            {"events.max_time": FRAMES[5] / FRAME_RATE},
        ),
        Deviation(
            "trimming",
            "The second sentence of A.4.2, taken literally: both ends of a 2D stack step inward by "
            "the same increment.",
            "The particle farthest from the centre of mass is dropped first, as in the first "
            "sentence and in the 3D rule.",
            "If snow has rolled far off, equal steps take the 3 % from the dense end; the length "
            "of a stack then scatters more from seeding to seeding.",
            trimming="equal_pace",
        ),
    )
}


def deviations_named(names: Sequence[str]) -> list[Deviation]:
    """Return deviations in their order; "all" stands for every one.

    Raises
    ------
    InputError
        If a name is unknown.

    Examples
    --------
    >>> [deviation.name for deviation in deviations_named(["frames", "slip"])]
    ['slip', 'frames']
    """
    for name in names:
        if name not in DEVIATIONS and name != ALL:
            allowed = ", ".join([*DEVIATIONS, ALL])
            raise InputError(f"deviation: {name!r} is unknown; allowed: {allowed}")
    return [deviation for deviation in DEVIATIONS.values() if {deviation.name, ALL} & set(names)]


def deviating_settings(chapter: int, names: Sequence[str] = (ALL,)) -> dict[str, object]:
    """Return the settings of deviations in a scene, by default those of the preset ``thesis``.

    Parameters
    ----------
    chapter
        Chapter of the thesis: 3, 4 (with the laboratory of chapter 2) or 5.
    names
        Names of the deviations.

    Returns
    -------
    dict
        Values by dotted paths, as `snowshed.Scene.update` takes them.

    Raises
    ------
    InputError
        If there is no such chapter or deviation.

    Examples
    --------
    >>> deviating_settings(4, ["frames"])
    {'events.max_time': 2.5}
    """
    if chapter not in FRAMES:
        raise InputError(f"chapter: {chapter!r}; allowed: {', '.join(map(str, FRAMES))}")
    settings: dict[str, object] = {}
    for deviation in deviations_named(names):
        settings.update(deviation.settings)
    if "events.max_time" in settings:
        settings["events.max_time"] = FRAMES[chapter] / FRAME_RATE
    return settings


def deviating_trimming(names: Sequence[str] = (ALL,)) -> str:
    """Return the trimming rule of A.4.2 by which stacks are measured with some deviations."""
    named = (deviation.trimming for deviation in deviations_named(names))
    return next((trimming for trimming in named if trimming), DEFAULT_TRIMMING)
