"""The release criterion and the simulated slide-off clear the same panels."""

import pytest

from snowshed import Scene, _core
from snowshed.season import snow_balance


@pytest.mark.parametrize("friction", [0.5, 0.55, 0.6, 0.7, 0.8])
def test_the_lab_panel_at_30_degrees_clears_as_the_criterion_predicts(friction):
    scene = Scene.preset("lab-40").update({"dimension": 2, "panel.tilt": 30.0, "numerics.dx": 0.02})
    scene.update({"panel.friction": friction, "events.max_time": 3.0, "numerics.threads": 1})
    scene.update({"seeding.particles_per_voxel": 8, "snow.youngs_modulus": 2e5})
    resolved = scene.resolve()
    simulation = _core.Simulation(resolved.json, resolved.base_dir)
    simulation.begin_event()
    assert simulation.run(lambda _: True) == "rest"
    masses = simulation.masses()
    share_on_panel = masses[simulation.on_panel()].sum() / masses.sum()
    releases = snow_balance(210.0 * 0.02, 30.0, friction, 0.0).releases
    assert (share_on_panel < 0.02) if releases else (share_on_panel > 0.9)
