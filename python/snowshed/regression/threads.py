"""Keeping linear algebra on one thread."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from snowshed.extras import require

#: Each brings threads of its own, and only those of loaded libraries can be limited.
LIBRARIES = ("scipy.linalg", "sklearn.svm")


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep libraries from using more than one thread: for small matrices they only get slower."""
    threadpoolctl = require("threadpoolctl", "regression", "regression")
    for library in LIBRARIES:
        require(library, "regression", "regression")
    with threadpoolctl.threadpool_limits(1):
        yield
