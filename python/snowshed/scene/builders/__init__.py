"""Structures: scenes of panels, tables, roofs, meshes, terrain and trackers, ready to run.

Every builder returns a `Scene` to change further, run or save; `snowshed.plot.scene_picture` draws
it.
"""

from snowshed.io.raster.raster import Raster, read_raster
from snowshed.scene.builders.avaframe import avaframe_scene
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.builders.meshes import mesh_structure
from snowshed.scene.builders.panels import panel_rows, panel_table, single_panel
from snowshed.scene.builders.roofs import gable_roof, shed_roof
from snowshed.scene.builders.slides import example_slide, slide_scene
from snowshed.scene.builders.terrain import on_terrain
from snowshed.scene.builders.tracker import tracker

__all__ = [
    "Raster",
    "avaframe_scene",
    "example_slide",
    "gable_roof",
    "grains_scene",
    "mesh_structure",
    "on_terrain",
    "panel_rows",
    "panel_table",
    "read_raster",
    "shed_roof",
    "single_panel",
    "slide_scene",
    "tracker",
]
