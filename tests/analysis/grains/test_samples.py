"""Samples of studies: coarser, smaller, turned, written once."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.analysis.grains.material.run import by_density
from snowshed.analysis.grains.samples import LabelledSample


@pytest.fixture
def snow():
    """Balls of ice at random positions, each a grain."""
    random = np.random.default_rng(3)
    at = np.indices((24, 24, 24)).reshape(3, -1).T
    labels = np.zeros(24**3, dtype=np.int32)
    for grain, centre in enumerate(random.uniform(0, 24, (40, 3)), start=1):
        labels[((at - centre) ** 2).sum(axis=1) < 9] = grain
    return LabelledSample("balls", labels.reshape(24, 24, 24), 5e-5)


def test_coarser_voxels_keep_the_ice_fraction_and_take_the_majority_grain(snow):
    coarse = snow.coarser(2)
    assert coarse.ice_fraction == pytest.approx(snow.ice_fraction, abs=0.5 / 12**3)
    assert coarse.voxel_size == 1e-4
    for z, y, x in np.argwhere(coarse.labels):
        block = snow.labels[2 * z : 2 * z + 2, 2 * y : 2 * y + 2, 2 * x : 2 * x + 2]
        grains, counts = np.unique(block[block > 0], return_counts=True)
        assert coarse.labels[z, y, x] == grains[counts.argmax()]


def test_samples_are_cropped_and_turned(snow):
    assert np.array_equal(snow.middle(0.5).labels, snow.labels[6:18, 6:18, 6:18])
    turned = snow.turned(2)
    assert turned.labels[5, 7, 9] == snow.labels[7, 9, 5]
    assert turned.name != snow.name


def test_small_samples_and_other_files_are_refused(snow, tmp_path):
    with pytest.raises(InputError, match=r"balls: .* 6 times coarser; at least 6"):
        snow.coarser(6)
    with pytest.raises(InputError, match="fewer than 6 along an edge"):
        snow.middle(0.2)
    np.save(tmp_path / "floats.npy", np.zeros((8, 8, 8)))
    (tmp_path / "text.npy").write_text("no array")
    for name, message in (("floats", "not a label image"), ("text", "damaged: no NPY file")):
        with pytest.raises(InputError, match=f"{name}.npy: {message}"):
            LabelledSample.read(tmp_path / f"{name}.npy", 1e-4)


def test_a_sample_is_written_once_and_never_over_another(snow, tmp_path):
    file = snow.write(tmp_path)
    written_at = file.stat().st_mtime_ns
    assert snow.write(tmp_path).stat().st_mtime_ns == written_at
    assert np.array_equal(LabelledSample.read(file, 5e-5).labels, snow.labels)
    flipped = LabelledSample("balls", snow.labels[::-1], 5e-5)
    with pytest.raises(InputError, match="holds another sample"):
        flipped.write(tmp_path)


def test_samples_are_grouped_by_density():
    def sample(ice):
        labels = np.zeros((10, 10, 10), dtype=int)
        labels.ravel()[:ice] = 1
        return LabelledSample(str(ice), labels, 1e-4)

    groups = by_density([sample(ice) for ice in (300, 200, 309, 215)])
    assert [[member.name for member in group] for group in groups] == [
        ["200", "215"],
        ["300", "309"],
    ]
