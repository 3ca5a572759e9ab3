"""The law of the snow at a point: its states along paths of strain or of stress.

The directions of the principal strains stay fixed. All stresses are Kirchhoff stresses (Cauchy's
times the volume ratio).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Callable, Optional, Union

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, number_array, whole_number
from snowshed.base.notes import issue_note
from snowshed.scene.components import Snow

if TYPE_CHECKING:
    import pandas as pd

STRAIN, STRESS = "strain", "stress"
TOLERANCE = 1e-10  # of the stress that a path prescribes, relative to Young's modulus
MAX_ITERATIONS = 50
MAX_STRAIN = 1.0  # beyond it, a note asks for the unit
MIN_STRESS = 50.0  # Pa, as `MAX_STRAIN`; the strength of snow is larger
BEYOND_STRENGTH = "the snow cannot bear this stress"
#: A law: pressure, Mises stress and plastic strain after an elastic trial.
ReturnMap = Callable[[float, float, float], "tuple[float, float, float]"]


@checked
def follow_path(
    snow: Snow,
    path: Union[pd.DataFrame, Mapping[str, Sequence[float]]],
    *,
    dimension: int = 3,
    steps: int = 100,
    law: Optional[ReturnMap] = None,
) -> pd.DataFrame:
    """Return the states of snow along a path, from a state without strain and stress.

    Parameters
    ----------
    snow
        The snow, with the model "cam_clay".
    path
        The points that follow the start. Each direction, 1 to `dimension`, has either a column
        ``strain_1``, a logarithmic strain (tension positive), or ``stress_1``, a stress [Pa]
        (tension positive).
    dimension
        3, or 2: the plane of a scene in 2D.
    steps
        Number of equal increments from one point to the next.
    law
        A law of one's own, ``law(p, q, plastic_strain)``, in place of that of the snow.

    Returns
    -------
    pandas.DataFrame
        The start, and a row for each increment: ``strain_1``, ``stress_1``, ..., ``pressure``
        (compression positive), ``mises``, ``preconsolidation_pressure``, ``plastic_strain``; units
        by column in ``attrs["units"]``.

    Raises
    ------
    InputError
        If a column is missing or unknown, a value is not finite, the snow cannot bear a stress of
        the path, or a state on it is not finite.

    Examples
    --------
    Snow that is compressed equally on all sides yields at its preconsolidation pressure.

    >>> table = follow_path(Snow.preset("calibrated"), {f"strain_{k}": [-0.01] for k in (1, 2, 3)})
    >>> table.pressure.iloc[[0, 10, -1]].round().tolist()
    [0.0, 2500.0, 8636.0]
    """
    if dimension not in (2, 3):
        raise InputError(f"dimension: {dimension!r}; allowed: 2, 3")
    columns, targets = _targets(path, dimension)
    count = whole_number("steps", steps, lowest=1)
    point = _Point(snow, dimension, law)
    states = [point.state()]
    before = np.zeros(dimension)
    for row, target in enumerate(targets, start=1):
        for step in range(1, count + 1):
            wanted = before + (target - before) * (step / count)
            try:
                with np.errstate(over="ignore", invalid="ignore"):  # such a state is refused
                    point.go_to(columns, wanted)
            except InputError as error:
                raise InputError(f"path: row {row}, increment {step}: {error}") from None
            state = point.state()
            if not np.isfinite(state).all():
                raise InputError(f"path: row {row}, increment {step}: the state is not finite")
            states.append(state)
        before = target
    return _table(states, dimension)


def _targets(
    path: Union[pd.DataFrame, Mapping[str, Sequence[float]]], dimension: int
) -> tuple[list[str], Floats]:
    """Return the kind of each direction's column, and the points (n, dimension)."""
    given = {str(name): number_array(str(name), values) for name, values in path.items()}
    kinds, values = [], []
    for direction in range(1, dimension + 1):
        names = [f"{kind}_{direction}" for kind in (STRAIN, STRESS)]
        there = [name for name in names if name in given]
        if len(there) != 1:
            raise InputError(f"path: give one of the columns {' and '.join(names)}")
        kinds.append(there[0].partition("_")[0])
        values.append(given.pop(there[0]))
    if given:
        raise InputError(f"path: unknown columns {', '.join(given)}")
    if len({value.shape for value in values}) > 1 or values[0].ndim != 1:
        raise InputError("path: its columns have different lengths")
    points = np.column_stack(values)
    if not np.isfinite(points).all():
        raise InputError("path: holds a value that is not finite")
    _note_on_units(kinds, points)
    return kinds, points


