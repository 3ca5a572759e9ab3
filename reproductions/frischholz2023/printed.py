"""Numbers that the thesis prints in the tables of chapters 2 to 5."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from snowshed.analysis.calibration.parameter_grid import COHESION, PRESSURE, SLOPE
from snowshed.scene.labels import label


@dataclass(frozen=True)
class Printed:
    """A row of a table of parameters.

    Attributes
    ----------
    path
        Path of the parameter in a scene.
    text
        The values as the thesis prints them, or "not printed".
    name
        Displayed name, if it differs from the `label`.
    zero
        Text instead of zero, if zero has a special meaning.
    """

    path: str
    text: str
    name: str = ""
    zero: str = "0"

    @property
    def title(self) -> str:
        """The parameter's name, as it is shown."""
        return self.name or label(self.path).title


NOT_PRINTED = "not printed"
_PANEL_CONDITION = Printed("panel.condition", "SLIP")
_GROUND_CONDITION = Printed("ground.condition", "STICKY")
_FRICTION = Printed("panel.friction", NOT_PRINTED)
_DENSITY = Printed("snow.density", "210")
_POISSON = Printed("snow.poissons_ratio", "0.3")
_GRID = Printed("numerics.dx", "0.01")
_GROUND = Printed("ground.tilt", "0")
_SEED = Printed("seeding.seed", NOT_PRINTED, "seedings (their seeds)")
_BETWEEN = Printed("events.between", "RESEED")
_CALIBRATED_SNOW = ("0.5", "7", "0.2", "0.1", "1")  # Table 4.3.1


def _end(frames: str) -> Printed:
    return Printed("events.max_time", f"{frames} frames", "end of an event: rest, or after")


def _snow(slope: str, pressure: str, cohesion: str, hardening: str, modulus: str) -> list[Printed]:
    return [
        Printed("snow.critical_state_slope", slope),
        Printed("snow.preconsolidation_pressure", pressure),
        Printed("snow.cohesion", cohesion),
        Printed("snow.hardening_factor", hardening),
        Printed("snow.youngs_modulus", modulus),
    ]


def _scene(height: str, tilt: str, frames: str, events: str, width: str = "0.213") -> list[Printed]:
    """Return the common rows of the tables of the small panel."""
    return [
        Printed("dimension", "3D"),
        Printed("panel.height", height),
        Printed("panel.length", "0.245"),
        Printed("panel.width", width),
        Printed("panel.tilt", tilt),
        _GROUND,
        Printed("slab.thickness", "0.02"),
        Printed("slab.length", "0.245", zero="as the panel"),
        Printed("slab.width", "0.142"),
        Printed("events.count", events),
        _end(frames),
        _BETWEEN,
        _DENSITY,
        _POISSON,
    ]


_NUMERICS = [_GRID, _PANEL_CONDITION, _FRICTION, _GROUND_CONDITION, _SEED]

#: Tables 2.3.1 (the experiment), 4.1.1 and 4.3.1 (its simulation).
LABORATORY: Sequence[Printed] = [
    *_scene("0.33", "30, 40, 50", "60", "3 (text and figures: 5)", "0.142 (simulated: 0.213)"),
    *_snow(*_CALIBRATED_SNOW),
    *_NUMERICS,
]
#: Table 3.2.1.
SENSITIVITY: Sequence[Printed] = [
    *_scene("0.5", "40", "50", "3"),
    *_snow("0.3, 0.5, 0.7", "2, 5, 8", "0.1, 0.2, 0.3", "0.1, 0.2, 1", "1, 2, 3"),
    *_NUMERICS,
]
#: Table 4.1.1.
CALIBRATION: Sequence[Printed] = [
    *_scene("0.33", "40, 50", "60", "5"),
    *_snow("0.4, 0.5, 0.6, 0.7", "4, 5, 6, 7", "0.05, 0.1, 0.2", "0.1", "1"),
    *_NUMERICS,
]
#: Table 5.1.1: constant parameters.
PANELS_SCENE: Sequence[Printed] = [
    Printed("dimension", "2D"),
    _GROUND,
    Printed("slab.thickness", "0.05"),
    Printed("slab.length", "as the panel", zero="as the panel"),
    Printed("events.count", "5"),
    _end("100"),
    _DENSITY,
    _POISSON,
    *_snow(*_CALIBRATED_SNOW),
    _PANEL_CONDITION,
    _GROUND_CONDITION,
]
#: Tables 5.1.1 and 5.2.1: the inputs.
PANELS: Mapping[str, str] = {
    "event": "1, 2, 3, 4, 5",
    "panel height, m": "1, 1.5, 2, 2.5, 3, 3.5, 4; at 50 to 70°: 2, 3, 4",
    "panel length, m": "0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 6, 8, 10; at 50 to 70°: 0.5, 1.5, 2, 4, 8",
    "panel tilt, °": "40, 50, 60, 70; at the reference panel also 45, 55, 65",
}
PANEL_ROWS = "610 (385 at 40°, 225 steeper)"
#: Settings of the panels, by the columns of their rows.
PANEL_SETTINGS: Sequence[Printed] = (
    _FRICTION,
    replace(_BETWEEN, text="reseed"),
    Printed("dx", "0.01", "grid size dx, m"),
    Printed("particles_per_voxel", "at least 4", "particles per voxel"),
    replace(_SEED, path="seed"),
    Printed("version", "", "version of snowshed"),
)
#: Table 4.2.1: RMSE over the 48 triplets against the measured stacks, m.
RMSE_STATISTICS: Mapping[str, Mapping[str, float]] = {
    "height": {"min": 0.009, "max": 0.067, "mean": 0.028, "median": 0.029},
    "length": {"min": 0.034, "max": 0.118, "mean": 0.068, "median": 0.063},
}
#: Table 4.3.1: the calibrated snow's scores, m (the last one has no unit).
CALIBRATED_SCORES: Mapping[str, float] = {
    "height_mean_error_m": 0.010,
    "length_mean_error_m": 0.061,
    "height_rmse_m": 0.014,
    "length_rmse_m": 0.067,
    "rescaled_rmse": 0.237,
}
CALIBRATED_RANKS = "8 for the height, 26 for the length"
#: Table 4.3.1: the calibrated triplet.
CALIBRATED: Mapping[str, float] = {SLOPE: 0.5, PRESSURE: 7e3, COHESION: 0.2}
#: Section 5.3: rows of the data set.
THESIS_ROWS = 610
#: Table 5.3.1: quartiles of the predicted ratio by model; the last is the largest prediction.
THESIS_QUARTILES: Mapping[str, tuple[float, ...]] = {
    "rbf": (0.057, 0.092, 0.142, 0.240),
    "linear": (0.064, 0.101, 0.139, 0.255),
}
#: Table 5.3.2: mean absolute error of the ratio by model, and its standard deviation.
THESIS_ERRORS: Mapping[str, tuple[float, float]] = {
    "rbf": (0.004, 0.005),
    "linear": (0.015, 0.013),
}


def thesis_relative_error(model: str) -> float:
    """Return a model's mean absolute error over its median prediction.

    Examples
    --------
    >>> round(thesis_relative_error("rbf"), 3)
    0.043
    """
    return THESIS_ERRORS[model][0] / THESIS_QUARTILES[model][1]
