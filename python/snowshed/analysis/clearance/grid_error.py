"""The error of the grid in required heights, from recorded stacks on several grids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from snowshed.analysis.accuracy.mechanisms import Mechanisms
from snowshed.analysis.accuracy.recorded import load_recorded
from snowshed.analysis.accuracy.recorded_stacks import recorded_stacks
from snowshed.analysis.accuracy.stack_errors import recorded_bias, resolved_biases

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


def recorded_grid_error(scene: Mapping[str, Any]) -> GridError:
    """Return the largest recorded error of the height with a scene's scheme.

    Grids with fewer than two cells in the slab are left out. If nothing was recorded for the
    mechanisms of the scene, the error is the largest of all schemes.

    Parameters
    ----------
    scene
        The complete scene.

    Examples
    --------
    >>> from snowshed import Scene
    >>> scene = Scene.preset("lab-50").with_({"numerics.scheme": "objective"})
    >>> recorded_grid_error(scene.resolve().data).size < 0.2
    True
    """
    mechanisms = Mechanisms.of_scene(scene) or Mechanisms()
    known = _largest(mechanisms)
    source = recorded_bias(2, TYPICAL_SLIDE_OFFS, mechanisms)
    if known > 0.0:
        return GridError(known, source)
    stacks = recorded_stacks(load_recorded())
    schemes = {Mechanisms.of_settings(stack.settings).scheme for stack in stacks}
    largest = max(_largest(Mechanisms(scheme)) for scheme in schemes)
    return GridError(largest, f"{source}, so it is the largest error of all schemes")


def _largest(mechanisms: Mechanisms) -> float:
    biases = resolved_biases(2, TYPICAL_SLIDE_OFFS, mechanisms).values()
    return max((abs(bias) for bias in biases), default=0.0)
