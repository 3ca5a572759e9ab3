"""The common base of the settings of all methods."""

from __future__ import annotations

from collections.abc import Sequence
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

    #: Settings without effect while another one has a value: that setting, its value, and these.
    UNUSED: ClassVar[Sequence[tuple[str, object, Sequence[str]]]] = ()

    def unused(self) -> list[str]:
        """Return notes on settings that are not their defaults, and have no effect."""
        defaults = type(self)()
        return [
            f"/numerics/{name}: {getattr(self, name)} is not used, because {other} is {value!r}"
            for other, value, names in self.UNUSED
            for name in names
            if getattr(self, other) == value and getattr(self, name) != getattr(defaults, name)
        ]

    def damping_text(self, rate: Optional[float] = None) -> str:
        """Return a caption on the method's damping; empty where it has none.

        Parameters
        ----------
        rate
            Mean damping rate of a run, 1/s, where the settings do not give it.
        """
        return ""
