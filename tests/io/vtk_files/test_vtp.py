"""Stored particles, read back."""

import re

import numpy as np
import pytest

from snowshed import InputError, Scene, _core
from snowshed.io.vtk.vtp import read_particles


@pytest.fixture
def stored(tmp_path):
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    simulation = _core.Simulation(scene.resolve().json)
    simulation.begin_event()
    simulation.step(5)
    path = tmp_path / "snow.vtp"
    simulation.write_vtk(str(path))
    return simulation, path


def test_stored_particles_are_read_back(stored):
    simulation, path = stored
    particles = read_particles(path)
    assert set(particles) == {
        "position", "velocity", "mass", "event", "density", "pressure",
        "volumetric_plastic_strain", "deviatoric_stress", "preconsolidation_pressure", "id",
    }  # fmt: skip
    for name, expected in {
        "position": simulation.positions(),
        "velocity": simulation.velocities(),
        "mass": simulation.masses(),
        "event": simulation.events(),
        "density": simulation.densities(),
        "pressure": simulation.pressures(),
        "deviatoric_stress": simulation.field_by_id("deviatoric_stress"),
        "preconsolidation_pressure": simulation.field_by_id("preconsolidation_pressure"),
    }.items():
        assert np.allclose(particles[name], expected, rtol=1e-6, atol=1e-7), name


@pytest.mark.parametrize("part", [0.0, 0.2, 0.5, 0.9])
def test_damaged_files_are_named(stored, part):
    _, path = stored
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(InputError, match=r"snow\.vtp: not particles that snowshed wrote"):
        read_particles(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (rb"Float32", b"Complex"),
        (rb'NumberOfPoints="\d+"', b'NumberOfPoints="-1"'),
        (rb'NumberOfPoints="\d+"', b'NumberOfPoints="' + b"9" * 30 + b'"'),
        (rb'NumberOfComponents="3"', b'NumberOfComponents="-3"'),
        (rb'offset="\d+"', b'offset="' + b"9" * 30 + b'"'),
        (rb'<\?xml version="1.0"', b'<?xml version="1.0" encoding="snow"'),
    ],
)
def test_invalid_numbers_and_types_are_refused(stored, old, new):
    _, path = stored
    content = re.sub(old, new, path.read_bytes(), count=1)
    assert content != path.read_bytes()
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"snow\.vtp: not particles"):
        read_particles(path)
