"""The study of chapter 4: the grid of triplets at the tilts that were measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.calibration.parameter_grid import CORNERS, GRID
from snowshed.base.arguments import checked
from snowshed.scene.components import Snow
from snowshed.scene.scene import Scene
from snowshed.study.definition import Study

SEEDS = 2


@checked
def calibration_study(
    measurements: Sequence[Measurement], *, quick: bool = False, seeds: Optional[int] = None
) -> Study:
    """Return the study of the calibration: 48 triplets M x p0 x beta (Table 4.1.1).

    Parameters
    ----------
    measurements
        Measured stacks, which decide the tilts of the panel and the number of events.
    quick
        Whether to use the 12 corners of the grid, in 2D and coarse, for a trial.
    seeds
        Random seeds per triplet and tilt; 2 by default, which show the noise.

    Raises
    ------
    InputError
        If `seeds` is not positive.

    Examples
    --------
    >>> from snowshed.analysis.calibration.measurements import Measurement
    >>> measured = [Measurement(tilt, 5, 1, "height", 0.1, 0.01) for tilt in (40, 50)]
    >>> len(calibration_study(measured).runs())  # 48 triplets, 2 tilts, 2 seedings
    192
    """
    if seeds is not None and seeds < 1:
        raise InputError(f"seeds: {seeds} is not positive")
    scene = Scene.preset("lab-40").update(
        {
            "snow": Snow.preset("reference").to_data(),
            "dimension": 2 if quick else 3,
            "events.count": max(measurement.event for measurement in measurements),
            "numerics.dx": 0.03 if quick else 0.01,
        }
    )
    tilts = sorted({measurement.tilt for measurement in measurements})
    study = Study.product(
        scene,
        {"panel.tilt": tilts, **(CORNERS if quick else GRID)},
        name="calibration-quick" if quick else "calibration",
        seeds=range(1, (SEEDS if seeds is None else seeds) + 1),
    )
    return replace(
        study,
        description="The calibration's grid (Table 4.1.1): every triplet of internal friction, "
        "preconsolidation pressure and cohesion factor, at every panel tilt that was measured.",
    )
