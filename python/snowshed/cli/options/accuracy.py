"""The option ``--accuracy``: grid and scheme for a wanted accuracy, from recorded measurements.

Accuracy means the errors of the stack's height and length. They are recorded for runs of the
laboratory experiment on several grids and with several schemes. Cell sizes are compared
relative to the thickness of the slab.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, nan
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.formatting import duration, percent
from snowshed.cli.options.scene import option_name
from snowshed.methods.registry import resolution_path
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.scene import Scene
from snowshed.scene.schema import current_path

if TYPE_CHECKING:
    from snowshed.snow.accuracy.measurements import MeasuredSolution, Value
    from snowshed.snow.accuracy.recorded_stacks import RecordedStack


def parse_fraction(text: str) -> float:
    """Return a fraction, given as ``5%`` or ``0.05``.

    Examples
    --------
    >>> [parse_fraction(text) for text in ("5%", "0.05", "2.5 %")]
    [0.05, 0.05, 0.025]
    """
    text = text.strip()
    try:
        value = float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        value = nan
    if not 0 < value < 1:
        raise click.BadParameter(f"{text!r} is not an accuracy; give a percentage such as 5%")
    return value


accuracy_option = click.option(
    "--accuracy",
    type=parse_fraction,
    metavar="PERCENT",
    help="Choose dx and scheme by the allowed error of a stack's height and length, such as 20%, "
    "from recorded runs.",
)


@dataclass(frozen=True)
class AccuracyChoice:
    """Settings chosen for a required accuracy.

    Attributes
    ----------
    reached
        Whether the recorded runs with these settings were accurate enough.
    values
        Chosen values by their paths in a scene; None for a setting that keeps its default.
    reason
        Sentences with the choice and its reason.
    """

    reached: bool
    values: Mapping[str, Optional[Value]]
    reason: str


def choose(
    wanted: float, scene: Scene, measurements: Optional[Iterable[MeasuredSolution]] = None
) -> AccuracyChoice:
    """Choose the quickest settings whose stacks were as accurate as wanted in recorded runs.

    The settings include the scheme. If none were accurate enough, the most accurate settings are
    chosen, and the reason says so.

    Parameters
    ----------
    wanted
        Largest relative error of the stack's height and length.
    scene
        The scene that the settings are for; it needs a slab.
    measurements
        Measurements of the case "stack_convergence"; by default those of the package.

    Raises
    ------
    InputError
        If the scene has no slab, or there are no measurements.

    Examples
    --------
    >>> choice = choose(0.2, Scene.preset("geometry"))
    >>> choice.values["numerics.dx"] > 0
    True
    """
    from snowshed.snow.accuracy.recorded import load_recorded
    from snowshed.snow.accuracy.recorded_stacks import (
        CASE,
        PRESET_THICKNESS,
        circumstances,
        nearest,
        recorded_stacks,
        slab_thickness,
    )

    data = scene.resolve().data
    thickness = slab_thickness(data)
    if thickness is None:
        raise InputError(
            "--accuracy: the scene has no slab, whose thickness determines dx; give --dx"
        )
    everything = recorded_stacks(load_recorded() if measurements is None else measurements)
    stacks = nearest(everything, circumstances(data))
    if not stacks:
        raise InputError(
            "--accuracy: nothing is recorded to choose from; in the source of snowshed, "
            f"`python -m validation --full --case {CASE} --record FILE -o DIR` makes it"
        )
    stack = best_of(stacks, wanted)
    path = resolution_path(data)
    name = path.rpartition(".")[2]
    share = float(stack.settings[name]) / PRESET_THICKNESS
    # Recorded runs had default values of unnamed settings; therefore these are defaults here, too.
    values = {where: stack.settings.get(key) for key, where in ACCURACY.items()}
    size = float(f"{share * thickness:.3g}")
    values[path] = size
    scheme = _settings_text(stack, name)
    what = f"{name} {size:g} m ({share:.3g} of the slab's thickness) with {scheme}"
    reasons = [
        f"--accuracy {percent(wanted)}: {_outcome(stack, wanted, what)}",
        *([] if measurements is not None else _all_panels(stack, 1.0 / share, data)),
        *_scatter(stack),
        *_other_schemes(stack, stacks, everything, wanted, name),
        *_differences(stack, data, thickness),
    ]
    return AccuracyChoice(stack.error <= wanted, values, " ".join(reasons))


def check_alone(options: Mapping[str, Any]) -> None:
    """Raise InputError if an option is given that ``--accuracy`` would override.

    Parameters
    ----------
    options
        Values by the names that `snowshed.cli.options.scene` gives them; None where not given.

    Examples
    --------
    >>> check_alone({"panel__tilt": 50.0, "numerics__basis": None})
    """
    for name, value in options.items():
        given = name.replace("__", ".")
        if value is not None and current_path(given) in ACCURACY.values():
            raise InputError(
                f"{option_name(given)}: --accuracy chooses grid and scheme; give one of the two"
            )


def best_of(stacks: Sequence[RecordedStack], wanted: float) -> RecordedStack:
    """Return the quickest recorded stack that is accurate enough, or else the most accurate."""
    from snowshed.snow.accuracy.solutions import quickest

    costs, errors = [stack.wall_s for stack in stacks], [stack.error for stack in stacks]
    return stacks[quickest(costs, errors, wanted)]


def _settings_text(stack: RecordedStack, name: str) -> str:
    """Return the scheme of a recorded stack, and its further settings except `name`."""
    from snowshed.snow.accuracy.mechanisms import SCHEME
    from snowshed.snow.accuracy.setting_labels import settings_label

    further = {k: v for k, v in stack.settings.items() if k in ACCURACY and k not in (name, SCHEME)}
    return ", ".join(filter(None, [f"scheme {_scheme(stack)}", settings_label(further)]))


def _scheme(stack: RecordedStack) -> str:
    from snowshed.snow.accuracy.mechanisms import scheme_of

    return scheme_of(stack.settings)


def _outcome(stack: RecordedStack, wanted: float, what: str) -> str:
    """Return sentences with the chosen settings and their errors."""
    from snowshed.snow.accuracy.recorded_stacks import PRESET

    height, length = (percent(error, 2) for error in stack.errors)
    errors_text = (
        f"the height of the stack was off by {height} and its length by {length}, relative to "
        "the finest recorded grid of the scheme."
    )
    if stack.error <= wanted:
        return (
            f"{what}. These were the quickest in the recorded runs of {PRESET} to stay within it: "
            f"{errors_text}"
        )
    share = ceil(100 * stack.error)
    return f"no recorded run of {PRESET} was that accurate. The best is {what}: {errors_text}" + (
        f" --accuracy {share}% chooses this grid." if share < 100 else ""
    )


def _all_panels(stack: RecordedStack, cells: float, data: Mapping[str, Any]) -> list[str]:
    """Return a sentence on the errors of all recorded panels, which may be larger than wanted."""
    from snowshed.snow.accuracy.mechanisms import Mechanisms
    from snowshed.snow.accuracy.panel_errors import panel_errors

    mechanisms = Mechanisms.of_settings(stack.settings)
    errors = panel_errors(mechanisms, cells, int(data["events"]["count"]))
    return [] if errors is None else [f"Errors of {errors.sentence}."]


def _scatter(stack: RecordedStack) -> list[str]:
    from snowshed.snow.accuracy.recorded_stacks import QUANTITIES

    if len(stack.spreads) != len(QUANTITIES):
        return []
    height, length = (percent(spread, 2) for spread in stack.spreads)
    return [f"Random seedings alone made them differ by {height} and {length}."]


def _other_schemes(
    chosen: RecordedStack,
    stacks: Sequence[RecordedStack],
    everything: Sequence[RecordedStack],
    wanted: float,
    name: str,
) -> list[str]:
    """Return a sentence for each other scheme: its accuracy, or that it has no such runs."""
    schemes = dict.fromkeys(map(_scheme, everything))
    return [
        _other_scheme(scheme, [s for s in stacks if _scheme(s) == scheme], chosen, wanted, name)
        for scheme in schemes
        if scheme != _scheme(chosen)
    ]


def _other_scheme(
    scheme: str,
    stacks: Sequence[RecordedStack],
    chosen: RecordedStack,
    wanted: float,
    name: str,
) -> str:
    if not stacks:
        return f"No runs of scheme {scheme} are recorded for such a scene."
    best = best_of(stacks, wanted)
    if best.error > wanted:
        return f"Scheme {scheme} stays within {percent(best.error, 2)} at best."
    elsewhere = "" if best.machine == chosen.machine else ", timed on another processor"
    return (
        f"Scheme {scheme} needed {name} {float(best.settings[name]):g} m and "
        f"{duration(best.wall_s)} for it in place of {duration(chosen.wall_s)}{elsewhere}."
    )


def _differences(stack: RecordedStack, data: Mapping[str, Any], thickness: float) -> list[str]:
    """Return sentences on the differences of the scene from the recorded one."""
    from snowshed.snow.accuracy.mechanisms import Mechanisms
    from snowshed.snow.accuracy.recorded_stacks import PRESET_THICKNESS, circumstances
    from snowshed.snow.accuracy.setting_labels import settings_label

    scene_circumstances = circumstances(data)
    other = {
        name: value
        for name, value in stack.settings.items()
        if name in scene_circumstances and value != scene_circumstances[name]
    }
    lengths = Mechanisms(_scheme(stack)).lengths_note(PRESET_THICKNESS, thickness)
    return [
        *(
            [f"Unlike this scene, those runs were made with {settings_label(other)}."]
            if other
            else []
        ),
        *([f"{lengths[0].upper()}{lengths[1:]}."] if lengths else []),
    ]
