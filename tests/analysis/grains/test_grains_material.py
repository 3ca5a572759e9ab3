"""Snow fitted to loading tests: known parameters come back from the law's rate equations."""

import json

import numpy as np
import pytest
from validation.material_paths.rate_equations import RateEquations, evenly

from snowshed import InputError, Snow
from snowshed.analysis.grains.material import readings
from snowshed.analysis.grains.material.figures import material_figure
from snowshed.analysis.grains.material.fit import Range, fit_material
from snowshed.analysis.grains.material.law import CamClayFit, Elasticity
from snowshed.analysis.grains.material.loading_tests import NORMAL_STRESSES
from snowshed.analysis.grains.material.report import write_snow
from snowshed.analysis.grains.material.yield_surface import fit_yield_surface
from snowshed.methods.grains.curve import COLUMNS, LoadingCurve

E, NU, M, BETA, XI, P0 = 4e6, 0.25, 0.8, 0.15, 0.3, 2e4
SNOW = RateEquations(E, NU, M, BETA, XI, dimension=3)


def loading_curve(states, rate, times, broken):
    """Return the curve of a loading test: forces over initial areas; compression is positive."""
    stress = np.vstack([np.zeros(3), -SNOW.stress(states)])  # Kirchhoff
    stretch = np.exp(np.multiply.outer(np.concatenate([[0.0], times]), rate))
    nominal = stress / stretch
    columns = {name: np.zeros(len(stress)) for name in COLUMNS}
    columns.update(
        axial_strain=1 - stretch[:, 2],
        top_stress_pa=nominal[:, 2],
        bottom_stress_pa=nominal[:, 2],
        side_stress_pa=nominal[:, 0],
        broken_in_shear=broken(np.concatenate([[0.0], times])),
    )
    return LoadingCurve(columns)


def loaded(rate, end, count=400, broken=lambda times: 0.0 * times):
    times = evenly(end, count)
    rate = np.array(rate)
    return loading_curve(SNOW.integrate(SNOW.initial_state(P0), rate, times), rate, times, broken)


def sheared(normal):
    """Return a shear test under equal pressure that reaches the yield surface, then weakens."""
    peak = M * np.sqrt((normal + BETA * P0) * (P0 - normal) / (1 + 2 * BETA) / 3)
    strain = np.linspace(0, 0.02, 50)
    rising = strain <= strain[10]
    columns = {name: np.zeros(50) for name in COLUMNS}
    columns.update(
        shear_strain=strain,
        top_stress_pa=np.full(50, normal),
        bottom_stress_pa=np.full(50, normal),
        side_stress_pa=np.full(50, normal),
        shear_stress_pa=peak * np.where(rising, strain / strain[10], 0.3),
    )
    return LoadingCurve(columns)


def stretched():
    """Return a tension test without lateral stress that reaches the yield surface, then weakens."""
    ends = [0.0, 2e4]
    for _ in range(100):  # the tension on the yield surface, by bisection
        tension = 0.5 * sum(ends)
        p, q = -tension / 3, tension
        inside = (1 + 2 * BETA) * q**2 + M**2 * (p + BETA * P0) * (p - P0) < 0
        ends[0 if inside else 1] = tension
    columns = {name: np.zeros(3) for name in COLUMNS}
    along = -np.array([0.0, ends[0], 0.1 * ends[0]])
    strain = np.array([0.0, -2e-3, -4e-3])
    along = along / (1 - strain)  # a force over the initial area
    columns.update(axial_strain=strain, top_stress_pa=along, bottom_stress_pa=along)
    return LoadingCurve(columns)


