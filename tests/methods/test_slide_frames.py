"""A slide over time."""

import numpy as np

from snowshed.methods.slide_frames import FrameSeries


def drifting(count: int) -> FrameSeries:
    series = FrameSeries()
    for step in range(count):
        if series.due(0.25 * step):
            snow = np.zeros((20, 200))
            snow[5:8, step // 4 : step // 4 + 3] = 1.0 + step
            series.add(0.25 * step, snow)
    return series


def test_frames_give_back_what_they_saw():
    frame = drifting(9).frames[-1]
    seen = frame.window(slice(4, 9), slice(0, 6))
    expected = np.zeros((5, 6))
    expected[1:4, 2:5] = 9.0
    assert (seen == expected).all()
    assert (frame.window(slice(6, 7), slice(3, 4)) == 9.0).all()
    assert not frame.window(slice(10, 15), slice(0, 6)).any()


def test_an_interrupted_series_goes_on(tmp_path):
    series = drifting(300)
    series.save(tmp_path / "frames.npz")
    loaded = FrameSeries.load(tmp_path / "frames.npz", until=40.0)
    assert loaded.interval == series.interval == 2.0
    assert [one.time for one in loaded.frames] == [n * 2.0 for n in range(20)]
    assert (loaded.frames[3].thickness == series.frames[3].thickness).all()
    assert FrameSeries.load(tmp_path / "none.npz", 1.0).frames == []
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 torn")
    assert FrameSeries.load(tmp_path / "bad.npz", 1.0).frames == []
