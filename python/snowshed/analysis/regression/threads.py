"""Limiting linear algebra to one thread."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import scipy.linalg  # noqa: F401 - see below

from snowshed.base.extras import require


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit libraries to one thread, because more threads only slow down small matrices."""
    threadpoolctl = require("threadpoolctl", "regression", "regression")
    # Each library has its own threads; only loaded libraries can be limited.
    require("sklearn.svm", "regression", "regression")
    with threadpoolctl.threadpool_limits(1):
        yield
