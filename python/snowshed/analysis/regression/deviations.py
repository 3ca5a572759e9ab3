"""Settings of a published study of panels that may take the place of ours, by name.

The study is that of Frischholz (2023), whose data set has the same panels. All deviations together
are its settings.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from snowshed._core import InputError

#: Stands for all deviations together.
ALL = "all"
#: Frames of an event.
FRAMES = 100
#: Frames in a second, which is not published, but usual.
FRAME_RATE = 24.0
#: Settings by dotted paths. The trimming changes only how stacks are measured.
DEVIATIONS: Mapping[str, Mapping[str, object]] = {
    "slip": {"panel.condition": "slip"},
    "damping": {"numerics.transfer": "flip", "numerics.flip_ratio": 0.99},
    "reseed": {"events.between": "reseed"},
    "grid": {"numerics.dx": 0.01},
    "frames": {"events.max_time": FRAMES / FRAME_RATE},
    "trimming": {},
}


def deviations_named(names: Sequence[str]) -> list[str]:
    """Return the names of deviations in their order; "all" stands for every one.

    Raises
    ------
    InputError
        If a name is unknown.

    Examples
    --------
    >>> deviations_named(["frames", "slip"])
    ['slip', 'frames']
    """
    for name in names:
        if name not in DEVIATIONS and name != ALL:
            allowed = ", ".join([*DEVIATIONS, ALL])
            raise InputError(f"deviation: {name!r} is unknown; allowed: {allowed}")
    return [name for name in DEVIATIONS if name in names or ALL in names]


def deviating_settings(names: Sequence[str] = (ALL,)) -> dict[str, object]:
    """Return the settings of deviations, as `snowshed.Scene.update` takes them.

    Raises
    ------
    InputError
        If a name is unknown.

    Examples
    --------
    >>> deviating_settings(["grid", "slip"])
    {'panel.condition': 'slip', 'numerics.dx': 0.01}
    """
    settings: dict[str, object] = {}
    for name in deviations_named(names):
        settings.update(DEVIATIONS[name])
    return settings
