"""Grains of known geometry are found, with their volumes, surfaces and contacts."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.analysis.tomography.adjacency import Adjacency, find_adjacency
from snowshed.analysis.tomography.crofton import DIRECTIONS, surface_area, weight
from snowshed.analysis.tomography.curvature import principal_curvatures, surface_voxels
from snowshed.analysis.tomography.gaussian_field import gaussian_snow
from snowshed.analysis.tomography.grain_tables import contact_table, grain_table
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.region_merging import merge_contiguous, merge_shallow
from snowshed.analysis.tomography.segmentation import (
    SegmentationSettings,
    known_grains,
    segment,
)
from snowshed.analysis.tomography.sphere_packing import sphere_snow

for library in ("skimage", "edt"):
    pytest.importorskip(library)

VOXEL = 5e-5
RADIUS, NECK = 16.0, 7.0  # voxels
METHODS = ("watershed", "curvature")


def balls(*centres, radius=RADIUS, shape=(52, 52, 76)):
    """Return ice of balls about centres (z, y, x) in voxels."""
    at = np.indices(shape) + 0.5
    inside = [
        sum((axis - coordinate) ** 2 for axis, coordinate in zip(at, centre)) < radius**2
        for centre in centres
    ]
    return IceImage(np.any(inside, axis=0), VOXEL, "balls")


def dumbbell(direction=(0.2, 0.3, 1.0)):
    """Return two balls along a direction; they meet in a disc of radius NECK."""
    axis = np.array(direction) / np.linalg.norm(direction)
    half = np.sqrt(RADIUS**2 - NECK**2)
    middle = np.array([26.1, 25.8, 38.2])
    return balls(middle - half * axis, middle + half * axis)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("direction", [(0.2, 0.3, 1.0), (0.5, -0.4, 0.9)])
def test_a_dumbbell_is_two_grains(method, direction):
    image = dumbbell(direction)
    segmented = segment(image, SegmentationSettings(method=method))
    grains, contacts = grain_table(segmented), contact_table(segmented)
    assert segmented.count == 2
    half = np.sqrt(RADIUS**2 - NECK**2)
    cap = np.pi * (RADIUS - half) ** 2 * (3 * RADIUS - (RADIUS - half)) / 3
    volume = (4 / 3 * np.pi * RADIUS**3 - cap) * VOXEL**3
    surface = (4 * np.pi * RADIUS**2 - 2 * np.pi * RADIUS * (RADIUS - half)) * VOXEL**2
    assert grains.volume_m3.to_numpy() == pytest.approx(volume, rel=0.01)
    assert grains.surface_m2.to_numpy() == pytest.approx(surface, rel=0.02)
    # A voxel away from the bottom of the sharp crease, the cross-section is larger.
    assert np.sqrt(contacts.area_m2[0] / np.pi) / VOXEL == pytest.approx(NECK + 0.4, abs=0.4)
    assert grains.coordination.tolist() == [1, 1]
    assert not grains.at_side.any()
    centre = grains[["x_m", "y_m", "z_m"]].mean() / VOXEL
    assert centre.to_numpy() == pytest.approx([38.2, 25.8, 26.1], abs=0.1)


@pytest.mark.parametrize("method", METHODS)
def test_a_single_grain_is_refused(method):
    rod = np.zeros((30, 30, 50), dtype=bool)
    z, y = np.indices((30, 30)) - 14.5
    rod[z**2 + y**2 < 100] = True
    for image in (balls((26, 26, 38)), IceImage(rod, VOXEL, "a rod")):
        with pytest.raises(InputError, match="all ice is one grain"):
            segment(image, SegmentationSettings(method=method))


def test_grains_of_a_sphere_pack_are_recovered():
    snow = sphere_snow((64, 64, 64), VOXEL, diameter=6e-4, ice_fraction=0.25, seed=1)
    segmented, expected = segment(snow), known_grains(snow)
    assert segmented.count == pytest.approx(expected.count, rel=0.05)
    assert segmented.touching.coordination[1:].mean() == pytest.approx(
        expected.touching.coordination[1:].mean(), rel=0.05
    )
    overlap = np.zeros((segmented.count + 1, expected.count + 1), dtype=int)
    np.add.at(overlap, (segmented.labels[snow.ice], snow.labels[snow.ice]), 1)
    assert overlap.max(axis=0)[1:].sum() > 0.97 * snow.ice.sum()


def test_grains_of_a_gaussian_field_agree_with_measurements_of_others():
    """Others measured 87 grains of coordination 3.8 in a cube of 2.4 mm; both methods agree."""
    counts = {method: [] for method in METHODS}
    coordination = []
    for seed in range(4):
        snow = gaussian_snow(
            (48, 48, 48), VOXEL, ice_fraction=0.327, correlation_length=5e-4, seed=seed
        )
        for method in METHODS:
            segmented = segment(snow, SegmentationSettings(method=method))
            counts[method].append(segmented.count)
            coordination.append(segmented.touching.coordination[1:].mean())
    assert np.mean(counts["watershed"]) == pytest.approx(87, rel=0.15)
    assert np.mean(counts["curvature"]) == pytest.approx(np.mean(counts["watershed"]), rel=0.15)
    assert np.mean(coordination) == pytest.approx(3.8, abs=0.2)


def test_labels_fill_the_ice_and_do_not_depend_on_threads():
    snow = gaussian_snow((48, 48, 48), VOXEL, density=300, specific_surface=15, seed=3)
    serial = segment(snow, SegmentationSettings(threads=1))
    parallel = segment(snow, SegmentationSettings(threads=2))
    assert ((serial.labels > 0) == snow.ice).all()
    assert (serial.labels == parallel.labels).all()
    assert grain_table(serial).volume_m3.min() >= 27 * VOXEL**3


def test_curvatures_of_a_ball_a_rod_and_a_torus():
    z, y, x = np.indices((56, 56, 56)).astype(np.float32) - 27.5
    ball = 12 - np.sqrt(z**2 + y**2 + x**2)
    rod = 9 - np.sqrt(y**2 + x**2)
    torus = 6 - np.sqrt((np.sqrt(y**2 + x**2) - 16) ** 2 + z**2)
    for field, smaller, larger in (
        (ball, 1 / 12, 1 / 12),
        (rod, 0.0, 1 / 9),
        (torus, None, 1 / 6),
    ):
        at = surface_voxels(field > 0)
        inside = np.all([(axis > 2) & (axis < 53) for axis in at], axis=0)
        at = tuple(axis[inside] for axis in at)
        curvatures = principal_curvatures(field, at)
        assert np.median(curvatures[1]) == pytest.approx(larger, rel=0.1)
        if smaller is not None:
            assert np.median(curvatures[0]) == pytest.approx(smaller, rel=0.1, abs=0.005)
    hole = np.hypot(y[at], x[at]) < 11.5  # the inner side of the torus is a saddle
    assert np.median(curvatures[0][hole]) == pytest.approx(-1 / 10, rel=0.15)


@pytest.mark.parametrize("radius", [5, 9, 15])
def test_the_surface_of_balls(radius):
    at = np.indices((40, 40, 40)) - 19.63
    assert surface_area((at**2).sum(axis=0) < radius**2) == pytest.approx(
        4 * np.pi * radius**2, rel=0.015
    )


def test_a_step_is_weighted_by_its_share_of_directions():
    random = np.random.default_rng(5).normal(size=(200_000, 3))
    random /= np.linalg.norm(random, axis=1)[:, None]
    steps = np.array(DIRECTIONS, dtype=float)
    lengths = np.linalg.norm(steps, axis=1)
    nearest = np.abs(random @ (steps / lengths[:, None]).T).argmax(axis=1)
    share = np.bincount(nearest, minlength=13) / len(random)
    weights = np.array([weight(step) for step in DIRECTIONS])
    assert weights * lengths / 2 == pytest.approx(share, abs=0.002)


def test_contacts_match_a_count_by_hand():
    labels = np.zeros((6, 4, 4), dtype=np.int32)
    labels[:2], labels[2:4], labels[4:, :2] = 1, 2, 3
    distance = np.arange(6, dtype=np.float32)[:, None, None] * np.ones((1, 4, 4), dtype=np.float32)
    adjacency = find_adjacency(labels, distance)
    assert adjacency.pairs.tolist() == [[1, 2], [2, 3]]
    assert adjacency.faces.tolist() == [16, 8]
    assert adjacency.saddles.tolist() == [1.0, 3.0]
    assert adjacency.coordination.tolist() == [0, 1, 2, 1]
    joined = adjacency.merged(np.array([0, 1, 1, 2]))
    assert joined.pairs.tolist() == [[1, 2]]
    assert adjacency.areas.tolist() == [16.0, 8.0]
    assert joined.areas.tolist() == [8.0]
    assert joined.air == pytest.approx([0, adjacency.air[1] + adjacency.air[2], adjacency.air[3]])


def test_the_area_of_a_slanted_contact_is_exact():
    z, y, x = np.indices((30, 30, 30)) + 0.5
    inside = (z > 3) & (z < 27) & (y > 3) & (y < 27)
    labels = np.where(inside, np.where(x > 15 + 0.4 * (y - 15) + 0.2 * (z - 15), 2, 1), 0)
    adjacency = find_adjacency(labels.astype(np.int32))
    assert adjacency.areas == pytest.approx([24**2 * np.sqrt(1 + 0.4**2 + 0.2**2)], rel=0.01)
    relabelled = adjacency.merged(np.array([0, 2, 1]))
    assert relabelled.areas == pytest.approx(adjacency.areas)


def test_the_sides_of_a_peg_add_nothing_to_the_area_of_its_contact():
    labels = np.ones((10, 8, 8), dtype=np.int32)
    labels[5:] = 2
    labels[5:8, 3:5, 3:5] = 1
    adjacency = find_adjacency(labels)
    assert adjacency.areas.tolist() == [64.0]
    assert adjacency.faces.tolist() == [64 + 4 * 2 * 3]


def chain(areas, air, saddles=None):
    """Return the adjacency of a row of labels, each of which touches the next."""
    count = len(areas)
    pairs = np.array([[n, n + 1] for n in range(1, count + 1)])
    normals = np.outer(areas, [0.6, 0.0, 0.8])
    saddles = np.zeros(count) if saddles is None else np.array(saddles)
    return Adjacency(np.array([0.0, *air]), pairs, normals, np.ones(count, dtype=int), saddles)


def test_the_most_contiguous_labels_are_merged_first():
    # Contiguities are 0.5 and 1/6. Merged, labels 1 and 2 share 2 of their surface of 12 with 3.
    touching = chain([5.0, 2.0], [5.0, 5.0, 10.0])
    voxels = np.array([0, 50, 50, 50])
    assert merge_contiguous(touching, voxels, 0.2).tolist() == [0, 1, 1, 2]
    assert merge_contiguous(touching, voxels, 0.16).tolist() == [0, 1, 1, 1]
    assert merge_contiguous(touching, voxels, 0.9).tolist() == [0, 1, 2, 3]


def test_small_labels_join_their_largest_contact():
    touching = chain([1.0, 2.0], [50.0, 50.0, 50.0])
    assert merge_contiguous(touching, np.array([0, 50, 5, 50]), 0.9, 27).tolist() == [0, 1, 2, 2]
    pair = merge_contiguous(chain([1.0], [9.0, 9.0]), np.array([0, 5, 5]), 0.9, 27)
    assert pair.tolist() == [0, 1, 1]


def test_shallow_maxima_are_merged():
    touching = chain([1.0, 1.0], [9.0, 9.0, 9.0], saddles=[4.5, 2.0])
    peaks = np.array([0.0, 5.0, 6.0, 5.0])
    assert merge_shallow(touching, peaks, 0.4).tolist() == [0, 1, 2, 3]
    assert merge_shallow(touching, peaks, 0.6).tolist() == [0, 1, 1, 2]
    assert merge_shallow(touching, peaks, 3.1).tolist() == [0, 1, 1, 1]


@pytest.mark.parametrize("value", [True, False])
def test_an_image_of_a_single_phase_is_refused(value):
    image = IceImage(np.full((10, 10, 10), value), VOXEL, "an image")
    with pytest.raises(InputError, match="all is ice" if value else "no ice"):
        segment(image)


@pytest.mark.parametrize(
    "options",
    [{"method": "spam"}, {"depth": -1}, {"contiguity": 0}, {"contiguity": 2}, {"smoothing": 0},
     {"smallest": -1}, {"threads": 0}, {"neck_curvature": float("nan")}],
)  # fmt: skip
def test_settings_out_of_range_are_refused(options):
    with pytest.raises(InputError):
        SegmentationSettings(**options)
