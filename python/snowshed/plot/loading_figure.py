"""The curve of a loading test, with its phases."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.phases import Phases, find_phases
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, STACK, STYLE, blank

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Stresses of the curve with their names.
STRESSES = {
    "top_stress_pa": "on the top plate",
    "bottom_stress_pa": "on the bottom plate",
    "side_stress_pa": "on the sides",
    "shear_stress_pa": "shear, top plate",
}
#: Colours of the phases: elastic, brittle and frictional, hardening.
PHASES = ("#d8e8f2", "#f6efe2", "#f3dfd8")


def loading_figure(curve: LoadingCurve, kinds: Sequence[str]) -> Figure:
    """Return the figure of a loading test: stresses, broken bonds, coordination and energies.

    Parameters
    ----------
    curve
        What it measured.
    kinds
        Of its stages, in order.
    """
    from matplotlib import rc_context

    along, label = _abscissa(curve, kinds)
    with rc_context(STYLE):
        figure = blank(9.0, 6.6)
        (stress, logarithmic), (bonds, last) = figure.subplots(2, 2, sharex=True)
        phases = find_phases(curve.of_stage(1), kinds[0])
        _draw_stresses(stress, curve, along)
        _draw_logarithm(logarithmic, curve, along)
        _draw_bonds(bonds, curve, along)
        if curve.energies:
            _draw_energies(last, curve, along)
        else:
            _draw_fraction(last, curve, along)
        if kinds[0] in ("compress", "isotropic"):
            end = float(curve.of_stage(1)["axial_strain"][-1])
            for axes in (stress, logarithmic, bonds, last):
                _shade(axes, phases, end, named=axes is logarithmic)
        for axes in (bonds, last):
            axes.set_xlabel(label)
        stress.set_xlim(float(along.min()), float(along.max()))
    return figure


def _abscissa(curve: LoadingCurve, kinds: Sequence[str]) -> tuple[np.ndarray, str]:
    """Return what to draw a test against: a strain, if it is one of all stages, else the time."""
    if set(kinds) <= {"compress", "isotropic", "unload", "hold"}:
        return 100.0 * curve["axial_strain"], "axial strain, %"
    if set(kinds) <= {"stretch", "hold"}:
        return -100.0 * curve["axial_strain"], "extension, %"
    if set(kinds) == {"shear"}:
        return 100.0 * curve["shear_strain"], "shear strain, %"
    return 1e3 * curve["time_s"], "time, ms"


def _draw_stresses(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    for (name, text), colour in zip(STRESSES.items(), (INK, FAINT, *COLOURS[1:])):
        if np.any(curve[name] != 0.0):
            width = 1.4 if name == "top_stress_pa" else 0.9
            axes.plot(along, curve[name] / 1e3, color=colour, lw=width, label=text)
    if np.any(curve["cone_force_n"] != 0.0):
        force = axes.twinx()
        force.plot(along, curve["cone_force_n"], color=BODY, lw=1.2)
        force.set_ylabel("force on the cone, N", color=BODY)
        force.grid(visible=False)
    axes.set_ylabel("stress, kPa")
    axes.set_title("Stress")
    axes.legend(loc="upper left")


def _draw_logarithm(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    stress = np.abs(curve["top_stress_pa"]) / 1e3
    if np.all(stress == 0.0):
        stress = np.abs(curve["shear_stress_pa"]) / 1e3
    shown = stress > 0.0
    axes.plot(along[shown], stress[shown], color=INK, lw=1.2)
    if shown.any():
        axes.set_yscale("log")
        axes.set_ylim(bottom=max(stress[shown].min(), stress.max() * 1e-6))
    axes.set_ylabel("stress, kPa")
    axes.set_title("The same on a logarithmic scale, with the phases")


def _draw_bonds(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    percent = 100.0 / max(curve["bonds"][0], 1.0)
    tension, shear = curve["broken_in_tension"], curve["broken_in_shear"]
    axes.stackplot(
        along, percent * tension, percent * shear, labels=["in tension", "in shear"],
        colors=[STACK, COLOURS[4]], alpha=0.8, lw=0,
    )  # fmt: skip
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("bonds broken, %")
    touching = axes.twinx()
    touching.plot(along, curve["coordination"], color=BODY, lw=1.3)
    touching.set_ylabel("grains that a grain touches", color=BODY)
    touching.set_ylim(bottom=0.0)
    touching.grid(visible=False)
    axes.set_title("Broken bonds and coordination")
    axes.legend(loc="upper left")


def _draw_energies(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    drawn = [name for name in curve.energies if np.any(curve[name] != 0.0)]
    for name, colour in zip(drawn, (*COLOURS, INK, FAINT, STACK, BODY)):
        text = name[: -len("_j")].replace("_", " ")
        axes.plot(along, 1e6 * curve[name], color=colour, lw=1.2, label=text)
    axes.set_ylabel("energy, µJ")
    axes.set_title("Energy balance")
    axes.legend(loc="upper left", ncols=2)


def _draw_fraction(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    axes.plot(along, curve["solid_fraction"], color=INK, lw=1.3)
    axes.set_ylabel("ice over volume")
    axes.set_title("Solid fraction")


def _shade(axes: Axes, phases: Phases, end: float, *, named: bool) -> None:
    """Shade the phases; `end` is the strain at which the stage ends."""
    limit = phases.elastic_limit or 0.0
    onset = phases.hardening_onset if phases.hardening_onset is not None else end
    names = ("elastic", "brittle, frictional", "hardening")
    for (low, high), colour, name in zip(
        ((0.0, limit), (limit, onset), (onset, end)), PHASES, names
    ):
        if high > low:
            axes.axvspan(100.0 * low, 100.0 * high, color=colour, lw=0, zorder=0)
        if named and high - low > 0.15 * end:
            axes.text(
                50.0 * (low + high), 0.02, name, ha="center", va="bottom", color=INK,
                fontsize=8.5, transform=axes.get_xaxis_transform(),
            )  # fmt: skip
