"""More events after a finished run, in a new folder."""

import hashlib
import json

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_scene
from helpers.interrupted_runs import compare_tables, interrupt_at

from snowshed import InputError, Interrupted, Results, Simulation, Snow, _core, run_events
from snowshed.cli.main import main
from snowshed.running import Ageing, Interval, sequence
from snowshed.running.extension import extend_run, extended_scene
from snowshed.scene.scene import resolve_scene


def fingerprints(folder):
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {str(f.relative_to(folder)): hashlib.sha256(f.read_bytes()).digest() for f in files}


@pytest.mark.parametrize("between", ["carry", "reseed"])
def test_an_extended_run_equals_a_run_with_all_events(tmp_path, between):
    scene = tiny_scene(**{"output.energy": True, "events.between": between})
    run_events(scene.set("events.count", 1), tmp_path / "one", pictures=False)
    before = fingerprints(tmp_path / "one")
    extend_run(tmp_path / "one", tmp_path / "more", 2, pictures=False)
    run_events(scene.set("events.count", 3), tmp_path / "three", pictures=False)
    compare_tables(tmp_path / "more", tmp_path / "three")
    names = ["energy.csv", "energy_history.csv", "scene.json", "particles.pvd"]
    names += [f"particles/event_00{k}.vtp" for k in (1, 2, 3)]
    names += ["conversions.csv"] * (between == "reseed")
    for name in names:
        assert (tmp_path / "more" / name).read_bytes() == (tmp_path / "three" / name).read_bytes()
    records = [json.loads((tmp_path / name / "run.json").read_text()) for name in ("more", "three")]
    assert records[0]["notes"] == records[1]["notes"]
    assert fingerprints(tmp_path / "one") == before


def test_an_extended_run_drops_the_notes_of_its_earlier_end(tmp_path):
    scene = tiny_scene(**{"events.count": 1, "events.max_time": 0.1})
    run_events(scene, tmp_path / "one", pictures=False)
    extend_run(tmp_path / "one", tmp_path / "two", 1, pictures=False)
    notes = json.loads((tmp_path / "two" / "run.json").read_text())["notes"]
    ends = [note.split(" before")[0] for note in notes if "ended before the snow rested" in note]
    assert ends == ["2 of 2 events ended"]


def test_new_snow_lies_on_the_old_snow(finished, tmp_path):
    light = Snow(density=120.0, cohesion=0.05)
    table = extend_run(finished, tmp_path / "new", 1, snow=light, thickness=0.04, pictures=False)
    assert table.event.tolist() == [1, 2, 3]
    pd.testing.assert_frame_equal(table[:2], Results(finished).events, check_exact=True)
    particles = Results(tmp_path / "new").particles()
    is_light = particles["event"].values == 3
    assert np.array_equal(particles["material_id"].values == 1, is_light)
    mass = float(particles["mass"].values[is_light].sum())
    assert mass == pytest.approx(120 * 0.245 * 0.04, rel=1e-5)
    repeated = Simulation.load(tmp_path / "new" / "checkpoint.bin")
    assert [snow.density for snow in repeated.snows] == [210.0, 120.0]


@pytest.mark.parametrize(
    "energy", [False, True]
)  # without and with the snow's number for each particle
def test_the_old_snow_keeps_its_state(tmp_path, energy):
    scene = tiny_scene(**{"events.count": 1, "output.energy": energy}).resolve()
    run_events(scene, tmp_path, pictures=False)
    file = str(tmp_path / "checkpoint.bin")
    longer = extended_scene(scene, 1, snow=Snow(density=120.0, youngs_modulus=3e5))
    before, after = _core.Simulation.load(file), _core.Simulation.load_into(longer.json, ".", file)
    for name in ("position", "velocity", "pressure", "deviatoric_stress", "density", "material_id",
                 "preconsolidation_pressure", "volumetric_plastic_strain", "event"):  # fmt: skip
        assert np.array_equal(before.field_by_id(name), after.field_by_id(name)), name
    assert len(before.snows) == 1 and len(after.snows) == 2
    changed = scene.copied_data()
    changed["snow"]["density"] = 150.0
    with pytest.raises(InputError, match="does not name its snows first"):
        _core.Simulation.load_into(json.dumps(changed), ".", file)


