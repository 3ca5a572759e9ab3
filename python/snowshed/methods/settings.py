"""The common base of the settings of all methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Optional

from snowshed.base.record import Record


@dataclass
class MethodSettings(Record):
    """Settings of a method."""

    #: Name of the setting for the finest size that the method resolves, m; empty where files that
    #: the scene names decide it.
    RESOLUTION: ClassVar[str]
    #: Plural noun in notes for things of this size.
    ELEMENTS: ClassVar[str] = "cells"

    @property
    def resolution(self) -> Optional[float]:
        """Finest size that the method resolves, m."""
        size: Optional[float] = getattr(self, self.RESOLUTION)
        return size

    def damping_text(self, rate: Optional[float] = None) -> str:
        """Return a caption on the method's damping; empty where it has none.

        Parameters
        ----------
        rate
            Mean damping rate of a run, 1/s, where the settings do not give it.
        """
        return ""
