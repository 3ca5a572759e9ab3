"""What a slide came to."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SlideSummary:
    """What a slide came to.

    Attributes
    ----------
    ended
        "rest" or "time_limit".
    duration_s
        Of the slide.
    particles
        At the end.
    released_kg, entrained_kg
        Mass that was released and taken up.
    left_terrain_kg, detrained_kg, on_terrain_kg
        Where it went: off the terrain or into its holes, left behind in forest (none is), and
        still on the terrain at the end; at rest, if the slide ended so.
    bonds_made, bonds_broken
        Bonds between particles, and how many of them broke or left the terrain.
    peak_speed_m_s, peak_thickness_m, peak_pressure_kpa
        Largest values anywhere.
    reached_m2
        Area on the map that snow reached, of cells around nodes.
    run_out_m
        Farthest way on the map from the middle of the release to where snow lies at the end.
    drop_m
        Height between the highest node of the release and the lowest where snow lies.
    notes
        What should be known of these figures.
    """

    ended: str
    duration_s: float
    particles: int
    released_kg: float
    entrained_kg: float
    left_terrain_kg: float
    detrained_kg: float
    on_terrain_kg: float
    bonds_made: int
    bonds_broken: int
    peak_speed_m_s: float
    peak_thickness_m: float
    peak_pressure_kpa: float
    reached_m2: float
    run_out_m: float
    drop_m: float
    notes: tuple[str, ...] = ()
