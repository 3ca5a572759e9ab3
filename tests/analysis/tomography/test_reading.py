"""From an image to ice: thresholds, crops, coarser voxels; and measures of the ice."""

from dataclasses import replace

import numpy as np
import pytest

from snowshed import InputError
from snowshed.analysis.tomography.downscaling import downscaled
from snowshed.analysis.tomography.gaussian_field import gaussian_snow
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.microstructure import mean_chords, measure_microstructure
from snowshed.analysis.tomography.parts import largest_part
from snowshed.analysis.tomography.threshold import ImageSettings, read_ice
from snowshed.base.notes import record_notes
from snowshed.io.voxels.open_voxels import open_voxels

VOXEL = 5e-5
SNOW = gaussian_snow((40, 40, 40), VOXEL, density=350, specific_surface=20, seed=6)


def opened(folder, voxels):
    np.save(folder / "image.npy", voxels)
    return open_voxels(folder / "image.npy")


def settings(**options):
    return ImageSettings(**{"voxel_size": VOXEL, **options})


def grey(kind="uint16", ice=40_000, air=20_000, noise=2_000):
    shades = np.where(SNOW.ice, ice, air) + np.random.default_rng(1).normal(
        0, noise, SNOW.ice.shape
    )
    return shades.astype(kind)


@pytest.mark.parametrize(
    "voxels",
    [grey(), grey("float32"), grey("int16", 9_000, -9_000, 1_000), grey("uint8", 180, 90, 8),
     grey("int32", 4_000_000, 10_000, 90_000)],
    ids=["uint16", "float32", "int16", "uint8", "int32"],
)  # fmt: skip
def test_otsu_separates_ice_from_air(tmp_path, voxels):
    pytest.importorskip("skimage")
    read = read_ice(opened(tmp_path, voxels), settings())
    assert read.chosen == "Otsu"
    assert (read.image.ice == SNOW.ice).all()


@pytest.mark.parametrize("voxels", [SNOW.ice, SNOW.ice * np.uint8(255), SNOW.ice * 1.0 - 5])
def test_the_larger_of_two_values_is_ice(tmp_path, voxels):
    read = read_ice(opened(tmp_path, voxels), settings())
    assert read.chosen == "two values"
    assert (read.image.ice == SNOW.ice).all()


def test_a_given_threshold_and_dark_ice(tmp_path):
    read = read_ice(opened(tmp_path, grey()), settings(threshold=30_000))
    assert (read.image.ice == SNOW.ice).all()
    dark = 60_000 - grey()
    read = read_ice(opened(tmp_path, dark), settings(threshold=30_000, dark_ice=True))
    assert (read.image.ice == SNOW.ice).all()


def test_crops_are_ranges_of_voxels(tmp_path):
    file = opened(tmp_path, SNOW.ice)
    crop = ((3, 30), (5, 25), (0, 33))
    read = read_ice(file, settings(crop=crop, connected=False))
    assert (read.image.ice == SNOW.ice[3:30, 5:25, 0:33]).all()
    for wrong in (((3, 3), (0, 9), (0, 9)), ((0, 41), (0, 9), (0, 9)), ((9, 3), (0, 9), (0, 9))):
        with pytest.raises(InputError, match="crop"):
            read_ice(file, settings(crop=wrong))


def test_unconnected_ice_is_left_out(tmp_path):
    ice = np.zeros((12, 12, 12), dtype=bool)
    ice[:6, :6, :6], ice[9:11, 9:11, 9:11] = True, True
    read = read_ice(opened(tmp_path, ice), settings())
    assert np.count_nonzero(read.image.ice) == 216
    assert read.lost == pytest.approx(8 / 224)
    unfiltered = read_ice(opened(tmp_path, ice), settings(connected=False))
    assert np.count_nonzero(unfiltered.image.ice) == 224


