"""Structures: scenes of panels, tables, roofs, meshes, terrain and trackers, ready to run.

Every builder returns a `Scene`, which can be changed, run or saved. `snowshed.plot.scene_picture`
draws it.
"""