@pytest.fixture(scope="module")
def curves():
    isotropic = loaded((-1.0, -1.0, -1.0), 0.127)
    # Up to 5 % strain, the curve is capped at the yield stress, beyond which the law hardens.
    pressure = readings.invariants(isotropic, isotropic=True)[0]
    early = isotropic["axial_strain"] <= 0.05
    capped = np.where(early, np.minimum(1.0, P0 / np.maximum(pressure, 1.0)), 1.0)
    columns = dict(isotropic.columns)
    for name in ("top_stress_pa", "bottom_stress_pa", "side_stress_pa"):
        columns[name] = columns[name] * capped
    return {
        ("confined", 0): loaded((0.0, 0.0, -1.0), 5e-3, 2000, broken=lambda t: 1.0 * (t > 1e-4)),
        ("isotropic", 0): LoadingCurve(columns),
        ("compaction", 0): loaded((-1.0, -1.0, -1.0), 0.127),
        ("tension", 0): stretched(),
        **{(f"shear under {part} p0", 0): sheared(part * P0) for part in NORMAL_STRESSES},
    }


def test_each_reading_recovers_the_parameters_of_the_law():
    elastic, linearity = readings.elasticity(loaded((0.0, 0.0, -1.0), 1e-4, 20))
    assert elastic.youngs_modulus == pytest.approx(E, rel=1e-3)
    assert elastic.poissons_ratio == pytest.approx(NU, rel=1e-3)
    assert linearity > 0.9999
    hardening = readings.hardening(loaded((-1.0, -1.0, -1.0), 0.127), Elasticity(E, NU), P0)
    assert hardening.factor == pytest.approx(XI, rel=1e-3)
    assert hardening.residual < 0.01 and 1.0 <= hardening.excess < 1.1  # from the elastic rows
    points = [readings.shear_strength(sheared(5e3)), readings.tension(stretched())]
    surface = fit_yield_surface(*np.array(points).T / P0)
    assert (surface.slope, surface.cohesion) == pytest.approx((M, BETA), rel=1e-5)
    assert surface.residual < 1e-6


@pytest.mark.parametrize("factor", [1e-9, 0.1, 1.0, 900.0])
def test_hardening_has_a_closed_form(factor):
    bulk, compaction = E / (3 - 6 * NU), np.linspace(0.0, 0.6, 50)
    expected = bulk * np.sinh(np.arcsinh(P0 / bulk) + factor * compaction)
    law = CamClayFit(300.0, Elasticity(E, NU), M, P0, BETA, factor)
    assert law.hardened(compaction) == pytest.approx(expected, rel=1e-12)
    assert law.dilation_at_strength_loss == pytest.approx(np.arcsinh(P0 / bulk) / factor, rel=1e-12)


def test_confined_compression_yields_where_the_rate_equations_do():
    law = CamClayFit(300.0, Elasticity(E, NU), M, P0, BETA, XI)
    times = evenly(2e-2, 4000)
    states = SNOW.integrate(SNOW.initial_state(P0), np.array([0.0, 0.0, -1.0]), times)
    first = np.flatnonzero(np.abs(states[:, -1] - states[0, -1]) > 1e-12)[0]  # hardens or dilates
    assert -SNOW.stress(states)[first, 2] == pytest.approx(law.confined_yield(), rel=2e-3)


def test_rows_after_the_first_broken_bond_do_not_count(curves):
    broken = loaded((0.0, 0.0, -1.0), 5e-3, 200, broken=lambda times: np.floor(times / 2e-4))
    assert readings.elasticity(broken)[0].youngs_modulus == pytest.approx(E, rel=1e-3)


def test_the_fit_finds_all_parameters(curves):
    fitted = fit_material(curves, 300.0)
    assert fitted.law.elastic.youngs_modulus == pytest.approx(E, rel=0.01)
    assert fitted.law.elastic.poissons_ratio == pytest.approx(NU, rel=0.01)
    assert fitted.law.preconsolidation_pressure == pytest.approx(P0, rel=0.01)
    assert fitted.law.critical_state_slope == pytest.approx(M, rel=0.01)
    assert fitted.law.cohesion == pytest.approx(BETA, rel=0.01)
    assert fitted.law.hardening_factor == pytest.approx(XI, rel=0.01)
    assert any("one sample" in note for note in fitted.notes)
    assert material_figure(fitted, curves, synthetic=True).axes


