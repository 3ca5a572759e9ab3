"""Structures: scenes of panels, tables, roofs, meshes, terrain and trackers, ready to run.

Every builder returns a `Scene` to change further, run or save; `scene_figure` draws it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from snowshed.io.raster import Raster, read_raster
from snowshed.scene.builders.meshes import mesh_structure
from snowshed.scene.builders.panels import panel_rows, panel_table, single_panel
from snowshed.scene.builders.roofs import gable_roof, shed_roof
from snowshed.scene.builders.terrain import on_terrain
from snowshed.scene.builders.tracker import tracker

if TYPE_CHECKING:
    from snowshed.plot.scene_picture import scene_figure

__all__ = [
    "Raster",
    "gable_roof",
    "mesh_structure",
    "on_terrain",
    "panel_rows",
    "panel_table",
    "read_raster",
    "scene_figure",
    "shed_roof",
    "single_panel",
    "tracker",
]


def __getattr__(name: str) -> Any:
    """Import what needs matplotlib only when it is asked for."""
    if name == "scene_figure":
        from snowshed.plot.scene_picture import scene_figure

        return scene_figure
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
