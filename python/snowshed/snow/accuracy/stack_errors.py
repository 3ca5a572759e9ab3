"""The error of a stack, from recorded runs on several grids.

Height and length of a stack depend on the grid more than on the seed. Every stack is shown with the
error of recorded runs of the laboratory experiment. The name of the recorded scene and scheme
stands beside it, because the error of another size or another snow may be larger or smaller, and so
do the errors of all recorded panels. Each scheme has runs and a finest grid of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Optional, Union

from snowshed.base.arguments import checked
from snowshed.base.formatting import number, number_span, percent_span
from snowshed.scene.accuracy_settings import MIN_CELLS_ACROSS
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.snow.accuracy.measurements import CaseSettings, MeasuredSolution
from snowshed.snow.accuracy.mechanisms import SCHEME, SCHEME_SETTINGS, Mechanisms
from snowshed.snow.accuracy.panel_errors import PanelErrors, panel_errors
from snowshed.snow.accuracy.recorded import load_recorded
from snowshed.snow.accuracy.recorded_stacks import (
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

#: Beginning of every sentence on the error of a stack.
BEGINNING = "error of the stack"
#: The only settings in which a plain recorded run may differ from the defaults.
_PLAIN = {"dimension", "between", "events", ORDER_IN, SCHEME, *SCHEME_SETTINGS}


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
    thickness
        Thickness of the scene's slab, m.
    panels
        Errors of all recorded panels; None if they are not recorded for the scheme.

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
    settings: CaseSettings
    thickness: float = PRESET_THICKNESS
    panels: Optional[PanelErrors] = None

    @property
    def sentence(self) -> str:
        """The error in a sentence, with the recorded scene and scheme that it comes from."""
        bias = ", ".join(f"{name} {_bias_text(self.bias[name])}" for name in QUANTITIES)
        scatter = " and ".join(f"{100 * self.scatter[name]:.0f} %" for name in self.scatter)
        cells = f"{number(self.recorded_cells, 2)} cell{'' if self.recorded_cells == 1 else 's'}"
        mechanisms = Mechanisms.of_settings(self.settings)
        own_cells = (
            ""
            if abs(self.cells / self.recorded_cells - 1) < 0.01
            else f"; this scene has {number(self.cells, 2)}"
        )
        return _clauses(
            f"{BEGINNING} in recorded runs ({_scene_label(self.settings)}, {cells} in the "
            f"slab{own_cells}): {bias}, relative to the finest recorded grid of this scheme, "
            "which is itself not converged",
            "" if self.panels is None else self.panels.sentence,
            f"single runs scatter by {scatter}" if scatter else "",
            mechanisms.calibration_note,
            mechanisms.lengths_note(PRESET_THICKNESS, self.thickness),
        )


@checked
def stack_error(
    scene: Union[Scene, ResolvedScene],
    measurements: Optional[Iterable[MeasuredSolution]] = None,
) -> Optional[StackError]:
    """Return the error of a scene's stack after its last event, from the nearest recorded runs.

    Parameters
    ----------
    scene
        The scene.
    measurements
        Recorded measurements; by default those of the package. With others, the errors of all
        recorded panels are left out.

    Returns
    -------
    StackError or None
        None if the scene builds no stack on a grid, or nothing was recorded for its mechanisms:
        its scheme and all settings that the scheme decides.

    Examples
    --------
    >>> stack_error(Scene.preset("lab-50").with_({"numerics.dx": 0.02})).recorded_cells
    1.0
    """
    data = (scene.resolve() if isinstance(scene, Scene) else scene).data
    thickness = None if data.get("panel") is None else slab_thickness(data)
    mechanisms = Mechanisms.of_scene(data)
    if thickness is None or mechanisms is None:
        return None
    cells = thickness / float(data["numerics"][ORDER_IN])
    recorded = packaged_stacks() if measurements is None else recorded_stacks(measurements)
    stacks = _plain_stacks(recorded, mechanisms)
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
        thickness=thickness,
        panels=(
            panel_errors(mechanisms, cells, data["events"]["count"])
            if measurements is None
            else None
        ),
    )


def error_sentence(scene: ResolvedScene) -> str:
    """Return a sentence on the error of a scene's stack; empty if it has no stack on a grid.

    Examples
    --------
    >>> lab = Scene.preset("lab-50")
    >>> error_sentence(lab.resolve()).startswith("error of the stack in recorded runs (lab-50")
    True
    >>> error_sentence(lab.with_({"numerics.transfer": "affine_flip"}).resolve())[20:]
    'no runs are recorded for scheme thesis with affine flip; --check measures it'
    """
    error = stack_error(scene)
    if error is not None:
        return error.sentence
    mechanisms = Mechanisms.of_scene(scene.data)
    if slab_thickness(scene.data) is None or mechanisms is None:
        return ""
    return f"{BEGINNING}: {_no_runs_text(mechanisms)}; --check measures it"


def recorded_bias(dimension: int, events: int, mechanisms: Optional[Mechanisms] = None) -> str:
    """Return a clause on the error of recorded stacks, over all grids that resolve the slab.

    It is for answers that combine slabs of several thicknesses, or name no thickness.

    Parameters
    ----------
    dimension
        2 or 3.
    events
        Number of slide-offs; the nearest recorded one counts.
    mechanisms
        Scheme and settings that depart from it; by default the scheme thesis.

    Returns
    -------
    str
        A clause, such as ``stacks of lab-50 in 2D, event 5, scheme thesis were 12 to 42 % too high
        with 2 to 4 cells in the slab``, with the errors of all recorded panels, or that nothing was
        recorded.

    Examples
    --------
    >>> recorded_bias(2, 5).startswith("stacks of lab-50 in 2D, event 5, scheme thesis were ")
    True
    """
    mechanisms = mechanisms or Mechanisms()
    stacks = _nearest_stacks(dimension, events, mechanisms)
    resolved = _resolved(stacks)
    if not resolved:
        return _no_runs_text(mechanisms)
    biases = [stack.biases[0] for stack in resolved.values()]
    span = percent_span(100 * min(biases), 100 * max(biases), "too high", "too low")
    panels = panel_errors(mechanisms, MIN_CELLS_ACROSS, events)
    return _clauses(
        f"stacks of {_scene_label(stacks[0].settings)} were {span} with "
        f"{number_span(min(resolved), max(resolved))} cells in the slab, relative to the finest "
        "recorded grid of this scheme",
        "" if panels is None else panels.sentence,
        mechanisms.calibration_note,
    )


def resolved_stacks(
    dimension: int, events: int, mechanisms: Optional[Mechanisms] = None
) -> dict[float, RecordedStack]:
    """Return recorded stacks by the cells across the slab; the parameters are `recorded_bias`'s.

    Grids with too few cells are left out.

    Examples
    --------
    >>> sorted(resolved_stacks(2, 5))
    [2.0, 4.0]
    """
    return _resolved(_nearest_stacks(dimension, events, mechanisms or Mechanisms()))


@cache
def packaged_stacks() -> Sequence[RecordedStack]:
    """Return the recorded stacks of the package, which are read once: every run needs them.

    Examples
    --------
    >>> len(packaged_stacks()) > 50
    True
    """
    return recorded_stacks(load_recorded())


def _resolved(stacks: Iterable[RecordedStack]) -> dict[float, RecordedStack]:
    by_cells = {PRESET_THICKNESS / float(stack.settings[ORDER_IN]): stack for stack in stacks}
    return {cells: stack for cells, stack in by_cells.items() if cells > MIN_CELLS_ACROSS - 1e-9}


def _nearest_stacks(dimension: int, events: int, mechanisms: Mechanisms) -> list[RecordedStack]:
    return nearest(
        _plain_stacks(packaged_stacks(), mechanisms), {"dimension": dimension, "events": events}
    )


def _plain_stacks(recorded: Iterable[RecordedStack], mechanisms: Mechanisms) -> list[RecordedStack]:
    """Return the recorded stacks with these mechanisms, and with defaults otherwise."""
    return [
        stack
        for stack in recorded
        if set(stack.settings) <= _PLAIN and Mechanisms.of_settings(stack.settings) == mechanisms
    ]


def _scene_label(settings: CaseSettings) -> str:
    """Return the recorded scene of settings, with its scheme."""
    scene = f"{PRESET} in {settings['dimension']}D, event {settings['events']}"
    return f"{scene}, {Mechanisms.of_settings(settings).label}"


def _clauses(*clauses: str) -> str:
    """Return the clauses that are not empty as a sentence."""
    return "; ".join(filter(None, clauses))


def _no_runs_text(mechanisms: Mechanisms) -> str:
    return f"no runs are recorded for {mechanisms.label}"


def _bias_text(share: float) -> str:
    """Return a relative deviation as text.

    Examples
    --------
    >>> _bias_text(0.35), _bias_text(-0.001)
    ('35 % too large', 'within 1 %')
    """
    size = f"{100 * abs(share):.0f}"
    return "within 1 %" if size == "0" else f"{size} % too {'large' if share > 0 else 'small'}"
