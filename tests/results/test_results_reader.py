"""Reading a results folder."""

import shutil

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError, Results, Scene, Simulation, read_events, run_events

xarray = pytest.importorskip("xarray")


@pytest.fixture
def damaged(finished, tmp_path):
    return Results(shutil.copytree(finished, tmp_path / "results"))


def test_tables_are_read_from_files_with_units(finished):
    results = Results(finished)
    pd.testing.assert_frame_equal(results.events, read_events(finished))
    units = results.events.attrs["units"]
    assert units["height_m"] == "m" and units["density_kg_m3"] == "kg/m3" and "steps" not in units
    assert list(results.outline) == ["event", "x", "z"]
    assert results.outline.attrs["units"] == {"x": "m", "z": "m"}
    of_events = read_events(finished).attrs
    assert of_events == results.events.attrs and of_events["scene"] == results.scene.json
    assert results.run["events"] == 2
    assert results.scene.data["events"]["count"] == 2


def test_particles_are_from_the_end_of_an_event(finished):
    """The particles of the last event agree with the checkpoint, in single precision."""
    results, last = Results(finished), Simulation.load(finished / "checkpoint.bin")
    particles = results.particles()
    assert particles["position"].dims == ("particle", "component")
    assert particles["velocity"].attrs["units"] == "m/s"
    assert np.array_equal(particles["particle"], last.ids())
    assert particles["position"].values == pytest.approx(last.positions(), abs=1e-6)
    assert int(particles["event_number"]) == 2
    assert float(particles["time"]) == pytest.approx(last.time)
    first = results.particles(1)
    assert first.sizes["particle"] < particles.sizes["particle"]
    for dataset in (first, particles):
        assert not any(dataset[name].isnull().any() for name in dataset.data_vars)
    with pytest.raises(InputError, match=r"event: 3; .*particles has 1, 2"):
        results.particles(3)


def test_energy_has_values_for_each_event(finished):
    energy = Results(finished).energy
    assert energy["kinetic_j"].dims == ("event",)
    assert energy["kinetic_j"].attrs["units"] == "J"
    assert energy["event"].values.tolist() == [1, 2]


def test_snapshots_are_sorted_by_time(tmp_path, tiny: Scene):
    tiny.update({"events.count": 1, "output.snapshot_interval": 0.1})
    run_events(tiny, tmp_path / "results", pictures=False)
    snapshots = list(Results(tmp_path / "results").snapshots())
    times = [float(snapshot["time"]) for snapshot in snapshots]
    assert len(times) > 3 and times == sorted(times)
    assert times[1] == pytest.approx(0.1, abs=0.01)
    heights = [float(s["position"].sel(component="z").mean()) for s in snapshots]
    assert heights[0] > heights[-1]


def test_a_folder_without_results_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no results; it holds no scene\.json"):
        Results(tmp_path / "nothing")


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("events.csv", lambda r: r.events),
        ("outline.csv", lambda r: r.outline),
        ("energy.csv", lambda r: r.energy),
        ("run.json", lambda r: r.run),
        ("scene.json", lambda r: r.scene),
        ("particles/event_002.vtp", lambda r: r.particles(2)),
    ],
)
def test_damage_is_reported_with_the_file(damaged, name, read):
    path = damaged.folder / name
    path.write_bytes(path.read_bytes()[:-20].replace(b"1", b"x"))
    with pytest.raises(InputError, match=name):
        read(damaged)


@pytest.mark.parametrize("name", ["outline.csv", "energy.csv", "run.json"])
def test_the_error_of_a_missing_file_names_its_source(damaged, name):
    (damaged.folder / name).unlink()
    with pytest.raises(InputError, match=rf"{name}: missing; a run "):
        getattr(damaged, name.partition(".")[0])


def test_without_snapshots_the_error_names_the_setting(finished):
    with pytest.raises(InputError, match=r"output\.snapshot_interval"):
        next(Results(finished).snapshots())


def test_a_series_must_not_refer_to_other_folders(damaged):
    folder = damaged.folder / "snapshots"
    folder.mkdir()
    (folder / "snapshots.pvd").write_text(
        "<VTKFile><Collection><DataSet timestep='0' file='../scene.json'/></Collection></VTKFile>"
    )
    with pytest.raises(InputError, match="does not lie in its folder"):
        next(damaged.snapshots())