def _note_on_units(kinds: Sequence[str], points: Floats) -> None:
    """Issue notes on strains that are probably in percent, and stresses probably in kPa."""
    is_strain = np.array([kind == STRAIN for kind in kinds])
    strain = np.abs(points[:, is_strain]).max(initial=0.0)
    stress = np.abs(points[:, ~is_strain]).max(initial=0.0)
    if strain > MAX_STRAIN:
        issue_note(f"path: a logarithmic strain of {strain:g} is unusual; is it in percent?")
    if 0.0 < stress < MIN_STRESS:
        issue_note(f"path: no stress is more than {stress:g} Pa; are they in kPa?")


class _Point:
    """The state of snow at a point, in its principal directions."""

    def __init__(self, snow: Snow, dimension: int, law: Optional[ReturnMap]) -> None:
        if snow.model != "cam_clay":
            raise InputError(f"snow: its model is {snow.model!r}; needed: 'cam_clay'")
        self.snow = _core.CamClay(
            float(snow.youngs_modulus or 0.0),
            float(snow.poissons_ratio or 0.0),
            float(snow.critical_state_slope or 0.0),
            float(snow.cohesion or 0.0),
            float(snow.hardening_factor or 0.0),
            dimension,
        )
        self.law: ReturnMap = law or self.snow.return_map
        self.stiffness = float(snow.youngs_modulus or 0.0)
        self.elastic = np.zeros(dimension)
        self.strain = np.zeros(dimension)
        self.plastic = self.snow.initial_plastic_strain(float(snow.preconsolidation_pressure or 0))

    def returned(self, strain: Floats) -> tuple[Floats, float]:
        """Return the elastic strains and the plastic strain at new strains."""
        trial = self.elastic + (strain - self.strain)
        volume = float(trial.sum())
        deviator = trial - volume / len(trial)
        size = math.sqrt(1.5 * float(deviator @ deviator))
        pressure, mises = -self.snow.bulk * volume, 2.0 * self.snow.shear * size
        p, q, plastic = self.law(pressure, mises, self.plastic)
        share = q / mises if mises > 0.0 else 1.0
        return share * deviator - p / (self.snow.bulk * len(trial)), plastic

    def stress(self, elastic: Floats) -> Floats:
        """Return the principal stresses of elastic strains, Pa."""
        volume = float(elastic.sum())
        deviator = elastic - volume / len(elastic)
        return 2.0 * self.snow.shear * deviator + self.snow.bulk * volume

    def go_to(self, kinds: Sequence[str], wanted: Floats) -> None:
        """Go to strains, or to stresses in the directions whose kind is that."""
        free = [place for place, kind in enumerate(kinds) if kind == STRESS]
        strain = np.where([kind == STRAIN for kind in kinds], wanted, self.strain)
        scale = TOLERANCE * self.stiffness
        for _ in range(MAX_ITERATIONS):
            missing = wanted[free] - self.stress(self.returned(strain)[0])[free]
            if not np.isfinite(missing).all():
                raise InputError(BEYOND_STRENGTH)
            if not np.abs(missing).max(initial=0.0) > scale:
                break
            slopes = self._slopes(strain, free)
            if not np.isfinite(slopes).all():
                raise InputError(BEYOND_STRENGTH)
            strain[free] += np.linalg.lstsq(slopes, missing, rcond=None)[0]
        else:
            raise InputError(BEYOND_STRENGTH)
        self.elastic, self.plastic = self.returned(strain)
        self.strain = strain

    def _slopes(self, strain: Floats, free: Sequence[int]) -> Floats:
        """Return the derivatives of the free stresses by the free strains."""
        step, slopes = 1e-8, np.empty((len(free), len(free)))
        for column, place in enumerate(free):
            ends = []
            for sign in (-1.0, 1.0):
                moved = strain.copy()
                moved[place] += sign * step
                ends.append(self.stress(self.returned(moved)[0])[list(free)])
            slopes[:, column] = (ends[1] - ends[0]) / (2.0 * step)
        return slopes

    def state(self) -> list[float]:
        """Return a row of the table."""
        stress = self.stress(self.elastic)
        pressure = 0.0 - float(stress.mean())
        deviator = stress + pressure
        mises = math.sqrt(1.5 * float(deviator @ deviator))
        strength = float(self.snow.preconsolidation(self.plastic))
        return [*self.strain, *stress, pressure, mises, strength, self.plastic]


def _table(states: Sequence[Sequence[float]], dimension: int) -> pd.DataFrame:
    import pandas as pd

    directions = range(1, dimension + 1)
    units = {f"{STRAIN}_{k}": "1" for k in directions}
    units |= {f"{STRESS}_{k}": "Pa" for k in directions}
    units |= {"pressure": "Pa", "mises": "Pa", "preconsolidation_pressure": "Pa"}
    units |= {"plastic_strain": "1"}
    table = pd.DataFrame(states, columns=list(units))
    table.attrs["units"] = units
    return table
