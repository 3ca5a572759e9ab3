"""Slabs of several layers, through the Python package."""

import json

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import Body, InputError, Layer, Scene, Shape, Snow, _core, run_events
from snowshed.cli.main import main
from snowshed.plot.caption import scene_caption


def light_snow() -> Snow:
    return Snow(density=100, youngs_modulus=3e5)


def layered_scene(**values: object) -> Scene:
    """A light layer below the scene's snow, and in the second event another one on top."""
    layers = [Layer(thickness=0.02, snow=light_snow()), Layer(thickness=0.02)]
    layers.append(Layer(thickness=0.02, snow=Snow(density=150), event=2))
    scene = tiny_scene(**values)
    return scene.update({"slab.thickness": None, "slab.layers": layers})


def test_a_layer_takes_missing_properties_from_the_scenes_snow():
    scene = layered_scene(**{"snow.cohesion": 0.15})
    layers = scene.resolve().data["slab"]["layers"]
    assert layers[0]["snow"]["density"] == 100
    assert layers[0]["snow"]["cohesion"] == 0.15
    assert "snow" not in layers[1]
    assert [layer["event"] for layer in layers] == [0, 0, 2]


def test_layers_bring_their_own_snow_in_their_events(tmp_path):
    folder = tmp_path / "results"
    table = run_events(layered_scene(**{"output.energy": True}), folder, pictures=False)
    area = 0.245
    brought = [area * 0.02 * (100 + 210), area * 0.02 * (100 + 210 + 150)]
    total = (table.mass_kg + table.on_panel_kg).tolist()
    assert total == pytest.approx(np.cumsum(brought), rel=1e-5)
    simulation = _core.Simulation.load(str(folder / "checkpoint.bin"))
    kinds, masses = simulation.material_ids(), simulation.masses()
    assert [json.loads(snow)["density"] for snow in simulation.snows] == [100, 210, 150]
    mass_by_snow = [masses[kinds == kind].sum() for kind in range(3)]
    assert mass_by_snow == pytest.approx([2 * area * 2, 2 * area * 4.2, area * 3], rel=1e-5)
    assert b'Name="material_id"' in (folder / "particles" / "event_002.vtp").read_bytes()[:4000]


def test_reseeding_converts_each_snow_separately(tmp_path):
    scene = layered_scene(**{"events.between": "reseed"})
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    simulation.run(lambda _: True)
    conversion = simulation.begin_event()
    assert set(conversion["densities_after"]) == {100.0, 210.0}
    for density in (100.0, 210.0):
        masses = [
            conversion[f"masses_{when}"][conversion[f"densities_{when}"] == density].sum()
            for when in ("before", "after")
        ]
        assert masses[1] == pytest.approx(masses[0], rel=1e-6)


def test_a_single_snow_needs_no_material_ids(finished):
    simulation = _core.Simulation.load(str(finished / "checkpoint.bin"))
    assert len(simulation.snows) == 1
    assert (
        not simulation.material_ids().any()
        and len(simulation.material_ids()) == simulation.particle_count
    )
    first = next((finished / "particles").glob("*.vtp"))
    assert b'Name="material_id"' not in first.read_bytes()


def test_bodies_may_have_their_own_snow():
    scene = Scene(dimension=2)
    for x in (0.0, 1.0):
        scene.append("bodies", Body(shape=Shape.sphere((x, 1.0), 0.1)))
    scene.set("bodies.1.snow", light_snow()).set("numerics.dx", 0.02)
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    right = simulation.positions()[:, 0] > 0.5
    assert simulation.densities()[right] == pytest.approx(100)
    assert simulation.densities()[~right] == pytest.approx(210)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"slab.thickness": 0.02}, "/slab/thickness: 0.02 m and /slab/layers are both given"),
        ({"slab.layers": []}, "/slab/thickness: missing"),
        ({"slab.layers.1.event": 3}, "/slab/layers/1/event: 3 is beyond the last event"),
        ({"slab.layers.0.snow.density": -1}, "/slab/layers/0/snow/density: -1"),
        ({"slab.layers.0.thickness": None}, "/slab/layers/0/thickness: missing"),
    ],
)
def test_bad_layers_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        layered_scene().update(changes).resolve()


def test_the_command_line_takes_layers(tmp_path):
    layers = ['{"thickness": 0.02, "snow": {"density": 100}}', '{"thickness": 0.03}']
    options = [word for layer in layers for word in ("--layer", layer)]
    file = tmp_path / "scene.json"
    arguments = ["scene", "--height", "1", "--length", "1", "--dim", "2", *options]
    assert main([*arguments, "-o", str(file)]) == 0
    data = json.loads(file.read_text())
    assert [layer["thickness"] for layer in data["slab"]["layers"]] == [0.02, 0.03]
    assert "layers 0.02, 0.03 m" in scene_caption(data)
