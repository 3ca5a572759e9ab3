"""Scenes: simulations described as data.

Examples
--------
>>> from snowshed.scene import Panel, Scene
>>> scene = Scene(panel=Panel(height=0.5, length=2.0, tilt=40.0), dimension=2)
>>> scene.panel.surface_tilt
40.0
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
