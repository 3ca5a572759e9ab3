"""Structures: scenes of panels, tables, roofs, meshes, terrain and trackers, ready to run.

Every builder returns a `Scene` to change further, run or save; `snowshed.plot.scene_picture` draws
it.
"""