def test_another_modulus_keeps_the_hardening(curves):
    laws = [fit_material(curves, 300.0, modulus=factor * E).law for factor in (0.5, 1.0, 3.0)]
    plastic = np.linspace(0.0, 0.4, 400)
    pressures = []
    for law in laws:
        pressure = law.hardened(plastic)
        total = plastic + pressure / law.elastic.bulk_modulus
        pressures.append(np.interp([0.2, 0.35], total, pressure))
    assert pressures[0] == pytest.approx(pressures[1], rel=0.1)
    assert pressures[2] == pytest.approx(pressures[1], rel=0.1)


def test_impossible_fits_are_refused(curves):
    with pytest.raises(InputError, match="large elastic strains only"):
        fit_material(curves, 300.0, modulus=2e4)
    with pytest.raises(InputError, match="too soft for the hardening"):
        fit_material(curves, 300.0, modulus=E / 4)
    without = {key: curve for key, curve in curves.items() if key[0] != "tension"}
    with pytest.raises(InputError, match="no test tension"):
        fit_material(without, 300.0)
    loose = {**curves, ("tension", 0): curves["confined", 0]}
    columns = {**loose["tension", 0].columns, "top_stress_pa": np.ones(2001)}
    loose["tension", 0] = LoadingCurve({**columns, "bottom_stress_pa": np.ones(2001)})
    with pytest.raises(InputError, match="tension, sample 1: no tension"):
        fit_material(loose, 300.0)


def test_a_yield_surface_fits_impossible_strengths_with_a_residual():
    """Strengths that no surface has leave a residual; the surface always has shear strength."""
    p, q = np.array([-0.3, 0.1, 0.3, 0.8]), np.array([0.9, 0.3, 0.35, 1.7])
    surface = fit_yield_surface(p, q)
    assert surface.slope > 0.1 and 0.1 < surface.residual < 1.0
    with pytest.raises(InputError, match="no shear"):
        fit_yield_surface(p, 0 * q)
    with pytest.raises(InputError, match="no yield surface"):
        fit_yield_surface(np.array([1.5]), np.array([0.2]))


def test_ranges_follow_from_the_scatter():
    fitted_range = Range.of([1.0, 2.0, 4.0])
    assert fitted_range.value == pytest.approx(2.0)
    assert fitted_range.deviation == pytest.approx(np.log(2.0))
    assert fitted_range.low < 2.0 < fitted_range.high
    assert np.isnan(Range.of([3.0]).low)


def test_the_file_is_a_snow_with_its_provenance(curves, tmp_path):
    fitted = fit_material(curves, 300.0)
    file = write_snow(tmp_path, fitted, {"samples": []})
    snow = Snow.load(file)
    assert snow.preconsolidation_pressure == pytest.approx(P0, rel=0.01)
    assert set(snow.to_data()) == set(json.loads(file.read_text())) - {"provenance"}
    provenance = json.loads(file.read_text())["provenance"]
    assert provenance["ranges"]["cohesion"]["value"] == pytest.approx(BETA, rel=0.01)
    assert provenance["ranges"]["cohesion"]["low"] is None  # a single sample gives no range


def test_a_snow_is_a_preset_or_a_file(tmp_path):
    file = tmp_path / "mine.json"
    file.write_text('{"density": 150, "provenance": {"by": "hand"}}')
    assert Snow.preset_or_file(str(file)).density == 150
    assert Snow.preset_or_file("calibrated").density == 210
    with pytest.raises(InputError, match=r"calibrated.*JSON file"):
        Snow.preset_or_file("claibrated")
    file.write_text('{"densty": 150}')
    with pytest.raises(InputError, match=r"mine.json: .*densty"):
        Snow.preset_or_file(str(file))
