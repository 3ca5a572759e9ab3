"""The figures of a loading test of grains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Optional

import numpy as np

from snowshed.base.formatting import percent
from snowshed.methods.grains.curve import LoadingCurve, no_contact_text, stage_strain, stage_stress
from snowshed.methods.grains.phases import (
    MEAN_STRAIN_RANGES,
    MIN_LINEARITY,
    Phases,
    find_phases,
    mean_stress,
)
from snowshed.methods.grains.strength_scatter import (
    RecordedScatter,
    recorded_scatter,
    scatter_note,
    scatter_words,
)
from snowshed.methods.summary import Summary

#: Number of grains below which a sample hardly represents its snow.
FEW_GRAINS = 1000
#: Largest mean difference of the stresses on the plates in a quasi-static test, over their mean.
MAX_IMBALANCE = 0.2
#: density_scaling times speed squared, m2/s2, up to which inertia did not raise stresses in tests.
INERTIA = 0.004


@dataclass(frozen=True)
class GrainsSummary(Summary):
    """The figures of a loading test. Stresses of the first stage exclude the stress before it.

    Attributes
    ----------
    ended
        "rest" after all stages, else "time_limit".
    sim_time_s
        Simulated time of the test, s.
    final_particles, spheres
        Number of grains, and of their spheres.
    density_kg_m3
        Density of the snow at the beginning.
    solid_fraction, solid_fraction_at_end
        Volume of ice over the volume between the plates.
    axial_strain, shear_strain
        Strains at the end.
    bonds, broken_in_tension, broken_in_shear
        Numbers of bonds between spheres, and of those that broke.
    coordination_at_end
        Mean number of grains that a grain touches.
    elastic_limit_strain, tangent_modulus_pa, linearity
        Strain of the first stage before the first broken bond, slope up to there and its R2.
    strength_pa
        Largest stress of all time steps that the sample carries from plate to plate in the first
        stage, in compression below a strain of 5 %.
    mean_stress_5_10_pa, mean_stress_10_15_pa, mean_stress_25_30_pa
        Mean stress of the first stage between two strains in percent.
    hardening_onset_strain, hardening_rate
        Strain at which its stress begins to grow like exp(rate * strain), and this rate.
    largest_cone_force_n
        Largest force on the cone of all time steps; None if it never touched the snow.
    strength_scatter
        Words on the scatter of the strength between samples of this size
        (`snowshed.methods.grains.strength_scatter`); empty if there is no strength, and in results
        of earlier versions.
    synthetic
        Origin of a sample that is known as synthetic; else None.
    notes
        Notes on these figures.
    sample_notes
        Notes on the sample, which were given when the test began.
    """

    ended: str
    sim_time_s: float
    final_particles: int
    spheres: int
    density_kg_m3: float
    solid_fraction: float
    solid_fraction_at_end: float
    axial_strain: float
    shear_strain: float
    bonds: int
    broken_in_tension: int
    broken_in_shear: int
    coordination_at_end: float
    elastic_limit_strain: Optional[float]
    tangent_modulus_pa: Optional[float]
    linearity: Optional[float]
    strength_pa: Optional[float]
    mean_stress_5_10_pa: Optional[float]
    mean_stress_10_15_pa: Optional[float]
    mean_stress_25_30_pa: Optional[float]
    hardening_onset_strain: Optional[float]
    hardening_rate: Optional[float]
    largest_cone_force_n: Optional[float]
    strength_scatter: str = ""
    synthetic: Optional[str] = None
    notes: tuple[str, ...] = ()
    sample_notes: tuple[str, ...] = ()

    FILE: ClassVar[str] = "grains.json"
    TITLE: ClassVar[str] = "Loading test"
    OPENED: ClassVar[str] = "curve.csv, grains.png and forces.png"
    REMARKS: ClassVar[tuple[str, ...]] = (
        "strength_scatter",
        "synthetic",
        "notes",
        "sample_notes",
    )

    def lines(self) -> Mapping[str, str]:
        """Return the lines that people read, by name, without unknown figures."""
        broken = self.broken_in_tension + self.broken_in_shear
        force = self.largest_cone_force_n
        lines = {
            "ended": f"{self.ended} after {self.sim_time_s:.4g} s",
            "sample": f"{self.final_particles:,} grains of {self.spheres:,} spheres, "
            f"{self.density_kg_m3:.0f} kg/m3" + (", synthetic" if self.synthetic else ""),
            "bonds broken": f"{broken:,} of {self.bonds:,}, {self.broken_in_tension:,} in tension "
            f"and {self.broken_in_shear:,} in shear",
            "elastic up to": _strain(self.elastic_limit_strain),
            "tangent modulus": _pressure(self.tangent_modulus_pa),
            "strength": ", ".join(
                filter(None, (_pressure(self.strength_pa), self.strength_scatter))
            ),
            "mean stress, 5 to 10 %": _pressure(self.mean_stress_5_10_pa),
            "mean stress, 10 to 15 %": _pressure(self.mean_stress_10_15_pa),
            "mean stress, 25 to 30 %": _pressure(self.mean_stress_25_30_pa),
            "hardening from": _strain(self.hardening_onset_strain),
            "force on the cone": f"up to {force:.3g} N" if force else "",
        }
        return {name: text for name, text in lines.items() if text}


def summarise(
    curve: LoadingCurve,
    scene: Mapping[str, Any],
    *,
    ended: str,
    grains: int,
    spheres: int,
    synthetic: str = "",
    sample_notes: Sequence[str] = (),
) -> GrainsSummary:
    """Return the figures of a loading test.

    Parameters
    ----------
    curve
        Its curve.
    scene
        The complete scene's data.
    ended
        "rest" or "time_limit".
    grains, spheres
        Number of grains and of spheres.
    synthetic
        Origin of a sample that is known as synthetic.
    sample_notes
        Notes on the sample.
    """
    kind = str(scene["loading"][0]["kind"])
    first = curve.of_stage(1)
    phases = find_phases(first, kind) if kind != "penetrate" else NO_PHASES
    strain, stress = stage_strain(first, kind), stage_stress(first, kind)
    means = [
        None if phases.unknown else mean_stress(strain, stress, *ends)
        for ends in MEAN_STRAIN_RANGES
    ]
    return GrainsSummary(
        ended=ended,
        sim_time_s=float(curve["time_s"][-1]),
        final_particles=grains,
        spheres=spheres,
        density_kg_m3=_density(curve, scene),
        solid_fraction=float(curve["solid_fraction"][0]),
        solid_fraction_at_end=float(curve["solid_fraction"][-1]),
        axial_strain=float(curve["axial_strain"][-1]),
        shear_strain=float(curve["shear_strain"][-1]),
        bonds=int(curve["bonds"][0]),
        broken_in_tension=int(curve["broken_in_tension"][-1]),
        broken_in_shear=int(curve["broken_in_shear"][-1]),
        coordination_at_end=float(curve["coordination"][-1]),
        elastic_limit_strain=phases.elastic_limit,
        tangent_modulus_pa=phases.tangent_modulus,
        linearity=phases.linearity,
        strength_pa=phases.strength,
        mean_stress_5_10_pa=means[0],
        mean_stress_10_15_pa=means[1],
        mean_stress_25_30_pa=means[2],
        hardening_onset_strain=phases.hardening_onset,
        hardening_rate=phases.hardening_rate,
        largest_cone_force_n=_cone_force(curve, scene),
        strength_scatter=scatter_words(_scatter(curve, scene, grains)) if phases.strength else "",
        synthetic=synthetic or None,
        notes=tuple(_notes(curve, first, kind, scene, grains)),
        sample_notes=tuple(sample_notes),
    )


def _density(curve: LoadingCurve, scene: Mapping[str, Any]) -> float:
    """Return the density of the snow at the beginning, kg/m3."""
    return float(scene["numerics"]["density"]) * float(curve["solid_fraction"][0])


def _scatter(
    curve: LoadingCurve, scene: Mapping[str, Any], grains: int
) -> Optional[RecordedScatter]:
    kind, voxel = str(scene["loading"][0]["kind"]), float(scene["sample"]["voxel_size"])
    return recorded_scatter(grains, _density(curve, scene), voxel, kind)


def _cone_force(curve: LoadingCurve, scene: Mapping[str, Any]) -> Optional[float]:
    """Return the largest force on the cone; None if one moved and never touched the snow."""
    kinds = [str(stage["kind"]) for stage in scene["loading"]]
    if "penetrate" in kinds and no_contact_text(curve, "penetrate"):
        return None
    return float(max(np.abs(rows["cone_force_n"]).max() for rows in (curve, curve.peaks)))


NO_PHASES = Phases(None, None, None, None, None, None)


def _notes(
    curve: LoadingCurve, first: LoadingCurve, kind: str, scene: Mapping[str, Any], grains: int
) -> list[str]:
    notes = []
    if grains < FEW_GRAINS:
        notes.append(
            f"{grains} grains: the stresses depend on this small sample; "
            f"{FEW_GRAINS} or more represent the snow"
        )
    if kind in ("compress", "stretch"):
        top, bottom = first["top_stress_pa"], first["bottom_stress_pa"]
        apart, mean = np.abs(top - bottom).mean(), 0.5 * np.abs(top + bottom).mean()
        if mean > 0 and apart > MAX_IMBALANCE * mean:
            notes.append(
                f"the stresses on the two plates differ by {100 * apart / mean:.0f} % of their "
                "mean: the test is not quasi-static; load more slowly, or reduce density_scaling"
            )
    kinds = [str(stage["kind"]) for stage in scene["loading"]]
    if "penetrate" in kinds and (reason := no_contact_text(curve, "penetrate")):
        notes.append(f"{reason}: no force acts on it")
    phases = find_phases(first, kind) if kind != "penetrate" else NO_PHASES
    if phases.unknown:
        notes.append(f"{phases.unknown}: modulus, strength and mean stresses are unknown")
    if phases.contact_strain > 0.0:
        notes.append(
            f"nothing touched the snow before a strain of {percent(phases.contact_strain)}: the "
            "modulus is fitted from there on; all strains count from the beginning"
        )
    if phases.strength:
        notes.append(scatter_note(_scatter(curve, scene, grains)))
    linearity = phases.linearity
    if linearity is not None and linearity < MIN_LINEARITY:
        notes.append(
            f"the stress is not linear before the first bond breaks (R2 {linearity:.2f}), "
            "because waves run through the sample; load more slowly to find the modulus"
        )
    scaling = float(scene["numerics"]["density_scaling"])
    fastest = max(float(stage["speed"]) for stage in scene["loading"])
    if scaling * fastest**2 > INERTIA * (1.0 + 1e-9):
        notes.append(
            f"density_scaling times speed squared is {scaling * fastest**2:g} m2/s2: inertia may "
            f"raise the stresses; compare with a run of {INERTIA:g} or less"
        )
    return notes


def _strain(strain: Optional[float]) -> str:
    return "" if strain is None else f"{100 * strain:.3g} % strain"


def _pressure(pascals: Optional[float]) -> str:
    if pascals is None:
        return ""
    unit, factor = ("MPa", 1e-6) if abs(pascals) >= 1e6 else ("kPa", 1e-3)
    return f"{pascals * factor:.3g} {unit}"
