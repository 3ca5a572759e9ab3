"""Results as OpenVDB files, and scenes from these files."""

import time

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import InputError, Scene, Shape, _core, measure_stack
from snowshed.cli.main import main
from snowshed.io import write_vdb
from snowshed.io.vtk.vtp import read_particles
from snowshed.results.folder import read_events
from snowshed.results.vdb_export import export_folder
from snowshed.running.conversion import outline_difference

DX = 0.02  # of the tiny scene


@pytest.fixture(scope="module")
def exported(finished, tmp_path_factory):
    return export_folder(finished, tmp_path_factory.mktemp("vdb"))


def seeded(shape, **values):
    """Return the simulation of a scene with a single body, after seeding."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": DX, **values})
    scene.panel = scene.slab = None
    scene.append("bodies", {"shape": shape})
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    return simulation


def measured(positions, masses):
    densities = np.full(len(masses), 200.0)
    return measure_stack(positions, masses, densities, dimension=2, dx=DX)


def test_each_event_has_a_file_with_its_mass(finished, exported):
    assert [e.file.name for e in exported] == ["event_001.vdb", "event_002.vdb"]
    events = read_events(finished)
    for event, written in zip(events.itertuples(), exported):
        assert written.file.stat().st_size > 1000
        mass = event.mass_kg + event.on_panel_kg
        assert written.content.mass == pytest.approx(mass, rel=1e-6)
        assert 100 < written.content.density < 300


def test_the_stack_is_recovered_from_its_level_set(finished, exported):
    for event, written in enumerate(exported, start=1):
        particles = read_particles(finished / "particles" / f"event_{event:03d}.vtp")
        original = measured(particles["position"].astype(float), particles["mass"].astype(float))
        # As in the guide, the scene has the bulk density of the stack.
        density = {"snow.density": written.content.density}
        shape = Shape.vdb(str(written.file), grid="surface").to_data()
        simulation = seeded(shape, **density)
        result = measured(simulation.positions(), simulation.masses())
        assert result.mass == pytest.approx(original.mass, rel=0.01)
        assert result.height == pytest.approx(original.height, abs=DX / 2)
        for end in (np.min, np.max):
            ends = [end(x[:, 0]) for x in (particles["position"], simulation.positions())]
            assert ends[1] == pytest.approx(ends[0], abs=DX / 2)
        assert outline_difference(original.outline, result.outline) < DX / 2


def test_a_level_set_is_an_obstacle_of_its_shape(tmp_path):
    """Distances from a box of particles are exact to a voxel, also beyond the band."""
    size, center = np.array([0.4, 0.2]), np.array([0.3, 0.1])
    rng = np.random.default_rng(1)
    x = center + (rng.random((6000, 2)) - 0.5) * size
    positions = np.column_stack([x[:, 0], 0 * x[:, 0], x[:, 1]])
    file = tmp_path / "box.vdb"
    write_vdb(file, positions, np.ones(6000), dimension=2, dx=DX, particles_per_voxel=30, width=0.5)
    scene = tiny_scene()
    scene.append("obstacles", {"shape": {"type": "vdb", "file": str(file), "grid": "surface"}})
    simulation = _core.Simulation(scene.resolve().json)
    points = np.array([[0.3, 0, 0.1], [0.3, 0, 0.4], [0.9, 0, 0.1], [0.3, 0, 0.18], [0.11, 0, 0.1]])
    offset = np.abs(points[:, [0, 2]] - center) - size / 2
    outside = np.linalg.norm(np.maximum(offset, 0), axis=1)
    expected = outside + np.minimum(offset.max(axis=1), 0)
    assert np.allclose(simulation.obstacle_distance(points), expected, atol=DX / 2)


def test_the_command_writes_into_the_results_folder(finished, capsys):
    assert main(["vdb", str(finished)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 and lines[0].startswith(str(finished / "vdb" / "event_001.vdb: "))
    assert "kg/m3" in lines[1]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "nowhere: no results; it holds no scene.json"),
        (["{finished}", "--snapshots"], "snapshots: no particles; none are stored there"),
        (["{finished}", "--width", "-1"], "width: -1.0 m; must be positive"),
    ],
)
def test_impossible_exports_are_refused(finished, arguments, message, capsys):
    assert main(["vdb", *(a.format(finished=finished) for a in arguments), "-q"]) == 2
    assert message in capsys.readouterr().err


def test_arrays_must_be_finite_and_of_equal_length(tmp_path):
    with pytest.raises(InputError, match="masses: 2 values for 1 particles"):
        write_vdb(
            tmp_path / "a.vdb", np.zeros((1, 3)), np.ones(2), dimension=2, dx=0.1,
            particles_per_voxel=6,
        )  # fmt: skip
    with pytest.raises(InputError, match=r"a\.vdb: a particle position is not finite"):
        write_vdb(
            tmp_path / "a.vdb", np.full((1, 3), np.nan), np.ones(1), dimension=3, dx=0.1,
            particles_per_voxel=6,
        )  # fmt: skip
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["empty", "garbage", "truncated"])
def test_damaged_files_end_a_run_at_once(exported, tmp_path, capsys, kind):
    complete = exported[0].file.read_bytes()
    content = {
        "empty": b"",
        "garbage": bytes(range(256)) * 40,
        "truncated": complete[: len(complete) // 5],
    }
    (tmp_path / "bad.vdb").write_bytes(content[kind])
    bad = str(tmp_path / "bad.vdb")
    scene = tiny_scene()
    scene.append("obstacles", {"shape": {"type": "vdb", "file": bad, "grid": "surface"}})
    (tmp_path / "scene.json").write_text(scene.resolve().json)
    start = time.perf_counter()
    assert main(["run", str(tmp_path / "scene.json"), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert time.perf_counter() - start < 5  # on a busy machine; a tenth of a second when idle
    error = capsys.readouterr().err
    assert "bad.vdb: grid 'surface': " in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()
