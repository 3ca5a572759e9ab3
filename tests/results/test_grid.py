"""The grid at a moment, from the particles."""

import re

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import Body, InputError, Results, Scene, Shape, Simulation
from snowshed.cli.main import main
from snowshed.results.grid import particles_to_grid

pytest.importorskip("xarray")
BASES = ("quadratic", "cubic")


def flying(dimension, **numerics):
    """A ball of elastic snow in free flight."""
    ball = Shape.sphere((0.013, 0.5) if dimension == 2 else (0.013, 0.0, 0.5), 0.05)
    scene = Scene(dimension=dimension, bodies=[Body(shape=ball)])
    settings = {"dx": 0.02, "precision": "double", "sleep_speed": 0.0, "threads": 1, **numerics}
    return scene.update({"snow.model": "elastic", "numerics": settings, "output.film": False})


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_solver_uses_the_same_grid_in_its_next_step(dimension, basis):
    """With pure PIC and no stress, a particle gets the grid's velocity and a step of gravity."""
    simulation = Simulation(flying(dimension, basis=basis, flip_ratio=0.0))
    simulation.begin_event()
    rng = np.random.default_rng(1)
    changes = rng.normal(0, 1e-4, (simulation.particle_count, 3))  # too slow to strain the snow
    changes[:, 1] *= dimension == 3
    simulation.add_velocity(changes)
    grid, positions = simulation.grid(), simulation.positions()
    before = simulation.velocities()
    simulation.step()
    axes = ["x", "z"] if dimension == 2 else ["x", "y", "z"]
    # Velocities that the grid returns to particles, with the weights of the transfer to the grid.
    shift = np.zeros_like(positions)
    shift[:, 2] = -9.81 * simulation.time_step
    expected = np.zeros_like(positions)
    for number, position in enumerate(positions):
        weights = particles_to_grid(
            position[None], np.zeros((1, 3)), np.ones(1), dx=0.02, dimension=dimension, basis=basis
        )
        nodes = {axis: weights.origin[k] + 0.02 * np.arange(weights.mass.shape[k])
                 for k, axis in enumerate(axes)}  # fmt: skip
        node_velocities = grid.velocity.sel(nodes, method="nearest", tolerance=1e-6).values
        for axis in axes:
            component = "xyz".index(axis)
            expected[number, component] = (weights.mass * node_velocities[..., component]).sum()
    assert np.abs(before - expected).max() > 1e-5
    assert simulation.velocities() == pytest.approx(expected + shift, abs=2e-9)


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("basis", BASES)
def test_mass_and_momentum_are_conserved(transfer, basis):
    scene = tiny_scene(**{"numerics.transfer": transfer, "numerics.basis": basis})
    simulation = Simulation(scene)
    simulation.begin_event()
    simulation.run(until=0.25)
    grid = simulation.grid()
    assert float(grid.mass.sum()) == pytest.approx(simulation.masses().sum(), rel=1e-12)
    momentum = (grid.mass * grid.velocity).sum(("x", "z")).values
    expected = (simulation.masses()[:, None] * simulation.velocities()).sum(axis=0)
    assert momentum == pytest.approx(expected, rel=1e-9)
    assert float(grid.density.max()) < 2 * 210
    assert grid.velocity.attrs["units"] == "m/s" and grid.x.attrs["units"] == "m"


@pytest.mark.parametrize("basis", BASES)
def test_apic_reproduces_a_rotation_exactly(basis):
    rng = np.random.default_rng(2)
    positions = rng.uniform(0, 0.1, (500, 3))
    spin = np.array([[0, -2.0, 1.0], [2.0, 0, -3.0], [-1.0, 3.0, 0]])
    grid = particles_to_grid(
        positions, positions @ spin.T, np.ones(500), dx=0.02, dimension=3, basis=basis,
        affine=np.broadcast_to(spin, (500, 3, 3)),
    )  # fmt: skip
    axes = (grid.origin[k] + 0.02 * np.arange(n) for k, n in enumerate(grid.mass.shape))
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    occupied = grid.mass > 0
    assert grid.velocity[occupied] == pytest.approx((nodes @ spin.T)[occupied], abs=1e-9)


def test_the_grid_after_an_event_and_its_file(finished, tmp_path, capsys):
    results = Results(finished)
    grid = results.grid()
    assert int(grid.event_number) == 2
    assert float(grid.mass.sum()) == pytest.approx(float(results.particles().mass.sum()), rel=1e-6)
    assert main(["grid", str(finished), "-o", str(tmp_path / "grid")]) == 0
    assert "event_002.vti" in capsys.readouterr().out
    content = (tmp_path / "grid" / "event_002.vti").read_bytes()
    head, _, data = content.partition(b'encoding="raw">\n_')
    text = head.decode()
    assert re.search(r'WholeExtent="0 \d+ 0 0 0 \d+"', text)
    counts = [len(grid.x), len(grid.z)]
    mass = np.frombuffer(data, "<f4", counts[0] * counts[1], 8).reshape(counts[1], counts[0])
    assert pytest.approx(grid.mass.values, rel=1e-6) == mass.T
    first = [float(x) for x in re.search(r'Origin="([^"]+)"', text)[1].split()]
    assert first == pytest.approx([float(grid.x[0]), 0.0, float(grid.z[0])])
    vtk = pytest.importorskip("vtk", reason="reads the file as ParaView does")
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(tmp_path / "grid" / "event_002.vti"))
    reader.Update()
    assert reader.GetOutput().GetPointData().GetArray("velocity").GetNumberOfComponents() == 3


def test_missing_and_too_large_grids_are_refused(tmp_path, finished, capsys):
    with pytest.raises(InputError, match="no particles"):
        particles_to_grid(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), dx=0.1, dimension=2)
    far = np.array([[0.0, 0, 0], [1e6, 0, 1e6]])
    with pytest.raises(InputError, match="do not fit into memory"):
        particles_to_grid(far, far, np.ones(2), dx=0.1, dimension=2)
    assert main(["grid", str(finished), "--snapshots"]) == 2
    assert "no particles" in capsys.readouterr().err
