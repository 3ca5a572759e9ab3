"""Which settings of a scene decide how accurate a run is, and not what is simulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from snowshed.scene.components import Numerics

#: Where in a scene each setting stands. Threads do not change a result and are not among them.
ACCURACY: Mapping[str, str] = {
    **{f.name: f"numerics.{f.name}" for f in fields(Numerics) if f.name != "threads"},
    "particles_per_voxel": "seeding.particles_per_voxel",
    "pattern": "seeding.pattern",
}
