"""The figures of a slide."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from snowshed.methods.summary import Summary


@dataclass(frozen=True)
class SlideSummary(Summary):
    """The figures of a slide.

    Attributes
    ----------
    ended
        "rest" or "time_limit".
    sim_time_s
        Duration of the slide, s.
    final_particles
        Number of particles at the end.
    released_kg, secondary_kg, inflow_kg
        Mass that was released at the start, by snow that entered a secondary release, and by
        inflows.
    entrained_kg, detrained_kg
        Mass that the slide took up, and that forest took from it.
    stopped_kg, ground_gained_m3
        Mass that stopped and became ground, and the volume by which the ground rose: that of snow
        that stopped or that forest took, less that of entrained snow; 0 if the ground does not
        adapt to the snow.
    left_terrain_kg, on_terrain_kg
        Mass that left the terrain or fell into its holes, and mass on the terrain at the end.
    bonds_made, bonds_broken
        Numbers of bonds between particles, and of bonds that broke or left the terrain, without
        those of snow that became ground.
    peak_speed_m_s, peak_thickness_m, peak_pressure_kpa
        Largest values anywhere.
    reached_m2
        Area on the map that snow reached, in cells around nodes.
    run_out_m
        Largest distance on the map between the middle of the release and snow at the end.
    drop_m
        Height between the highest node of the release and the lowest node with snow at the end.
    notes
        Notes on these figures.
    """

    ended: str
    sim_time_s: float
    final_particles: int
    released_kg: float
    entrained_kg: float
    left_terrain_kg: float
    on_terrain_kg: float
    bonds_made: int
    bonds_broken: int
    peak_speed_m_s: float
    peak_thickness_m: float
    peak_pressure_kpa: float
    reached_m2: float
    run_out_m: float
    drop_m: float
    secondary_kg: float = 0.0
    inflow_kg: float = 0.0
    detrained_kg: float = 0.0
    stopped_kg: float = 0.0
    ground_gained_m3: float = 0.0
    notes: tuple[str, ...] = ()

    FILE: ClassVar[str] = "slide.json"
    TITLE: ClassVar[str] = "Snow slide"
    OPENED: ClassVar[str] = "maps, slide.html and slide.png"

    def lines(self) -> Mapping[str, str]:
        """Return the lines that people read, by name."""
        broken = f"{self.bonds_broken:,} of {self.bonds_made:,}"
        later = {
            "released later": self.secondary_kg,
            "brought by inflows": self.inflow_kg,
            "taken by forest": self.detrained_kg,
            "stopped and became ground": self.stopped_kg,
        }
        return {
            "ended": f"{self.ended} after {self.sim_time_s:.2f} s",
            "released": f"{self.released_kg:,.0f} kg",
            **{name: f"{mass:,.0f} kg" for name, mass in later.items() if mass > 0.0},
            "entrained": f"{self.entrained_kg:,.0f} kg",
            "left the terrain": f"{self.left_terrain_kg:,.0f} kg",
            "bonds broken": broken if self.bonds_made else "no bonds",
            "peak speed": f"{self.peak_speed_m_s:.2f} m/s",
            "peak thickness": f"{self.peak_thickness_m:.2f} m",
            "peak pressure": f"{self.peak_pressure_kpa:.2f} kPa",
            "area reached": f"{self.reached_m2:,.0f} m2",
            "run-out": f"{self.run_out_m:.1f} m from the middle of the release",
            "drop": f"{self.drop_m:.1f} m",
        }
