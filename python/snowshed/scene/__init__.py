"""Scenes: simulations described as data.

Examples
--------
>>> scene = Scene(panel=Panel(height=0.5, length=2.0, tilt=40.0), dimension=2)
>>> scene.panel.surface_tilt
40.0
"""

from __future__ import annotations

from snowshed.methods.grains.settings import GrainsSettings
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.mps.settings import MpsSettings
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene.components import (
    Area,
    Body,
    Domain,
    Events,
    Ground,
    Hole,
    Layer,
    Motion,
    Obstacle,
    Panel,
    ResistanceArea,
    Seeding,
    Slab,
    Snow,
    Terrain,
)
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.output import Output
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.scene.shape import Shape

__all__ = [
    "Area",
    "Body",
    "Cone",
    "Domain",
    "Events",
    "GrainsSettings",
    "Ground",
    "Hole",
    "Layer",
    "LoadingStage",
    "Motion",
    "MpmSettings",
    "MpsSettings",
    "Obstacle",
    "Output",
    "Panel",
    "ResistanceArea",
    "ResolvedScene",
    "Sample",
    "Scene",
    "Seeding",
    "Shape",
    "Slab",
    "SlideSettings",
    "Snow",
    "Terrain",
]
