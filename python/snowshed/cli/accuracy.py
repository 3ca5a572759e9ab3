"""The option ``--accuracy``: grid and scheme for a wanted accuracy, from recorded measurements.

Accuracy means the errors of the stack's height and length. They are recorded for runs of the
laboratory experiment on several grids and with several schemes. The size of cells counts relative
to the thickness of the slab, because the number of cells across the slab decides how well it bends
and breaks, and every layer adds a gap of about a cell to the height.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.formatting import percent
from snowshed.cli.scene_options import option_name
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.registry import resolution_path
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.scene import Scene
from snowshed.scene.schema import current_path

if TYPE_CHECKING:
    from snowshed.analysis.accuracy.measurements import Measurement, Settings, Value

CASE = "stack_convergence"
QUANTITIES = ("height", "length")
PRESET = "lab-50"  # whose slab the case's stacks are made of
ORDER_IN = MpmSettings.RESOLUTION  # the case is one of the material point method


def part(text: str) -> float:
    """Return a fraction, given as ``5%`` or ``0.05``.

    Examples
    --------
    >>> [part(text) for text in ("5%", "0.05", "2.5 %")]
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
    type=part,
    metavar="PERCENT",
    help="Choose dx and scheme by how far the height and length of stacks may be off, such as 5%, "
    "from recorded runs.",
)


@dataclass(frozen=True)
class Choice:
    """Settings chosen for a wanted accuracy.

    Attributes
    ----------
    reached
        Whether the recorded runs with these settings were accurate enough.
    values
        Chosen values by their paths in a scene; None for a setting that keeps its default.
    reason
        The choice and its reason, in sentences.
    """

    reached: bool
    values: Mapping[str, Optional[Value]]
    reason: str


def choose(
    wanted: float, scene: Scene, measurements: Optional[Iterable[Measurement]] = None
) -> Choice:
    """Choose the quickest settings whose stacks were as accurate as wanted in recorded runs.

    If none was accurate enough, the most accurate settings are chosen, and the reason says so.

    Parameters
    ----------
    wanted
        Largest relative error of the stack's height and length.
    scene
        The scene that the settings are for; it needs a slab.
    measurements
        Measurements of the case `CASE`; by default those of the package.

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
    from snowshed.analysis.accuracy.recorded import load_recorded
    from snowshed.analysis.accuracy.solutions import quickest

    data = scene.resolve().data
    thickness = _slab_thickness(data)
    listed = load_recorded() if measurements is None else measurements
    stacks = _nearest(recorded_stacks(listed), data)
    if not stacks:
        raise InputError(
            "--accuracy: nothing is recorded to choose from; in the source of snowshed, "
            f"`python -m validation --full --case {CASE} --record FILE -o DIR` makes it"
        )
    costs, errors = [stack.wall_s for stack in stacks], [stack.error for stack in stacks]
    stack = stacks[quickest(costs, errors, wanted)]
    path = resolution_path(data)
    name = path.rpartition(".")[2]
    share = float(stack.settings[name]) / _slab_thickness(Scene.preset(PRESET).resolve().data)
    # A recorded run used the defaults of unnamed settings, so they must be defaults here, too.
    values = {where: stack.settings.get(key) for key, where in ACCURACY.items()}
    size = float(f"{share * thickness:.3g}")
    values[path] = size
    what = f"{name} {size:g} m ({share:.3g} of the slab's thickness)"
    reason = " ".join(
        [f"--accuracy {percent(wanted)}: {what}", *_reasons(stack, wanted, data, name)]
    )
    return Choice(stack.error <= wanted, values, reason)


def check_alone(options: Mapping[str, Any]) -> None:
    """Raise InputError if an option is given that ``--accuracy`` would override.

    Parameters
    ----------
    options
        Values by the names that `snowshed.cli.scene_options` gives them; None where not given.

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