@pytest.mark.parametrize("factor", [2, 3, 4])
def test_coarser_voxels_keep_the_ice_fraction(factor):
    coarse = downscaled(SNOW, factor)
    covered = SNOW.ice[tuple(slice(0, n // factor * factor) for n in SNOW.ice.shape)]
    assert coarse.voxel_size == pytest.approx(factor * VOXEL)
    assert abs(coarse.ice.sum() - covered.sum() / factor**3) <= 0.5
    assert coarse.ice.shape == tuple(n // factor for n in SNOW.ice.shape)


def test_a_coarse_image_of_blocks_is_exact():
    blocks = np.random.default_rng(2).random((9, 10, 11)) < 0.4
    fine = np.kron(blocks, np.ones((3, 3, 3), dtype=bool))
    assert (downscaled(IceImage(fine, VOXEL, "blocks"), 3).ice == blocks).all()


@pytest.mark.parametrize("factor", [0, 1.5, 17])
def test_other_factors_are_refused(factor):
    with pytest.raises(InputError, match="whole number"):
        downscaled(SNOW, factor)


def labels_of_blocks(kind):
    """Return blocks of 5 voxels a voxel apart, numbered up to 200."""
    at = np.indices((36, 36, 36))
    z, y, x = at // 6
    return np.where((at % 6 < 5).all(axis=0), (36 * z + 6 * y + x) % 200 + 1, 0).astype(kind)


@pytest.mark.parametrize("kind", ["uint8", "int32", "int64"])
def test_labels_are_not_accepted_as_grey_values(tmp_path, kind):
    labels = labels_of_blocks(kind)
    with pytest.raises(InputError, match="labels of grains, not grey values"):
        read_ice(opened(tmp_path, labels), settings())
    read = read_ice(opened(tmp_path, labels), settings(threshold=0.5, connected=False))
    assert (read.image.ice == (labels > 0)).all()
    spread = np.where(labels, labels.astype(np.int64) * 1000, 0)  # beyond small whole numbers
    with pytest.raises(InputError, match="labels of grains, not grey values"):
        read_ice(opened(tmp_path, spread), settings())


@pytest.mark.parametrize("stated", [5e-5, 1e-4])
def test_a_voxel_size_that_contradicts_the_file_is_noted(tmp_path, stated):
    file = replace(opened(tmp_path, SNOW.ice), voxel_size=stated)
    with record_notes() as notes:
        read = read_ice(file, settings())
    assert read.image.voxel_size == VOXEL
    assert notes == ([] if stated == VOXEL else [
        f"{file.name}: voxels of 5e-05 m, as given; the file says 0.0001 m"
    ])  # fmt: skip
    printed = replace(file, voxel_size=None, printed_size=1e-4)
    with record_notes() as notes:
        read_ice(printed, settings())
    assert "its resolution says 0.0001 m" in notes[0]
    with pytest.raises(InputError, match=r"its tags of resolution would mean 0\.0001 m"):
        read_ice(printed, settings(voxel_size=None))


@pytest.mark.parametrize("kind", ["uint32", "uint64", "int64", "int8"])
def test_the_full_range_of_a_type(tmp_path, kind):
    low, high = np.iinfo(kind).min, np.iinfo(kind).max
    ice, air = np.array([high - 9, high - 99 if kind == "int8" else low + 9], dtype=kind)
    voxels = np.where(SNOW.ice, ice, air)
    voxels[0, 0, 0] += 3  # not two values
    read = read_ice(opened(tmp_path, voxels), settings())
    assert (read.image.ice == largest_part(SNOW.ice)).all()


@pytest.mark.parametrize("factor", [1e300, 1e-290, 1.0])
def test_otsu_does_not_depend_on_the_size_of_the_values(tmp_path, factor):
    voxels = grey("float64", 4.0, 2.0, 0.2) * factor
    read = read_ice(opened(tmp_path, voxels), settings())
    assert (read.image.ice == SNOW.ice).all()


def test_adjacent_single_precision_values_have_a_threshold(tmp_path):
    voxels = np.where(SNOW.ice, np.float32(1), np.nextafter(np.float32(1), np.float32(0)))
    voxels[0, 0, 0] = np.nextafter(np.float32(1), np.float32(2))
    read = read_ice(opened(tmp_path, voxels.astype(np.float32)), settings())
    assert (read.image.ice == largest_part(SNOW.ice)).all() or read.chosen == "Otsu"


@pytest.mark.parametrize(
    ("voxels", "options", "message"),
    [
        (np.where(SNOW.ice, 1e308, -1e308) * np.linspace(0.5, 1, 40), {}, "have no histogram"),
        (
            np.where(SNOW.ice, 3e-322, 0) + 1e-322 * (np.indices((40, 40, 40))[0] == 0),
            {},
            "have no histogram",
        ),
        (np.zeros((9, 9, 9)), {}, "empty: every voxel has the value 0"),
        (np.full((9, 9, 9), 255, dtype=np.uint8), {}, "empty: every voxel has the value 255"),
        (grey(), {"threshold": 65_535}, "no ice"),
        (grey(), {"threshold": -1}, "all is ice"),
        (np.full((9, 9, 9), np.nan), {}, "non-finite"),
        (SNOW.ice, {"voxel_size": None}, "voxel size is not known"),
        (SNOW.ice, {"voxel_size": -1e-5}, "above 0"),
        (SNOW.ice, {"threshold": float("nan")}, "finite"),
    ],
)
def test_images_without_snow_are_refused(tmp_path, voxels, options, message):
    with pytest.raises(InputError, match=message):
        read_ice(opened(tmp_path, voxels), settings(**options))


@pytest.mark.parametrize(
    ("size", "message"),
    [(0.05, "is it in mm"), (50.0, "is it in um"), (5e-8, "wrongly scaled"), (1e-2, "wrongly")],
)
def test_voxel_sizes_in_another_unit_are_refused(size, message):
    with pytest.raises(InputError, match=message):
        measure_microstructure(IceImage(SNOW.ice, size, "an image"))


def test_measures_of_layers():
    """Layers 4 voxels thick, with a period of 12; their surface has a known bias of -7 %."""
    ice = np.zeros((48, 20, 20), dtype=bool)
    ice[np.arange(48) % 12 // 4 == 1] = True
    numbers = measure_microstructure(IceImage(ice, VOXEL, "layers"))
    assert numbers.ice_fraction == pytest.approx(1 / 3)
    assert numbers.ice_chord_z_m == pytest.approx(4 * VOXEL, rel=0.2)
    assert numbers.pore_chord_z_m == pytest.approx(8 * VOXEL, rel=0.2)
    assert numbers.ice_chord_x_m == float("inf")
    exact = 2 / (4 * VOXEL * 917)
    assert numbers.specific_surface_m2_kg == pytest.approx(0.93 * exact, rel=0.1)


def test_chords_of_balls():
    """The mean chord of a ball, 4 V / S, is 4/3 of its radius."""
    at = np.indices((60, 60, 60)) - 29.4
    ball = (at**2).sum(axis=0) < 20**2
    assert mean_chords(ball, 1)[0] == pytest.approx(4 / 3 * 20, rel=0.03)
