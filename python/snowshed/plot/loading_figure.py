"""The curve of a loading test, with its phases."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.methods.grains.curve import LoadingCurve, stage_strain, stage_stress
from snowshed.methods.grains.phases import MIN_LINEARITY, Phases, find_phases
from snowshed.plot.figure_style import (
    BODY,
    COLOURS,
    FAINT,
    INK,
    STACK,
    STYLE,
    blank_figure,
    describe,
)

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
MIN_DRAWN_SHARE = 0.01  # smaller shares of the largest energy are not drawn
KEY: dict[str, Any] = {
    "loc": "best", "frameon": True, "framealpha": 0.8, "edgecolor": "none"
}  # fmt: skip
BEGINNING_OVER_LIMIT = 4.0  # largest strain in the diagram of the beginning, over the elastic limit
#: Colours of the phases: elastic, brittle and frictional, hardening.
PHASES = ("#d8e8f2", "#f6efe2", "#f3dfd8")


def loading_figure(curve: LoadingCurve, kinds: Sequence[str], title: str = "") -> Figure:
    """Return the figure of a loading test: stresses, broken bonds, coordination and energies.

    If the first stage compresses, its phases are shaded; if it hardens, stresses are on a
    logarithmic scale.

    Parameters
    ----------
    curve
        The curve of the test.
    kinds
        Kinds of its stages, in order.
    title
        Text above the figure, such as the recipe of a synthetic sample.
    """
    from matplotlib import rc_context

    along, label = _abscissa(curve, kinds)
    with rc_context(STYLE):
        figure = blank_figure(9.0, 6.6)
        if title:
            describe(figure, title)
        (stress, beginning), (bonds, last) = figure.subplots(2, 2)
        phases = find_phases(curve.of_stage(1), kinds[0])
        _draw_stresses(stress, curve, along, logarithmic=phases.hardening_onset is not None)
        if np.any(curve["cone_force_n"] != 0.0):
            _draw_cone(beginning, curve, along, label)
        else:
            _draw_beginning(beginning, curve.of_stage(1), kinds[0], phases)
        _draw_bonds(bonds, curve, along)
        if curve.energies:
            _draw_energies(last, curve, along)
        else:
            _draw_fraction(last, curve, along)
        for axes in (stress, bonds, last):
            if kinds[0] in ("compress", "isotropic"):
                end = float(curve.of_stage(1)["axial_strain"][-1])
                _shade(axes, phases, end, named=axes is stress)
            axes.set_xlabel(label)
            axes.set_xlim(float(along.min()), float(along.max()))
    return figure


def _abscissa(curve: LoadingCurve, kinds: Sequence[str]) -> tuple[np.ndarray, str]:
    """Return the abscissa of a test and its label: a strain if all stages have it, else time."""
    if set(kinds) <= {"compress", "isotropic", "unload", "hold"}:
        return 100.0 * curve["axial_strain"], "axial strain, %"
    if set(kinds) <= {"stretch", "hold"}:
        return -100.0 * curve["axial_strain"], "extension, %"
    if set(kinds) == {"shear"}:
        return 100.0 * curve["shear_strain"], "shear strain, %"
    return 1e3 * curve["time_s"], "time, ms"


def _draw_stresses(
    axes: Axes, curve: LoadingCurve, along: np.ndarray, *, logarithmic: bool
) -> None:
    for (name, text), colour in zip(STRESSES.items(), (INK, FAINT, *COLOURS[1:])):
        stress = curve[name] / 1e3
        if np.any(stress != 0.0):
            shown = np.where(stress > 0.0, stress, np.nan) if logarithmic else stress
            width = 1.4 if name == "top_stress_pa" else 0.9
            axes.plot(along, shown, color=colour, lw=width, label=text)
    if logarithmic:
        axes.set_yscale("log")
        largest = curve["top_stress_pa"].max() / 1e3
        axes.set_ylim(largest / 1000, 3 * largest)
    axes.set_ylabel("stress, kPa")
    axes.set_title("Stress")
    if axes.lines:
        axes.legend(**KEY)


def _draw_beginning(axes: Axes, stage: LoadingCurve, kind: str, phases: Phases) -> None:
    strain, stress = stage_strain(stage, kind), stage_stress(stage, kind)
    limit = phases.elastic_limit or 0.0
    shown = strain <= max(BEGINNING_OVER_LIMIT * limit, 1e-3 * float(strain.max()))
    unit = _unit_of_strain(float(strain[shown].max(initial=0.0)))
    axes.plot(unit[1] * strain[shown], stress[shown] / 1e3, ".-", color=INK, lw=1.0, ms=4)
    title = f"Beginning: {phases.unknown}" if phases.unknown else "Beginning"
    waves = phases.linearity is not None and phases.linearity < MIN_LINEARITY
    if waves:
        title += f": not linear (R² {phases.linearity:.2f}), waves"
    elif phases.tangent_modulus is not None:
        x = np.array([0.0, limit])
        fitted = np.polyfit(strain[strain <= limit], stress[strain <= limit], 1)
        axes.plot(unit[1] * x, np.polyval(fitted, x) / 1e3, color=BODY, lw=2.5, alpha=0.6)
        title += f": tangent modulus {phases.tangent_modulus / 1e6:.3g} MPa"
        title += f" (R² {phases.linearity:.3f})" if phases.linearity is not None else ""
    if limit > 0.0:
        axes.axvspan(0.0, unit[1] * limit, color=PHASES[0], lw=0, zorder=0)
        axes.text(
            0.5 * unit[1] * limit, 0.02, "elastic", ha="center", va="bottom", color=INK,
            fontsize=9, transform=axes.get_xaxis_transform(),
            bbox={"facecolor": PHASES[0], "edgecolor": "none", "pad": 1.5},
        )  # fmt: skip
    axes.set(xlabel=f"strain of the first stage{unit[0]}", ylabel="stress, kPa")
    axes.set_title(title)


def _unit_of_strain(largest: float) -> tuple[str, float]:
    """Return the unit in which small strains are shown, and its factor."""
    return (", %", 1e2) if largest > 5e-3 else (" times 1000", 1e3)


def _draw_cone(axes: Axes, curve: LoadingCurve, along: np.ndarray, label: str) -> None:
    axes.plot(along, curve["cone_force_n"], color=BODY, lw=1.2)
    axes.set(xlabel=label, ylabel="force, N")
    axes.set_title("Force on the cone")


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
    axes.legend(**KEY)


def _draw_energies(axes: Axes, curve: LoadingCurve, along: np.ndarray) -> None:
    largest = max(np.abs(curve[name]).max() for name in curve.energies)
    drawn = [
        name for name in curve.energies if np.abs(curve[name]).max() > MIN_DRAWN_SHARE * largest
    ]
    for name, colour in zip(drawn, (*COLOURS, INK, FAINT, STACK, BODY)):
        text = name[: -len("_j")].replace("_", " ")
        axes.plot(along, 1e6 * curve[name], color=colour, lw=1.2, label=text)
    axes.set_ylabel("energy, µJ")
    axes.set_title("Energy balance")
    axes.legend(**KEY)


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
                fontsize=9, transform=axes.get_xaxis_transform(),
                bbox={"facecolor": colour, "edgecolor": "none", "pad": 1.5},
            )  # fmt: skip
