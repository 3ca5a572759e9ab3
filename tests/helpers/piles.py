"""Synthetic piles of particles whose measures are known."""

import numpy as np


def triangle(base: float, height: float, count: int = 40_000, seed: int = 1) -> np.ndarray:
    """Return particles that fill a symmetric 2D ridge on z = 0 with its crest at x = 0."""
    random = np.random.default_rng(seed)
    x = random.triangular(-base / 2, 0, base / 2, count)
    z = random.uniform(0, 1, count) * height * (1 - np.abs(x) / (base / 2))
    return np.column_stack([x, np.zeros(count), z])


def cone(radius: float, height: float, count: int = 60_000, seed: int = 1) -> np.ndarray:
    """Return particles that fill an upright cone on z = 0 around the z axis."""
    random = np.random.default_rng(seed)
    box = random.uniform([-1, -1, 0], [1, 1, 1], (8 * count, 3))
    inside = box[np.hypot(box[:, 0], box[:, 1]) <= 1 - box[:, 2]][:count]
    assert len(inside) == count
    return inside * [radius, radius, height]


def ball(center: tuple, radius: float, count: int, seed: int = 2) -> np.ndarray:
    """Return particles in a disc in the plane y = 0."""
    random = np.random.default_rng(seed)
    r, angle = radius * np.sqrt(random.uniform(0, 1, count)), random.uniform(0, 2 * np.pi, count)
    return np.array(center) + np.column_stack([r * np.cos(angle), 0 * r, r * np.sin(angle)])
