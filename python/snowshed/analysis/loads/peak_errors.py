"""Dependence of simulated loads on the grid and on the seed, from recorded runs.

The runs are those of ``validation/forces/peak_records.py`` (docs/trust/forces.md): slabs that slide
off onto the ground, onto a lower roof and against a fence, on three grids over a factor of four in
cells.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed.base.formatting import percent
from snowshed.methods.registry import settings_of

RECORDS = Path(__file__).with_name("peak_records.csv")
#: Loads in the sentence, by their columns in the records.
LOADS = {
    "peak_1ms_n": "1 ms",
    "peak_10ms_n": "10 ms",
    "peak_100ms_n": "100 ms",
    "rest_n": "at rest",
}


def grid_dependence(scheme: str) -> dict[str, dict[str, float]]:
    """Return how far loads change over a factor of four in cells, by case and load.

    Parameters
    ----------
    scheme
        Numerical scheme of the material point method.

    Returns
    -------
    dict
        For each case, "lower roof on lower roof", and each column of `LOADS`: the largest mean over
        the seeds, over the smallest one, less 1.

    Examples
    --------
    >>> dependence = grid_dependence("thesis")
    >>> 0.0 <= dependence["lower roof on lower roof"]["peak_10ms_n"] < 0.1
    True
    """
    means: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    with RECORDS.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["scheme"] == scheme:
                for column in LOADS:
                    means[f"{row['case']} on {row['obstacle']}"][column].append(float(row[column]))
    return {
        case: {column: max(values) / min(values) - 1.0 for column, values in of_case.items()}
        for case, of_case in means.items()
    }


def peak_error_sentence(scene: Mapping[str, Any]) -> str:
    """Return a sentence on how far the loads of a scene depend on its grid.

    Examples
    --------
    >>> from snowshed import Scene
    >>> "recorded" in peak_error_sentence(Scene.preset("lab-50").resolve().data)
    True
    """
    settings = settings_of(scene)
    scheme = getattr(settings, "scheme", None)
    if scheme is None:
        return (
            "The dependence of peaks on the spacing of the particles has not been recorded for "
            "this method: compare with half the spacing."
        )
    dependence = grid_dependence(scheme)
    changes = {column: max(of_case[column] for of_case in dependence.values()) for column in LOADS}
    listed = ", ".join(f"{name} by {percent(changes[key], 2)}" for key, name in LOADS.items())
    return (
        "Loads depend on the grid. In recorded slide-offs onto the ground, a lower roof and a "
        f"fence (scheme {scheme}), cells four times as large changed the load on a part by at "
        f"most: {listed}. The sum over all parts at rest is exact. Largest pressures are means "
        "over patches of four cells, at least 5 cm, and grow as patches shrink."
    )
