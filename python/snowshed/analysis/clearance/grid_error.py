"""The error of the grid in required heights, from recorded stacks on several grids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from snowshed.analysis.accuracy.mechanisms import Mechanisms
from snowshed.analysis.accuracy.recorded import load_recorded
from snowshed.analysis.accuracy.recorded_stacks import recorded_stacks
from snowshed.analysis.accuracy.solutions import quickest
from snowshed.analysis.accuracy.stack_errors import (
    recorded_bias,
    resolved_biases,
    resolved_stacks,
)

#: Fewest cells across a slab.
MIN_CELLS = 2.0
ROUNDING = 1e-6
#: Number of slide-offs in a typical winter, for which recorded runs give the error.
TYPICAL_SLIDE_OFFS = 5


@dataclass(frozen=True)
class GridError:
    """The error of the shed snow's height by the grid.

    The snow was calibrated on a grid of its own, so a height may be too large or too small by it.

    Attributes
    ----------
    size
        Relative error in either direction, such as 0.15.
    source
        A clause on the runs from which it comes.
    """

    size: float
    source: str

    @property
    def text(self) -> str:
        """The error with its source, as a clause."""
        return f"a factor of up to {1.0 + self.size:.2f} on the height of shed snow: {self.source}"


@dataclass(frozen=True)
class GridChoice:
    """A scheme, and cells across the thinnest slab, with their recorded error.

    Attributes
    ----------
    scheme, cells
        The scheme, and the number of cells.
    error
        Relative error of the height in recorded runs, without its sign.
    """

    scheme: str
    cells: float
    error: float


def choose_grid(accuracy: float) -> GridChoice:
    """Return the quickest recorded grid whose height was as accurate as wanted.

    If none was, the most accurate is returned.

    Parameters
    ----------
    accuracy
        Largest relative error of the height, such as 0.2.

    Examples
    --------
    >>> choose_grid(0.2).scheme, choose_grid(0.4).scheme
    ('objective', 'thesis')
    """
    choices, costs = [], []
    for scheme in _recorded_schemes():
        stacks = resolved_stacks(2, TYPICAL_SLIDE_OFFS, Mechanisms(scheme))
        choices += [GridChoice(scheme, cells, abs(stacks[cells].biases[0])) for cells in stacks]
        costs += [stack.wall_s for stack in stacks.values()]
    return choices[quickest(costs, [choice.error for choice in choices], accuracy)]


def recorded_grid_error(scene: Mapping[str, Any], cells: float = MIN_CELLS) -> GridError:
    """Return the largest recorded error of the height with a scene's scheme.

    Grids with fewer cells in the slab are left out, except the finest. If nothing was recorded for
    the mechanisms of the scene, the error is the largest of all schemes.

    Parameters
    ----------
    scene
        The complete scene.
    cells
        Number of cells across the thinnest slab.

    Examples
    --------
    >>> from snowshed import Scene
    >>> scene = Scene.preset("lab-50").with_({"numerics.scheme": "objective"})
    >>> recorded_grid_error(scene.resolve().data).size < 0.2
    True
    """
    mechanisms = Mechanisms.of_scene(scene) or Mechanisms()
    known = _largest(mechanisms, cells)
    source = recorded_bias(2, TYPICAL_SLIDE_OFFS, mechanisms)
    if known > 0.0:
        return GridError(known, source)
    largest = max(_largest(Mechanisms(scheme), cells) for scheme in _recorded_schemes())
    return GridError(largest, f"{source}, so it is the largest error of all schemes")


def _recorded_schemes() -> list[str]:
    stacks = recorded_stacks(load_recorded())
    return sorted({Mechanisms.of_settings(stack.settings).scheme for stack in stacks})


def _largest(mechanisms: Mechanisms, cells: float) -> float:
    biases = resolved_biases(2, TYPICAL_SLIDE_OFFS, mechanisms)
    fine = [abs(bias) for across, bias in biases.items() if across > cells - ROUNDING]
    return max(fine or [abs(biases[across]) for across in sorted(biases)[-1:]], default=0.0)