def test_an_extended_run_can_be_extended_and_resumed(tmp_path, monkeypatch):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    scene = tiny_scene(**{"events.count": 1})
    run_events(scene, tmp_path / "a", pictures=False)
    extend_run(tmp_path / "a", tmp_path / "b", 1, thickness=0.03, pictures=False)
    stop = interrupt_at(3, 0.1)
    with pytest.raises(Interrupted):
        extend_run(tmp_path / "b", tmp_path / "c", 1, progress=stop, pictures=False)
    resumed = run_events(tmp_path / "c" / "scene.json", tmp_path / "c", resume=True, pictures=False)
    extend_run(tmp_path / "b", tmp_path / "d", 1, pictures=False)
    compare_tables(tmp_path / "c", tmp_path / "d")
    assert resumed.event.tolist() == [1, 2, 3]
    thicknesses = [
        layer["thickness"] for layer in Results(tmp_path / "d").scene.data["slab"]["layers"]
    ]
    assert thicknesses == [0.02, 0.03, 0.03]  # new layers take the last thickness


def test_an_extended_run_keeps_its_ageing(tmp_path):
    ageing = Ageing({2: [Interval(86400.0, -5.0)]}, settling="vionnet-2012")
    run_events(tiny_scene(), tmp_path / "two", ageing=ageing, pictures=False)
    extend_run(tmp_path / "two", tmp_path / "three", 1, pictures=False)
    assert json.loads((tmp_path / "three" / "ageing.json").read_text()) == ageing.data
    assert pd.read_csv(tmp_path / "three" / "ageing.csv").event.tolist() == [2]


def test_impossible_extensions_are_refused_without_files(finished, tmp_path, monkeypatch):
    monkeypatch.setattr(sequence, "REPORT_INTERVAL", 0.0)
    new = tmp_path / "new"
    with pytest.raises(InputError, match="not a run that can be extended"):
        extend_run(tmp_path, new, 1)
    with pytest.raises(InputError, match="events: 0; a whole number from 1"):
        extend_run(finished, new, 0)
    with pytest.raises(InputError, match=r"/events/count: 1002 is outside"):
        extend_run(finished, new, 1000)
    with pytest.raises(InputError, match=r"thickness: -1"):
        extend_run(finished, new, 1, thickness=-1.0)
    with pytest.raises(InputError, match="not empty"):
        extend_run(finished, finished, 1)
    with pytest.raises(Interrupted):
        run_events(tiny_scene(), tmp_path / "a", progress=interrupt_at(1, 0.05), pictures=False)
    with pytest.raises(InputError, match=r"not finished \(interrupted\); first resume it with"):
        extend_run(tmp_path / "a", new, 1)
    assert not new.exists() and sorted(tmp_path.iterdir()) == [tmp_path / "a"]


def test_a_thickness_needs_a_single_layer(finished):
    scene = Results(finished).scene
    layers = [{"thickness": 0.01}, {"thickness": 0.02}, {"thickness": 0.01, "event": 2}]
    data = scene.copied_data()
    data["slab"] = {"layers": layers}
    several = resolve_scene(data)
    with pytest.raises(InputError, match="/slab/layers: several"):
        extended_scene(several, 1, thickness=0.02)
    extended_layers = extended_scene(several, 1, snow=Snow(density=100.0)).data["slab"]["layers"]
    rows = [
        (layer["event"], layer["thickness"], layer.get("snow", {}).get("density"))
        for layer in extended_layers
    ]
    assert rows == [
        *((1, 0.01, None), (1, 0.02, None)),  # the snow of the scene
        *((2, 0.01, None), (2, 0.02, None), (2, 0.01, None)),
        *((3, 0.01, 100.0), (3, 0.02, 100.0)),
    ]


def test_the_command_extends_a_run(finished, tmp_path, capsys):
    new = str(tmp_path / "new")
    assert main(["extend", str(finished), "--events", "1", "--snow", "reference", "-o", new]) == 0
    out = capsys.readouterr().out
    assert "Stack after each event" in out and "energy.png" in out
    assert (tmp_path / "new" / "energy.png").is_file()
    assert main(["extend", str(finished), "--snow", "wet", "-o", new + "2"]) == 2
    assert "error: " in capsys.readouterr().err
