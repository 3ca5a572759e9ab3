"""Contact conditions and damping that scenes choose, and their record in results."""

import json
import math

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import Body, Ground, Obstacle, Scene, Shape, Simulation, Snow, run_events
from snowshed.analysis.accuracy.incline import Incline

CONDITIONS = ("sticky", "slip", "separate")


def elastic(**parts) -> Scene:
    scene = Scene(dimension=2, snow=Snow(model="elastic"), **parts)
    return scene.update({"numerics": {"dx": 0.01, "threads": 1, "sleep_speed": 0.0}})


def run(scene: Scene, until: float) -> Simulation:
    sim = Simulation(scene)
    sim.begin_event()
    while sim.time < until:
        sim.step(20)
    return sim


@pytest.mark.filterwarnings("ignore:condition:FutureWarning")
def test_only_separate_releases_snow_that_is_pulled_off():
    def displacement(condition: str) -> tuple[float, float]:
        """Return the lowest layer's motion along the ground and up, relative to free flight."""
        block = Body(Shape.box((0, 0.02), (0.08, 0.04)), velocity=(0.3, 0.3))
        ground = Ground(condition=condition, friction=0.0)
        sim = Simulation(elastic(ground=ground, bodies=[block], gravity=0.0))
        sim.begin_event()
        start = sim.positions()
        lowest = start[:, -1] < 0.005
        while sim.time < 0.1:
            sim.step(20)
        x, *_, z = (sim.positions() - start)[lowest].mean(axis=0)
        return x / (0.3 * sim.time), z / (0.3 * sim.time)

    displacements = {condition: displacement(condition) for condition in CONDITIONS}
    assert displacements["sticky"] == pytest.approx((0, 0), abs=0.03)
    assert displacements["slip"] == pytest.approx((1, 0), abs=0.03)
    assert displacements["separate"] == pytest.approx((1, 1), abs=0.03)


@pytest.mark.filterwarnings("ignore:condition:FutureWarning")
def test_only_separate_lets_a_slab_tip_over_an_edge():
    def drop(condition: str) -> float:
        """Return the drop of a slab that reaches 12 of its 20 cm beyond a shelf, m."""
        shelf = Obstacle(
            shape=Shape.box((-0.5, 0.95), (1.0, 0.1)), condition=condition, friction=0.8
        )
        slab = Body(Shape.box((0.02, 1.02), (0.2, 0.04)))
        sim = run(elastic(obstacles=[shelf], bodies=[slab]), 0.45)
        return float(1.02 - sim.positions()[:, -1].mean())

    drops = {condition: drop(condition) for condition in CONDITIONS}
    assert drops["separate"] > 0.1
    assert abs(drops["slip"]) < 0.01 and abs(drops["sticky"]) < 0.01


@pytest.mark.filterwarnings("ignore:condition:FutureWarning")
@pytest.mark.parametrize("condition", ["slip", "separate"])
def test_a_slab_follows_coulombs_law_near_the_limit(condition):
    """With slip, tension at some nodes must not add to the friction at others."""
    incline = Incline(40.0, dimension=2)
    scene = incline.scene((2.0, 0.05), 0.8, condition=condition)
    scene.update({"numerics": {"dx": 0.01, "threads": 1, "sleep_speed": 0.0}})
    sim = run(scene, 0.1)
    begin, time = sim.velocities()[:, [0, -1]].mean(axis=0) @ incline.slope, sim.time
    while sim.time < 0.3:
        sim.step(20)
    gained = sim.velocities()[:, [0, -1]].mean(axis=0) @ incline.slope - begin
    friction = incline.coulomb(0.0) - gained / (sim.time - time)  # tan 40 is 0.84
    assert friction == pytest.approx(incline.coulomb(0.0) - incline.coulomb(0.8), rel=0.005)


def collapsed(**numerics: float) -> float:
    """Return the width of a column of weak snow after its collapse, m."""
    snow = Snow(preconsolidation_pressure=2000, cohesion=0.05)
    column = Body(Shape.box((0, 0.15), (0.2, 0.3)))
    scene = Scene(dimension=2, ground=Ground(), snow=snow, bodies=[column])
    scene.update({"numerics": {"dx": 0.02, "threads": 1, "sleep_speed": 0.0, **numerics}})
    return float(run(scene, 0.4).positions()[:, 0].std())


@pytest.mark.parametrize(
    ("damping", "independent"), [({"damping_rate": 95.0}, True), ({"flip_ratio": 0.99}, False)]
)
def test_damping_by_a_rate_does_not_depend_on_the_step(damping, independent):
    widths = [collapsed(courant_factor=factor, **damping) for factor in (0.9, 0.6, 0.3)]
    spread = np.ptp(widths) / widths[0]
    assert spread < 0.02 if independent else spread > 0.08, widths


@pytest.mark.parametrize(
    ("numerics", "rate"),
    [({"damping_rate": 40.0}, 40.0), ({"transfer": "apic"}, None), ({"flip_ratio": 0.0}, None)],
)
def test_results_state_the_rate_of_damping(tmp_path, numerics, rate):
    scene = tiny_scene().update({f"numerics.{name}": value for name, value in numerics.items()})
    table = run_events(scene, tmp_path / "run", pictures=False)
    facts = json.loads((tmp_path / "run" / "run.json").read_text())
    assert facts["damping_rate_per_s"] == rate
    assert all(event["damping_rate_per_s"] == rate for event in facts["finished_events"])
    if rate is None:
        assert table.damping_rate_per_s.isna().all()
    else:
        assert (table.damping_rate_per_s == rate).all()


def test_a_share_in_each_step_is_a_mean_rate_over_all_steps(tmp_path):
    table = run_events(tiny_scene(), tmp_path / "run", pictures=False)
    expected = -math.log(0.99) * table.steps / table.sim_time_s
    np.testing.assert_allclose(table.damping_rate_per_s, expected, rtol=1e-6)
    facts = json.loads((tmp_path / "run" / "run.json").read_text())
    mean_rate = -math.log(0.99) * table.steps.sum() / table.sim_time_s.sum()
    assert facts["damping_rate_per_s"] == pytest.approx(mean_rate, rel=1e-6)


def test_a_scheme_sets_its_mechanisms() -> None:
    scene = Scene.preset("lab-50").set("numerics.scheme", "objective")
    numerics = scene.resolve().data["numerics"]
    assert numerics["transfer"] == "affine_flip"
    assert (numerics["damping_rate"], numerics["damping_length"]) == (380.0, 0.01)
    assert (numerics["contact"], numerics["fields"]) == ("touch", "events")
    slower = scene.set("numerics.damping_rate", 190.0).resolve().data["numerics"]
    assert slower["damping_rate"] == 190.0
    assert slower["transfer"] == "affine_flip"
