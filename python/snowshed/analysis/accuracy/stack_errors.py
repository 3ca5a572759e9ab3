"""The error of a stack, from recorded runs on several grids.

Height and length of a stack depend on the grid more than on the seed. What recorded runs of the
laboratory experiment say of it is said beside every stack, with the name of the recorded scene,
because a scene of another size or another snow may err by more or by less.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Optional, Union

from snowshed.analysis.accuracy.measurements import Measurement, Settings
from snowshed.analysis.accuracy.recorded import load_recorded
from snowshed.analysis.accuracy.recorded_stacks import (
    ORDER_IN,
    PRESET,
    PRESET_THICKNESS,
    QUANTITIES,
    RecordedStack,
    circumstances,
    nearest,
    recorded_stacks,
    slab_thickness,
)
from snowshed.base.formatting import number
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.registry import settings_of
from snowshed.running.scene_notes import FEW_CELLS
from snowshed.scene.scene import ResolvedScene, Scene

#: Settings of recorded runs with the default scheme.
_PLAIN = {"dimension", "between", "events", "transfer", ORDER_IN}


@dataclass(frozen=True)
class StackError:
    """The error of a stack's height and length in recorded runs.

    Attributes
    ----------
    bias
        Deviation of the mean stack from that on the finest recorded grid, relative to it, of
        "height" and "length"; positive: too large.
    scatter
        Standard deviation of a single run over random seedings, relative to the mean, of "height"
        and "length"; empty where it was not recorded.
    cells
        Cells across the slab of the scene.
    recorded_cells
        Cells across the slab of the recorded runs.
    settings
        Settings of the recorded runs.

    Examples
    --------
    >>> error = stack_error(Scene.preset("lab-50").with_({"dimension": 2}))
    >>> error.cells, error.recorded_cells, sorted(error.bias)
    (2.0, 2.0, ['height', 'length'])
    >>> error.bias["height"] > 0.2
    True
    """

    bias: Mapping[str, float]
    scatter: Mapping[str, float]
    cells: float
    recorded_cells: float
    settings: Settings

    @property
    def sentence(self) -> str:
        """The error in a sentence, with the recorded scene that it comes from."""
        bias = ", ".join(f"{name} {_signed(self.bias[name])}" for name in QUANTITIES)
        scatter = " and ".join(f"{100 * self.scatter[name]:.0f} %" for name in self.scatter)
        where = f"{PRESET} in {self.settings['dimension']}D, event {self.settings['events']}"
        mine = (
            ""
            if abs(self.cells / self.recorded_cells - 1) < 0.01
            else f"; this scene has {number(self.cells, 2)}"
        )
        return (
            f"error of the stack in recorded runs ({where}, {number(self.recorded_cells, 2)} cells "
            f"in the slab{mine}): {bias}, against the finest recorded grid, itself not converged"
            + (f"; single runs scatter by {scatter}" if scatter else "")
        )


def stack_error(
    scene: Union[Scene, ResolvedScene],
    measurements: Optional[Iterable[Measurement]] = None,
) -> Optional[StackError]:
    """Return the error of a scene's stack after its last event, from the nearest recorded runs.

    Parameters
    ----------
    scene
        The scene.
    measurements
        Recorded measurements; by default those of the package.

    Returns
    -------
    StackError or None
        None if the scene builds no stack on a grid, or nothing was recorded for its transfer.

    Examples
    --------
    >>> stack_error(Scene.preset("lab-50").with_({"numerics.dx": 0.02})).recorded_cells
    1.0
    """
    data = (scene.resolve() if isinstance(scene, Scene) else scene).data
    thickness = None if data.get("panel") is None else slab_thickness(data)
    if thickness is None or not isinstance(settings_of(data), MpmSettings):
        return None
    cells = thickness / float(data["numerics"][ORDER_IN])
    stacks = _plain_stacks(
        load_recorded() if measurements is None else measurements, data["numerics"]["transfer"]
    )
    wanted = {**circumstances(data), ORDER_IN: PRESET_THICKNESS / cells}
    chosen = nearest(stacks, wanted)
    if not chosen:
        return None
    stack = chosen[0]
    return StackError(
        bias=dict(zip(QUANTITIES, stack.biases)),
        scatter=dict(zip(QUANTITIES, stack.spreads)),
        cells=round(cells, 3),
        recorded_cells=round(PRESET_THICKNESS / float(stack.settings[ORDER_IN]), 3),
        settings=stack.settings,
    )


def error_sentence(scene: ResolvedScene) -> str:
    """Return what is recorded of the error of a scene's stack; empty if it builds none on a grid.

    Examples
    --------
    >>> lab = Scene.preset("lab-50")
    >>> error_sentence(lab.resolve()).startswith("error of the stack in recorded runs (lab-50")
    True
    >>> error_sentence(lab.with_({"numerics.scheme": "objective"}).resolve())
    'error of the stack: no runs are recorded for transfer affine_flip; --check measures it'
    """
    error = stack_error(scene)
    if error is not None:
        return error.sentence
    settings = settings_of(scene.data)
    if slab_thickness(scene.data) is None or not isinstance(settings, MpmSettings):
        return ""
    return (
        f"error of the stack: no runs are recorded for transfer {settings.transfer}; "
        "--check measures it"
    )


def recorded_bias(dimension: int, events: int, transfer: str = "flip") -> Optional[str]:
    """Return by how much recorded stacks were too high, over all grids that resolve the slab.

    It is for answers that combine slabs of several thicknesses, and for those that name none.

    Parameters
    ----------
    dimension
        2 or 3.
    events
        Number of slide-offs; the nearest recorded one counts.
    transfer
        Transfer of velocities between particles and grid.

    Returns
    -------
    str or None
        A clause, such as ``stacks of lab-50 were 12 to 42 % too high with 2 to 4 cells in the
        slab``; None if nothing was recorded.

    Examples
    --------
    >>> recorded_bias(2, 5).startswith("stacks of lab-50 were ")
    True
    """
    stacks = nearest(
        _plain_stacks(load_recorded(), transfer),
        {"dimension": dimension, "events": events},
    )
    cells = {
        PRESET_THICKNESS / float(stack.settings[ORDER_IN]): stack.biases[0] for stack in stacks
    }
    resolved = {n: bias for n, bias in cells.items() if n > FEW_CELLS - 1e-9}
    if not resolved:
        return None
    low, high = 100 * min(resolved.values()), 100 * max(resolved.values())
    return (
        f"stacks of {PRESET} were {_span(low, high)} with {_numbers(min(resolved), max(resolved))} "
        "cells in the slab, against the finest recorded grid"
    )


def _plain_stacks(measurements: Iterable[Measurement], transfer: str) -> list[RecordedStack]:
    """Return the recorded stacks of a transfer with the default scheme."""
    return [
        stack
        for stack in recorded_stacks(measurements)
        if set(stack.settings) <= _PLAIN and stack.settings.get("transfer") == transfer
    ]


def _numbers(low: float, high: float) -> str:
    return f"{low:.0f}" if round(low) == round(high) else f"{low:.0f} to {high:.0f}"


def _span(low: float, high: float) -> str:
    """Return a span of percentages as text."""
    if low >= 0:
        return f"{_numbers(low, high)} % too high"
    if high <= 0:
        return f"{_numbers(-high, -low)} % too low"
    return f"from {-low:.0f} % too low to {high:.0f} % too high"


def _signed(share: float) -> str:
    return f"{100 * abs(share):.0f} % too {'large' if share > 0 else 'small'}"
