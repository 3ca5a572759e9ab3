"""The solids of a scene as a file for ParaView."""

import re

import numpy as np
import pytest

from snowshed import Body, Obstacle, Panel, Scene, Shape
from snowshed.results.solids_file import write_solids


def read(file):
    """Return the points and the numbers of the triangles of a file."""
    head, _, data = file.read_bytes().partition(b'encoding="raw">\n_')
    text = head.decode()
    offsets = {
        name: int(offset) for name, offset in re.findall(r'Name="(\w+)"[^>]*?offset="(\d+)"', text)
    }
    points = int(re.search(r'NumberOfPoints="(\d+)"', text)[1])
    triangles = int(re.search(r'NumberOfPolys="(\d+)"', text)[1])

    def values(name, kind, count):
        return np.frombuffer(data, kind, count, offsets[name] + 8)

    numbers = {name: values(name, "<i4", triangles) for name in ("solid", "kind")}
    corners = values("connectivity", "<i8", 3 * triangles).reshape(-1, 3)
    return values("position", "<f4", 3 * points).reshape(-1, 3), corners, numbers


def test_solids_are_written_at_their_positions(tmp_path):
    fence = Obstacle(name="fence", shape=Shape.box((0.6, 0.0, 0.1), (0.04, 0.3, 0.2)))
    scene = Scene.preset("lab-50").append("obstacles", fence).resolve()
    snow = np.array([[0.0, -0.1, 0.0], [0.5, 0.1, 0.4]])
    points, corners, numbers = read(write_solids(scene, snow, tmp_path))
    assert dict(zip(*np.unique(numbers["kind"], return_counts=True))) == {0: 2, 1: 12, 2: 12}
    assert corners.min() == 0 and corners.max() == len(points) - 1
    corners_by_kind = {
        kind: points[np.unique(corners[numbers["kind"] == kind])] for kind in (0, 1, 2)
    }
    assert (
        np.ptp(corners_by_kind[0][:, 2]) == 0
        and corners_by_kind[0][:, 0].min() < -0.1 < 0.6 < corners_by_kind[0][:, 0].max()
    )
    assert corners_by_kind[2].min(axis=0) == pytest.approx([0.58, -0.15, 0.0], abs=1e-6)
    assert corners_by_kind[2].max(axis=0) == pytest.approx([0.62, 0.15, 0.2], abs=1e-6)
    down = 0.5 * 0.245 * np.cos(np.radians(50))  # the lower edge of the sliding face
    edge = corners_by_kind[1][np.argmax(corners_by_kind[1][:, 0] + 1e-3 * corners_by_kind[1][:, 2])]
    assert (edge[0], edge[2]) == pytest.approx((down, 0.33), abs=1e-4)
    for number in (0, 1, 2):  # no two solids share corners
        others = np.unique(corners[numbers["solid"] != number])
        assert not set(np.unique(corners[numbers["solid"] == number])) & set(others)


def test_a_run_writes_solids_only_if_its_scene_has_some(finished, tmp_path):
    points, _, numbers = read(finished / "solids.vtp")
    assert set(numbers["kind"]) == {0, 1} and not points[:, 1].any()
    ball = Scene(dimension=2, bodies=[Body(shape=Shape.sphere((0, 1), 0.1))]).resolve()
    assert write_solids(ball, np.ones((2, 3)), tmp_path) is None
    panel = Scene(dimension=2, panel=Panel(height=1, length=1))
    panel.append("bodies", Body(shape=Shape.sphere((0, 3), 0.1)))
    assert write_solids(panel.resolve(), np.zeros((0, 3)), tmp_path) is None
    assert not list(tmp_path.iterdir())
