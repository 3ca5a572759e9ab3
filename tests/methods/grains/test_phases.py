"""Phases of curves given by formulas."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.methods.grains.curve import COLUMNS, LoadingCurve
from snowshed.methods.grains.phases import find_phases, mean_stress
from snowshed.methods.grains.strength_scatter import scatter_note
from snowshed.methods.grains.summary import summarise

STRAIN = 0.3 * (np.arange(301) / 300) ** 2
NUMERICS = {"density": 917.0, "density_scaling": 1.0}


def curve_of(strain=STRAIN, **columns):
    """Return a curve with these columns; without `bottom_stress_pa`, both plates bear the same."""
    blank = {name: np.zeros_like(strain) for name in COLUMNS}
    if "top_stress_pa" in columns:
        blank["bottom_stress_pa"] = columns["top_stress_pa"]
    return LoadingCurve({**blank, "stage": np.ones_like(strain), "axial_strain": strain, **columns})


def brittle(noise=0.0):
    """Linear to 0.001 and 20 kPa, a plateau of 8 kPa, then exp(30 strain) from 0.18 on."""
    stress = np.where(
        STRAIN <= 0.001, 2e7 * STRAIN, 8e3 * np.exp(30 * np.maximum(STRAIN - 0.18, 0))
    )
    scatter = np.exp(noise * np.random.default_rng(3).standard_normal(len(STRAIN)))
    broken = np.where(STRAIN > 0.001, np.ceil(1000 * STRAIN), 0.0)
    stress = np.where(STRAIN <= 0.001, stress, stress * scatter)
    return curve_of(top_stress_pa=stress, broken_in_shear=broken)


@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_phases_of_an_analytic_curve_are_recovered(noise):
    phases = find_phases(brittle(noise))
    assert phases.elastic_limit == pytest.approx(0.001, rel=0.15)
    assert phases.tangent_modulus == pytest.approx(2e7, rel=1e-6)
    assert phases.linearity == pytest.approx(1.0, abs=1e-9)
    assert phases.hardening_onset == pytest.approx(0.18, abs=0.03)
    assert phases.hardening_rate == pytest.approx(30, rel=0.3)


def test_strength_in_compression_is_the_peak_below_five_percent_strain():
    assert find_phases(brittle()).strength == pytest.approx(2e7 * 0.001, rel=0.05)


def test_the_impact_of_the_plate_does_not_count_as_strength():
    curve = brittle()
    knocked = curve["top_stress_pa"] + np.where(STRAIN < 5e-4, 1e6, 0.0)
    columns = {name: curve[name] for name in ("bottom_stress_pa", "broken_in_shear")}
    phases = find_phases(curve_of(top_stress_pa=knocked, **columns))
    assert phases.strength == find_phases(curve).strength


def test_strength_is_the_peak_of_all_steps_not_only_of_rows():
    curve = brittle()
    names = ("axial_strain", "top_stress_pa", "bottom_stress_pa")
    peaks = {f"peak_{name}": curve[name].copy() for name in names}
    row = int(np.argmax(curve["top_stress_pa"][STRAIN < 0.05]))
    peaks["peak_top_stress_pa"][row + 1] = peaks["peak_bottom_stress_pa"][row + 1] = 2.5e4
    phases = find_phases(LoadingCurve({**curve.columns, **peaks}))
    assert phases.strength == 2.5e4
    assert phases.tangent_modulus == find_phases(curve).tangent_modulus
    peaks["peak_axial_strain"][row + 1] = 0.06  # beyond the brittle phase
    assert find_phases(LoadingCurve({**curve.columns, **peaks})).strength < 2.5e4


def test_a_stage_does_not_include_the_peak_of_the_previous_stage():
    columns = {name: np.zeros(4) for name in COLUMNS}
    columns["stage"] = np.array([1.0, 1.0, 2.0, 2.0])
    columns["peak_top_stress_pa"] = np.array([0.0, 9.0, 1.0, 2.0])
    curve = LoadingCurve(columns)
    assert curve.of_stage(1).peaks["top_stress_pa"].tolist() == [0.0, 9.0]
    assert curve.of_stage(2).peaks["top_stress_pa"].tolist() == [0.0, 1.0, 2.0]
    assert curve["peak_top_stress_pa"][1] == 9.0  # the curve itself is unchanged


IDLE = np.zeros_like(STRAIN)


@pytest.mark.parametrize(
    ("kind", "columns", "reason"),
    [
        ("compress", {}, "the plates never touched the snow"),
        ("stretch", {}, "the plates never touched the snow"),
        ("isotropic", {"side_stress_pa": 1e4 * STRAIN}, "the plates never touched the snow"),
        ("compress", {"top_stress_pa": 1e4 * STRAIN, "bottom_stress_pa": IDLE},
         "the bottom plate never touched the snow"),
        ("compress", {"bottom_stress_pa": IDLE + 5.0}, "the top plate never touched the snow"),
        ("shear", {"top_stress_pa": IDLE + 5.0}, "the top plate never dragged the snow along"),
        ("penetrate", {}, "the cone never touched the snow"),
    ],
)  # fmt: skip
def test_without_contact_figures_are_missing_with_a_note(kind, columns, reason):
    curve = curve_of(**columns)
    summary = summarise(curve, scene_of(kind), ended="rest", grains=2000, spheres=9)
    figures = ("strength_pa", "tangent_modulus_pa", "linearity", "elastic_limit_strain",
               "mean_stress_5_10_pa", "mean_stress_25_30_pa", "hardening_rate")  # fmt: skip
    if kind == "penetrate":
        assert summary.largest_cone_force_n is None
    else:
        assert [getattr(summary, name) for name in figures] == [None] * len(figures)
    assert any(note.startswith(reason) for note in summary.notes)


def test_a_late_contact_does_not_change_the_modulus():
    stress = np.where(STRAIN > 0.02, 2e7 * (STRAIN - 0.02), 0.0)
    broken = np.where(STRAIN > 0.03, 5.0, 0.0)
    curve = curve_of(top_stress_pa=stress, broken_in_shear=broken)
    assert find_phases(curve).tangent_modulus == pytest.approx(2e7, rel=0.02)
    summary = summarise(curve, scene_of(), ended="rest", grains=2000, spheres=9)
    assert any("nothing touched the snow before a strain of 1.9" in note for note in summary.notes)


def test_a_plateau_does_not_harden():
    phases = find_phases(curve_of(top_stress_pa=np.full_like(STRAIN, 5e3)))
    assert phases.hardening_onset is None and phases.hardening_rate is None


def test_an_oscillating_stress_does_not_harden():
    wobble = np.exp(1.5 * np.sin(2 * np.pi * STRAIN / 0.11) + 3.0 * STRAIN)
    phases = find_phases(curve_of(top_stress_pa=1e4 * wobble))
    assert phases.hardening_onset is None and phases.hardening_rate is None


def test_the_strength_of_a_pulled_sample_is_its_largest_tension():
    strain = np.linspace(0.0, 0.02, 50)
    stress = -np.where(strain < 0.01, 1e6 * strain, 0.0)
    broken = np.where(strain < 0.01, 0.0, 9.0)
    phases = find_phases(
        curve_of(-strain, top_stress_pa=stress, broken_in_tension=broken), "stretch"
    )
    assert phases.strength == pytest.approx(1e6 * strain[strain < 0.01].max())
    assert phases.tangent_modulus == pytest.approx(1e6)


def test_means_are_over_strain_not_over_rows():
    strain = np.array([0.0, 0.01, 0.02, 0.1])  # rows are dense where the stress is low
    stress = np.array([0.0, 0.0, 0.0, 8.0])
    assert mean_stress(strain, stress, 0.0, 0.1) == pytest.approx(0.5 * 0.08 * 8.0 / 0.1)
    assert mean_stress(strain, stress, 0.05, 0.2) is None


def test_a_short_curve_has_no_phases():
    assert find_phases(curve_of(STRAIN[:1])).tangent_modulus is None
    two_rows = find_phases(curve_of(STRAIN[:2]))
    assert two_rows.tangent_modulus is None and two_rows.hardening_onset is None


def scene_of(kind="compress", speed=0.02, **numerics):
    return {
        "loading": [{"kind": kind, "speed": speed}],
        "sample": {"voxel_size": 1e-4},
        "numerics": {**NUMERICS, **numerics},
    }


def test_the_summary_notes_why_its_figures_are_doubtful():
    columns = dict(brittle().columns)
    columns["bottom_stress_pa"] = np.zeros_like(STRAIN)  # no stress on this plate
    uneven = LoadingCurve(columns)
    few_grains = summarise(
        uneven, scene_of(density_scaling=1000.0), ended="rest", grains=87, spheres=9
    )
    notes = " ".join(few_grains.notes)
    assert "87 grains" in notes and "density_scaling times speed squared is 0.4" in notes
    assert "differ by 200 %" in notes
    many_grains = summarise(brittle(), scene_of(), ended="rest", grains=1000, spheres=9)
    assert many_grains.notes == (scatter_note(None),)


def test_a_curve_is_read_back_as_written(tmp_path):
    curve = brittle(0.3)
    (tmp_path / "curve.csv").write_text(curve.text())
    read = LoadingCurve.read(tmp_path / "curve.csv")
    assert all((read[name] == curve[name]).all() for name in COLUMNS)
    (tmp_path / "other.csv").write_text("time_s,stage\n0,1\n")
    with pytest.raises(InputError, match="the column axial_strain is missing"):
        LoadingCurve.read(tmp_path / "other.csv")
