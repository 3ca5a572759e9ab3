"""Test that all engines run: a sample is compressed between plates and smooth walls."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Press:
    """Parameters of the contact law and of the test, as in `snowshed.GrainsSettings`.

    Attributes
    ----------
    strain
        Strain at the end of the test, relative to the sample's height.
    every
        Steps between two records of the force.
    """

    time_step: float  # s
    speed: float = 0.1  # m/s
    strain: float = 0.01
    elastic_modulus: float = 1e9  # Pa
    stiffness_ratio: float = 0.3
    tensile_strength: float = 1e6  # Pa
    shear_strength: float = 1e6  # Pa
    friction: float = 0.2
    damping: float = 0.0  # local
    every: int = 5

    def steps(self, height: float) -> int:
        """Return the number of steps for a sample of this height."""
        return int(self.strain * height / self.speed / self.time_step)

    def save(self, file: Path) -> None:
        """Write the parameters to a JSON file."""
        file.write_text(json.dumps(asdict(self)), encoding="utf-8")

    @classmethod
    def load(cls, file: Path) -> Press:
        """Return the parameters from a file of `save`."""
        return cls(**json.loads(file.read_text(encoding="utf-8")))