@dataclass(frozen=True)
class RecordedStack:
    """Recorded errors of stacks made with the same settings.

    Attributes
    ----------
    errors
        Relative error of each of `QUANTITIES`, assured by all finer runs.
    spreads
        Standard deviation of each over random seedings, relative to the mean; empty if unknown.
    wall_s
        Time of the solution, s.
    """

    settings: Settings
    errors: Sequence[float]
    spreads: Sequence[float]
    wall_s: float

    @property
    def error(self) -> float:
        """The largest."""
        return max(self.errors)


def recorded_stacks(measurements: Iterable[Measurement]) -> list[RecordedStack]:
    """Return the recorded stacks."""
    from snowshed.analysis.accuracy.measurements import to_table
    from snowshed.analysis.accuracy.solutions import assured_errors, key_of, rows_of, solutions

    table = to_table(
        measurement
        for measurement in measurements
        if measurement.case == CASE and not measurement.failure
    )

    def by_settings(quantity: str, order_in: Optional[str]) -> dict[Hashable, float]:
        recorded = solutions(rows_of(table, CASE, quantity))
        return {key_of(o.settings): e for o, e in zip(recorded, assured_errors(recorded, order_in))}

    errors = [by_settings(name, ORDER_IN) for name in QUANTITIES]
    spreads = [by_settings(f"{name}_spread", None) for name in QUANTITIES]
    return [
        RecordedStack(
            settings=solution.settings,
            errors=[of_each[key] for of_each in errors],
            spreads=[of_each[key] for of_each in spreads if key in of_each],
            wall_s=solution.wall_s,
        )
        for solution in solutions(rows_of(table, CASE, QUANTITIES[0]))
        if all((key := key_of(solution.settings)) in of_each for of_each in errors)
    ]


def _slab_thickness(data: Mapping[str, Any]) -> float:
    if data.get("slab") is None:
        raise InputError(
            "--accuracy: the scene has no slab, whose thickness determines dx; give --dx"
        )
    slab = data["slab"]
    events = {layer["event"] for layer in slab["layers"]}
    of_each = [
        sum(layer["thickness"] for layer in slab["layers"] if layer["event"] in (0, event))
        for event in (events - {0} or {1})
    ]
    return float(slab["thickness"] or min(of_each))


def _nearest(stacks: list[RecordedStack], data: Mapping[str, Any]) -> list[RecordedStack]:
    """Return the stacks whose circumstances are nearest to those of the scene."""
    for name, mine in _circumstances(data).items():
        held = {stack.settings[name] for stack in stacks if name in stack.settings}
        if held:
            nearest = min(held, key=lambda value: (_distance(value, mine), value))
            stacks = [stack for stack in stacks if stack.settings.get(name) == nearest]
    return stacks


def _circumstances(data: Mapping[str, Any]) -> dict[str, Value]:
    events = data["events"]
    return {
        "dimension": data["dimension"],
        "between": events["between"],
        "events": events["count"],
    }


def _distance(value: Value, mine: Value) -> float:
    if isinstance(value, str) or isinstance(mine, str):
        return float(value != mine)
    return abs(value - mine)


def _reasons(stack: RecordedStack, wanted: float, data: Mapping[str, Any], name: str) -> list[str]:
    """Return the end of the first sentence, after the setting `name`, and the further sentences."""
    from snowshed.analysis.accuracy.setting_labels import settings

    scheme = {k: v for k, v in stack.settings.items() if k in ACCURACY and k != name}
    height, length = (percent(error, 2) for error in stack.errors)
    off = f"the height of the stack was off by {height} and its length by {length}"
    if stack.error <= wanted:
        why = f"These were the quickest in the recorded runs of {PRESET} to stay within it: {off}."
    else:
        why = f"No recorded run of {PRESET} was that accurate. In the best, which this is, {off}."
    reasons = [f"with {settings(scheme) or 'the default scheme'}.", why]
    if len(stack.spreads) == len(QUANTITIES):
        height, length = (percent(spread, 2) for spread in stack.spreads)
        reasons.append(f"Random seedings alone made them differ by {height} and {length}.")
    mine = _circumstances(data)
    other = {k: v for k, v in stack.settings.items() if k in mine and v != mine[k]}
    if other:
        reasons.append(f"Unlike this scene, those runs were made with {settings(other)}.")
    return reasons
