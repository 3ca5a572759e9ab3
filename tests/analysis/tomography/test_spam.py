"""Grains of a pack against those of the toolkit spam (Grenoble), if it is installed."""

import numpy as np
import pytest

from snowshed.analysis.tomography.segmentation import segment
from snowshed.analysis.tomography.sphere_packing import sphere_snow

spam_label = pytest.importorskip("spam.label")
for library in ("skimage", "edt"):
    pytest.importorskip(library)


def test_the_watershed_of_spam_finds_as_many_grains():
    snow = sphere_snow((64, 64, 64), 5e-5, diameter=6e-4, ice_fraction=0.25, seed=1)
    theirs = spam_label.watershed(snow.ice)
    segmented = segment(snow)
    assert segmented.count == pytest.approx(int(np.max(theirs)), rel=0.1)
    overlap = np.zeros((segmented.count + 1, int(np.max(theirs)) + 1), dtype=int)
    np.add.at(overlap, (segmented.labels[snow.ice], theirs[snow.ice]), 1)
    assert overlap.max(axis=0)[1:].sum() > 0.95 * snow.ice.sum()
