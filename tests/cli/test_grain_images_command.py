"""``snowshed grains segment``: what it leaves out, and options and axes that cannot be right."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from snowshed.cli.main import main

VOXEL = ("--voxel", "1e-5")


@pytest.fixture(scope="module")
def image():
    """Return an image of 40, 48 and 56 voxels along z, y and x."""
    field = gaussian_filter(np.random.default_rng(1).normal(size=(40, 48, 56)), 3)
    return ((field > np.quantile(field, 0.6)) * 200).astype(np.uint8)


def segmented(folder, capsys, image, *options, file="snow.npy"):
    if file.endswith(".npy"):
        np.save(folder / file, image)
    else:
        image.tofile(folder / file)
    code = main(["grains", "segment", str(folder / file), *VOXEL, *options,
                 "-o", str(folder / "out")])  # fmt: skip
    return code, capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--raw-type", "uint8"), "--raw-type has no effect without a .raw file"),
        (("--raw-shape", "56", "48", "40"), "--raw-shape has no effect without a .raw file"),
        (("--neck-curvature", "0.1"), "--neck-curvature has no effect with --method watershed"),
        (("--method", "curvature", "--depth", "2"), "--depth has no effect with --method curv"),
    ],
)
def test_options_without_effect_are_refused(tmp_path, capsys, image, options, message):
    code, messages = segmented(tmp_path, capsys, image, *options)
    assert code == 2 and message in messages
    assert not (tmp_path / "out").exists()


def test_voxels_that_downscaling_leaves_out_are_noted(tmp_path, capsys, image):
    code, messages = segmented(tmp_path, capsys, image, "--downscale", "3")
    assert code == 0
    assert "2, 0, 1 voxels along x, y, z are left out at the far sides" in messages


def test_a_raw_file_whose_axes_are_in_another_order_is_noted(tmp_path, capsys, image):
    shape = ("--raw-type", "uint8", "--raw-shape")
    code, messages = segmented(tmp_path, capsys, image, *shape, "56", "48", "40", file="good.raw")
    assert code == 0 and "correlation lengths" not in messages
    (tmp_path / "out").rename(tmp_path / "good")
    code, messages = segmented(tmp_path, capsys, image, *shape, "40", "48", "56", file="bad.raw")
    assert code == 0 and "is the order of its axes, or its number type, another?" in messages
