"""The figure of a fitted snow: its hardening and its yield surface, beside the grains."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib
import numpy as np

from snowshed.analysis.grains.material.fit import FittedSnow
from snowshed.analysis.grains.material.loading_tests import (
    COMPACTION,
    CONFINED,
    ISOTROPIC,
    SHEAR,
    TENSION,
    Curves,
)
from snowshed.analysis.grains.material.readings import (
    PEAK_FROM_STRAIN,
    axial_stress,
    invariants,
    shear_strength,
    tension,
)
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, STYLE, blank_figure, headline
from snowshed.scene.labels import label

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def material_figure(fitted: FittedSnow, curves: Curves, *, synthetic: bool) -> Figure:
    """Draw isotropic compression and the plane of p and q, of the grains and of the law.

    Parameters
    ----------
    fitted
        The snow.
    curves
        Curves of the tests that it was fitted to.
    synthetic
        Whether the samples are synthetic, which the headline states.
    """
    law = fitted.law
    values = ", ".join(
        f"{label(f'snow.{name}').symbol} {label(f'snow.{name}').quantity(value, 3)}"
        for name, value in law.snow.to_data().items()
        if name != "density" and isinstance(value, float)
    )
    kind = "Synthetic snow" if synthetic else "Snow"
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(9.6, 4.4)
        headline(figure, f"{kind} of {law.density:.0f} kg/m³: {values}")
        hardening, plane = figure.subplots(1, 2)
        _draw_hardening(hardening, fitted, curves)
        _draw_plane(plane, fitted, curves)
    return figure


def _draw_hardening(axes: Axes, fitted: FittedSnow, curves: Curves) -> None:
    legend = "grains, isotropic compression"
    end = 0.0
    for (name, _), curve in curves.items():
        if name == COMPACTION:
            compaction = -3.0 * np.log1p(-np.abs(curve["axial_strain"]))
            p, _ = invariants(curve, isotropic=True)
            axes.plot(100 * compaction, p / 1e3, color=INK, lw=0.9, alpha=0.7, label=legend)
            legend, end = "", max(end, float(compaction[-1]))
    law, bulk = fitted.law, fitted.law.elastic.bulk_modulus
    plastic = np.linspace(0.0, end, 200)
    pressure = law.hardened(plastic)
    strain = np.concatenate([[0.0], plastic + pressure / bulk])
    pressure = np.concatenate([[0.0], pressure])
    axes.plot(100 * strain, pressure / 1e3, color=BODY, lw=2, label="law")
    axes.set_yscale("log")
    axes.set_ylim(bottom=law.preconsolidation_pressure / 1e3 / 100)
    axes.set(xlabel="volumetric compaction (logarithmic), %", ylabel="p, kPa")
    axes.set_title("Yield and hardening")
    axes.legend(loc="upper left")


def _draw_plane(axes: Axes, fitted: FittedSnow, curves: Curves) -> None:
    p0 = fitted.law.preconsolidation_pressure
    p = np.linspace(-fitted.law.cohesion * p0, p0, 300)
    q = fitted.law.yield_stress(p)
    axes.plot(p / p0, q / p0, color=BODY, lw=2, label="law: yield surface")
    for test, colour, marker, legend in (
        (ISOTROPIC, COLOURS[0], "o", "isotropic, peak below 5 %"),
        (CONFINED, COLOURS[2], "s", "confined, peak (not fitted)"),
        (TENSION, COLOURS[3], "v", "tension, peak"),
        (SHEAR, COLOURS[4], "^", "shear, peak"),
    ):
        for (name, _), curve in curves.items():
            if name.partition(" ")[0] == test:
                at = _point(test, curve)
                axes.plot(at[0] / p0, at[1] / p0, marker, color=colour, ms=6, label=legend)
                legend = ""
    axes.axhline(0.0, color=FAINT, lw=0.8)
    axes.axvline(0.0, color=FAINT, lw=0.8)
    axes.set(xlabel="p / p₀", ylabel="q / p₀")
    axes.set_title("Yield surface and strengths")
    axes.legend(loc="best")


def _point(test: str, curve: LoadingCurve) -> tuple[float, float]:
    """Return p and q where a test's strength is read."""
    if test in (SHEAR, TENSION):
        return shear_strength(curve) if test == SHEAR else tension(curve)
    p, q = invariants(curve, isotropic=test == ISOTROPIC)
    counted = curve["axial_strain"] >= PEAK_FROM_STRAIN
    row = int(np.argmax(np.where(counted, axial_stress(curve), -np.inf)))
    return float(p[row]), float(q[row])
