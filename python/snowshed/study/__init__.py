"""Studies: many runs of one scene in which parameters vary, computed once and kept in a store.

Examples
--------
>>> from snowshed import Scene
>>> from snowshed.study import Study, linear
>>> study = Study.product(
...     Scene.preset("sensitivity").update({"dimension": 2, "numerics.dx": 0.02}),
...     {"snow.cohesion": [0.1, 0.2, 0.3], "panel.tilt": linear(40, 60, step=10)},
...     name="cohesion-and-tilt",
... )
>>> len(study.runs())
9

``study.run("results")`` computes them and returns the table.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
