"""The common base of the settings of all methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Optional

from snowshed.base.record import Record


@dataclass
class MethodSettings(Record):
    """Settings of a method."""

    #: The setting that is the size of the smallest thing the method resolves, m; empty where files
    #: that the scene names decide it.
    RESOLUTION: ClassVar[str]
    #: What notes call things of this size, in the plural.
    ELEMENTS: ClassVar[str] = "cells"

    @property
    def resolution(self) -> Optional[float]:
        """The size of the smallest thing the method resolves, m."""
        size: Optional[float] = getattr(self, self.RESOLUTION)
        return size

    def damping_text(self, rate: Optional[float] = None) -> str:
        """Return how the method damps, for captions; empty where it does not.

        Parameters
        ----------
        rate
            The mean rate of a run, 1/s, where the settings do not give it.
        """
        return ""
