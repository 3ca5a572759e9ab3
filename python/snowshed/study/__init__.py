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

from snowshed.study.definition import Study
from snowshed.study.errors import StudyError, StudyInterrupted
from snowshed.study.factors import (
    Factor,
    Span,
    axis,
    latin_hypercube,
    linear,
    logarithmic,
    sobol,
)
from snowshed.study.formats import export, to_dataset
from snowshed.study.remeasuring import remeasure
from snowshed.study.scene_hash import Run
from snowshed.study.season_part import SeasonPart
from snowshed.study.session import resume
from snowshed.study.table import read_table

__all__ = [
    "Factor",
    "Run",
    "SeasonPart",
    "Span",
    "Study",
    "StudyError",
    "StudyInterrupted",
    "axis",
    "export",
    "latin_hypercube",
    "linear",
    "logarithmic",
    "read_table",
    "remeasure",
    "resume",
    "sobol",
    "to_dataset",
]
