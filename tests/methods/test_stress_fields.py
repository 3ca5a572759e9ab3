"""Stresses of particles agree with those computed from their elastic strains."""

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import Simulation


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("model", ["cam_clay", "elastic"])
def test_stresses_follow_from_the_elastic_strain(dimension, model):
    scene = tiny_scene(**{"dimension": dimension, "snow.model": model, "events.count": 1})
    scene.update({"numerics.precision": "double", "snow.youngs_modulus": 2e5})
    simulation = Simulation(scene)
    simulation.begin_event()
    simulation.run(until=0.35)  # during the impact
    axes = "xz" if dimension == 2 else "xyz"
    strain = np.zeros((simulation.particle_count, dimension, dimension))
    for i, a in enumerate(axes):
        for j, b in enumerate(axes):
            name = "be_minus_identity_" + (a + b if i <= j else b + a)
            strain[:, i, j] = simulation.fields[name].by_id()
    values, vectors = np.linalg.eigh(np.eye(dimension) + strain)
    hencky = np.einsum("nik,nk,njk->nij", vectors, 0.5 * np.log(values), vectors)
    trace = np.trace(hencky, axis1=1, axis2=2)
    deviator = hencky - (trace / dimension)[:, None, None] * np.eye(dimension)
    shear = 2 * 2e5 / (2 * 1.3) * deviator
    expected = np.sqrt(1.5 * (shear**2).sum(axis=(1, 2)))
    stress = simulation.fields["deviatoric_stress"].by_id()
    assert expected.max() > 100
    assert stress == pytest.approx(expected, rel=1e-6, abs=1e-6 * expected.max())
    dataset = simulation.to_xarray()
    assert dataset.deviatoric_stress.attrs["units"] == "Pa"
    if model == "elastic":
        assert "preconsolidation_pressure" not in dataset
        return
    hardness = dataset.preconsolidation_pressure.values
    modulus = 2e5 / (3 - 6 * 0.3)
    plastic = simulation.plastic_strains()
    assert hardness == pytest.approx(modulus * np.sinh(0.1 * np.maximum(-plastic, 0)), rel=1e-9)
    slope, cohesion = 0.5, 0.2  # no particle is beyond its yield surface, and some are on it
    pressure = simulation.pressures()
    inside = (pressure + cohesion * hardness) * (hardness - pressure) * slope**2
    excess = (1 + 2 * cohesion) * stress**2 - inside
    assert (excess <= 1e-6 * hardness**2 + 1e-6).all()
    assert (np.abs(excess) < 1e-6 * stress**2).any()
