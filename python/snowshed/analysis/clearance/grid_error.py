"""The error of the grid in required heights, from recorded stacks on several grids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

from snowshed.snow.accuracy.mechanisms import Mechanisms
from snowshed.snow.accuracy.panel_errors import panel_errors, recorded_schemes
from snowshed.snow.accuracy.solutions import quickest
from snowshed.snow.accuracy.stack_errors import packaged_stacks, resolved_stacks

#: Fewest cells across a slab.
MIN_CELLS = 2.0
#: Number of slide-offs in a typical winter, for which scheme and cells are chosen.
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

    The error is that of stacks of `TYPICAL_SLIDE_OFFS`. If no grid was as accurate, the most
    accurate is returned.

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
    for scheme in _timed_schemes():
        stacks = resolved_stacks(2, TYPICAL_SLIDE_OFFS, Mechanisms(scheme))
        choices += [GridChoice(scheme, cells, abs(stacks[cells].biases[0])) for cells in stacks]
        costs += [stack.wall_s for stack in stacks.values()]
    return choices[quickest(costs, [choice.error for choice in choices], accuracy)]


def recorded_grid_error(
    scene: Mapping[str, Any], cells: float = MIN_CELLS, slide_offs: int = TYPICAL_SLIDE_OFFS
) -> GridError:
    """Return the largest recorded error of the height with a scene's scheme.

    Stacks of fewer slide-offs and grids with fewer cells in the slab are left out, except those of
    the most slide-offs and the finest grid. If nothing was recorded for the mechanisms of the
    scene, the error is the largest of all schemes.

    Parameters
    ----------
    scene
        The complete scene.
    cells
        Number of cells across the thinnest slab.
    slide_offs
        Number of slide-offs of which the stack is made.

    Examples
    --------
    >>> from snowshed import Scene
    >>> scene = Scene.preset("lab-50").with_({"numerics.scheme": "objective"}).resolve().data
    >>> recorded_grid_error(scene).size < 0.2 < recorded_grid_error(scene, slide_offs=2).size
    True
    """
    mechanisms = Mechanisms.of_scene(scene) or Mechanisms()
    error = _height_error(mechanisms, cells, slide_offs)
    if error is not None:
        return error
    errors = (_height_error(Mechanisms(name), cells, slide_offs) for name in recorded_schemes())
    largest = max(filter(None, errors), key=lambda recorded: recorded.size)
    note = f"no stacks are recorded for {mechanisms.label}, so it is the largest of all schemes"
    return GridError(largest.size, f"{note}: {largest.source}")


def _timed_schemes() -> list[str]:
    return sorted({Mechanisms.of_settings(stack.settings).scheme for stack in packaged_stacks()})


def _height_error(mechanisms: Mechanisms, cells: float, slide_offs: int) -> Optional[GridError]:
    errors = panel_errors(mechanisms, cells, slide_offs, planar=True)
    if errors is None:
        return None
    clauses = [
        f"recorded stacks of {errors.slide_offs} or more slide-offs ({errors.panels}, "
        f"{mechanisms.label}, {errors.cells_text}) were "
        f"{errors.span('height', 'too high', 'too low')}, relative to the finest recorded grid of "
        "this scheme",
        mechanisms.calibration_note,
    ]
    return GridError(errors.largest("height"), "; ".join(filter(None, clauses)))
