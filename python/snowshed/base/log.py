"""The logger of the package: the course of runs and studies, and their notes.

Nothing is printed unless the caller configures `logging`.
"""

from __future__ import annotations

import logging

LOGGER = logging.getLogger("snowshed")
LOGGER.addHandler(logging.NullHandler())
