"""The study of chapter 4, as a study file: the grid of triplets at the tilts that were measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.io.formatting import exact
from snowshed.study.template import filled

#: Table 4.1.1, SI units.
FULL = {
    "name": "calibration",
    "dimension": "3",
    "dx": "0.01",
    "slopes": "[0.4, 0.5, 0.6, 0.7]",
    "pressures": "[4e3, 5e3, 6e3, 7e3]",
    "cohesions": "[0.05, 0.1, 0.2]",
}
#: The corners of that grid, coarse, to see the way.
QUICK = {
    "name": "calibration-quick",
    "dimension": "2",
    "dx": "0.03",
    "slopes": "[0.4, 0.7]",
    "pressures": "[4e3, 7e3]",
    "cohesions": "[0.05, 0.1, 0.2]",
}
SEEDS = 2


def calibration_study(
    measurements: Sequence[Measurement], *, quick: bool = False, seeds: Optional[int] = None
) -> str:
    """Return the study file of the calibration: 48 triplets M x p0 x beta (Table 4.1.1).

    Parameters
    ----------
    measurements
        They decide the tilts of the panel and the number of events.
    quick
        Whether the 12 corners of the grid, in 2D and coarse, to see the way.
    seeds
        Seedings of each triplet and tilt; 2 if not given, so that their noise is known.

    Examples
    --------
    >>> from snowshed.analysis.calibration.measurements import Measurement
    >>> measured = [Measurement(tilt, 5, 1, "height", 0.1, 0.01) for tilt in (40, 50)]
    >>> "panel.tilt = [40, 50]" in calibration_study(measured)
    True
    """
    if seeds is not None and seeds < 1:
        raise InputError(f"seeds: {seeds} is not positive")
    values = dict(QUICK if quick else FULL)
    tilts = sorted({one.tilt for one in measurements})
    values["tilts"] = f"[{', '.join(map(exact, tilts))}]"
    values["events"] = str(max(one.event for one in measurements))
    values["seeds"] = str(SEEDS if seeds is None else seeds)
    return filled("snowshed.analysis.calibration", "grid", values)
