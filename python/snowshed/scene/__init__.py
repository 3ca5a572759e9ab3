"""Scenes: what is to be simulated, as data.

Examples
--------
>>> scene = Scene(panel=Panel(height=0.5, length=2.0, tilt=40.0), dimension=2)
>>> scene.panel.surface_tilt
40.0
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from snowshed.io.renamed import renamed
from snowshed.methods.mpm import MpmSettings
from snowshed.scene.components import (
    Body,
    Domain,
    Events,
    Ground,
    Layer,
    Motion,
    Obstacle,
    Output,
    Panel,
    Seeding,
    Slab,
    Snow,
)
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.scene.shape import Shape

__all__ = [
    "Body",
    "Domain",
    "Events",
    "Ground",
    "Layer",
    "Motion",
    "MpmSettings",
    "Obstacle",
    "Output",
    "Panel",
    "ResolvedScene",
    "Scene",
    "Seeding",
    "Shape",
    "Slab",
    "Snow",
]

if not TYPE_CHECKING:
    __getattr__ = renamed(__name__, {"InitialisedScene": ResolvedScene, "Numerics": MpmSettings})
