"""Synthetic snow has the requested measures, and those of theory."""

import numpy as np
import pytest
from scipy.special import ndtri

from snowshed import InputError
from snowshed.analysis.tomography.gaussian_field import SHELL_WIDTH, gaussian_snow
from snowshed.analysis.tomography.microstructure import (
    correlation_length,
    measure_microstructure,
    two_point_correlation,
)
from snowshed.analysis.tomography.parts import largest_part
from snowshed.analysis.tomography.sphere_packing import sphere_snow

VOXEL = 5e-5


def test_the_ice_fraction_is_exact_to_a_voxel():
    snow = gaussian_snow(
        (40, 50, 60), VOXEL, ice_fraction=0.4, correlation_length=4e-4, connected=False
    )
    assert np.count_nonzero(snow.ice) == round(0.4 * snow.ice.size)


@pytest.mark.parametrize(("density", "surface"), [(250, 12), (300, 15), (450, 18)])
def test_density_and_specific_surface_are_as_requested(density, surface):
    snow = gaussian_snow((64, 64, 64), VOXEL, density=density, specific_surface=surface, seed=4)
    assert snow.density == pytest.approx(density, rel=2e-4)
    assert measure_microstructure(snow).specific_surface_m2_kg == pytest.approx(surface, rel=0.03)
    assert (largest_part(snow.ice) == snow.ice).all()
    assert snow.synthetic
    assert snow.source.startswith("synthetic: ")


def test_the_surface_agrees_with_the_theory_of_gaussian_fields():
    """Adler and Taylor (2007), chapter 12, and a value measured for such snow."""
    length, fraction = 5e-4, 0.327
    surfaces = [
        measure_microstructure(
            gaussian_snow(
                (96, 96, 96), VOXEL, ice_fraction=fraction, correlation_length=length, seed=seed,
                connected=False,
            )
        ).specific_surface_m2_kg
        for seed in range(3)
    ]  # fmt: skip
    # The shell's wave numbers in units of 2 pi / length; their density grows with the square.
    number = np.linspace(0.1, 2.0, 2001)
    weight = number**2 * np.exp(-0.5 * ((number - 1) / SHELL_WIDTH) ** 2)
    mean_square = np.average(number**2, weights=weight) * (2 * np.pi / length) ** 2 / 3
    per_volume = 2 / np.pi * np.sqrt(mean_square) * np.exp(-0.5 * ndtri(fraction) ** 2)
    assert np.mean(surfaces) == pytest.approx(per_volume / (917 * fraction), rel=0.02)
    assert np.mean(surfaces) == pytest.approx(14.7, rel=0.04)


def test_the_two_point_correlation_agrees_with_theory():
    """For a field cut at zero it is 1/4 + asin(rho) / 2 pi; rho of a thin shell is sin(kr) / kr."""
    snow = gaussian_snow(
        (96, 96, 96), VOXEL, ice_fraction=0.5, correlation_length=8e-4, connected=False, seed=2
    )
    number = np.linspace(0.1, 2.0, 2001)
    weight = number**2 * np.exp(-0.5 * ((number - 1) / SHELL_WIDTH) ** 2)
    for distance in (1, 3, 5, 8):
        phase = 2 * np.pi * number * distance / 16
        rho = np.average(np.sin(phase) / phase, weights=weight)
        expected = 0.25 + np.arcsin(rho) / (2 * np.pi)
        correlation = np.mean(
            [two_point_correlation(snow.ice, axis, distance) for axis in range(3)]
        )
        assert correlation == pytest.approx(expected, abs=0.01)


def test_anisotropy_stretches_the_ice_along_z():
    snow = gaussian_snow(
        (96, 96, 96), VOXEL, ice_fraction=0.4, correlation_length=5e-4, anisotropy=1.5, seed=1
    )
    z, y, x = (correlation_length(snow.ice, axis) for axis in range(3))
    assert z / np.sqrt(x * y) == pytest.approx(1.5, rel=0.08)
    assert x == pytest.approx(y, rel=0.08)


def test_the_seed_determines_the_snow():
    def snow(seed):
        return gaussian_snow((32, 32, 32), VOXEL, density=350, correlation_length=5e-4, seed=seed)

    assert (snow(1).ice == snow(1).ice).all()
    assert (snow(1).ice != snow(2).ice).any()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"density": 60, "specific_surface": 15}, "there is too little ice for a connected part"),
        ({"density": 300, "specific_surface": 500}, "from 4 voxels"),
        ({"density": 300, "specific_surface": 1}, "from 4 voxels"),
        ({"density": 1000, "specific_surface": 15}, "it must be below 1"),
        ({"density": 300}, "give one of the two"),
        ({"density": 300, "ice_fraction": 0.3, "correlation_length": 5e-4}, "give one of the two"),
        ({"density": float("nan"), "correlation_length": 5e-4}, "finite"),
        ({"density": 300, "correlation_length": 5e-4, "anisotropy": 0}, "above 0"),
    ],
)
def test_impossible_fields_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        gaussian_snow((40, 40, 40), VOXEL, **options)


@pytest.mark.parametrize("shape", [(40, 40), (4, 40, 40), (40.5, 40, 40), (1 << 14,) * 3])
def test_impossible_shapes_are_refused(shape):
    with pytest.raises(InputError, match="shape"):
        gaussian_snow(shape, VOXEL, density=300, specific_surface=15)


def test_spheres_meet_in_necks_of_the_requested_radius():
    diameter, neck = 1.6e-3, 0.5
    snow = sphere_snow(
        (110, 110, 110), VOXEL, diameter=diameter, ice_fraction=0.02, neck_ratio=neck, seed=1
    )  # two spheres
    inner = [n for n in range(1, snow.labels.max() + 1) if not _cut(snow.labels, n)]
    volumes = [np.count_nonzero(snow.labels == n) * VOXEL**3 for n in inner]
    radius = diameter / 2
    height = radius * (1 - np.sqrt(1 - neck**2))
    cap = np.pi * height**2 * (3 * radius - height) / 3
    sphere = 4 / 3 * np.pi * radius**3
    assert (sphere - np.array(volumes)) / cap == pytest.approx([1.0, 1.0], abs=0.1)


def _cut(labels, number):
    at = np.argwhere(labels == number)
    return (at.min(axis=0) == 0).any() or (at.max(axis=0) == np.array(labels.shape) - 1).any()


def test_spheres_have_the_requested_density_and_are_connected():
    snow = sphere_snow((48, 48, 48), VOXEL, diameter=5e-4, density=300, spread=0.3, seed=2)
    assert snow.density == pytest.approx(300, rel=0.02)
    assert (largest_part(snow.ice) == snow.ice).all()
    assert (np.unique(snow.labels) == np.arange(snow.labels.max() + 1)).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"density": 880}, "no other fits"),
        ({"density": 300, "neck_ratio": 0.95}, "0.1 to 0.9"),
        ({"density": 300, "spread": -0.1}, "0 to 0.5"),
        ({"density": 300, "diameter": 0.5}, "length of the sample"),
        ({"density": 300, "diameter": 5e-5}, "4 voxels"),
    ],
)
def test_impossible_packs_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        sphere_snow((20, 20, 20), VOXEL, **{"diameter": 5e-4, **options})
