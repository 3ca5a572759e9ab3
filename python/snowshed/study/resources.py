"""The processor cores, graphics cards and clusters that compute the runs of a study."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError, available_cores, graphics_cards
from snowshed.base.field_type import shown
from snowshed.scene.resolved import scene_data
from snowshed.study.local import LocalWorkers
from snowshed.study.workers import Workers


@dataclass(frozen=True)
class Resources:
    """The resources that a study may use; see `Study.run` for the fields."""

    jobs: Optional[int] = None
    threads: Optional[int] = None
    scheduler: object = None

    def __post_init__(self) -> None:
        if not _may_be_scheduler(self.scheduler):
            raise InputError(
                f"scheduler: {shown(self.scheduler)}; needed: the address of a Dask scheduler, the "
                "path of its .json file, a Dask cluster, or a Dask client"
            )
        for name in ("jobs", "threads"):
            value = getattr(self, name)
            if value is not None and value < 1:
                raise InputError(f"{name}: {value} is not positive")
            if value is not None and self.scheduler is not None:
                raise InputError(f"{name}: not allowed with a scheduler, whose workers set it")

    def workers(self, scenes: Sequence[str]) -> tuple[Workers, int]:
        """Return workers for runs of these scenes, and how many runs they compute at once."""
        if self.scheduler is not None:
            from snowshed.study.cluster import DaskWorkers

            cluster = DaskWorkers(self.scheduler)
            return cluster, cluster.cores
        cores = available_cores()
        at_once = self.jobs or _cards(scenes) or max(1, cores // (self.threads or 1))
        processes = max(1, min(at_once, len(scenes)))
        return LocalWorkers(processes, self.threads, cores), processes


def _cards(scenes: Sequence[str]) -> int:
    """Return the number of graphics cards on which the scenes may be computed.

    A run takes the card that the fewest others use, so this many runs have a card each.
    """
    devices = {scene_data(scene)["numerics"].get("device", "cpu") for scene in scenes}
    return graphics_cards() if devices - {"cpu"} else 0


def _may_be_scheduler(value: object) -> bool:
    """Return whether a value is of a type that `DaskWorkers` accepts; Dask is not imported."""
    if isinstance(value, (str, os.PathLike)):
        return bool(os.fspath(value))
    is_client = any(own.__name__ == "Client" for own in type(value).__mro__)
    return value is None or is_client or hasattr(value, "scheduler_address")
