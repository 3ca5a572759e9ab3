"""Search, for each MPM scheme, the snow whose stacks match those of the calibrated snow.

Usage: python -m benchmarks.scheme_calibration run FOLDER
       python -m benchmarks.scheme_calibration rank

`run` makes the stacks (a quarter of an hour on two cores) and appends them to
benchmarks/results/calibration-schemes.csv. `rank` prints the snows of each scheme by their errors.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd
from benchmarks.keeping import RESULTS, append_rows

from snowshed.analysis.calibration.comparison import SimulatedStacks, compare_stacks
from snowshed.analysis.calibration.measurements import Measurement, measured_column
from snowshed.analysis.calibration.misfit import rank_sets
from snowshed.analysis.calibration.parameter_grid import COHESION, GRID, PRESSURE, SLOPE
from snowshed.scene.components import Snow
from snowshed.scene.scene import Scene
from snowshed.snow.stack.quantities import QUANTITIES
from snowshed.study import Study

STACKS = RESULTS / "calibration-schemes.csv"
SCHEMES = ("objective", "thesis")
#: Scheme of the six stacks that stand in for measured ones.
STAND_IN = "thesis"
#: Their seeds.
STAND_IN_SEEDS = range(101, 107)
#: Snows that are stronger than those of the thesis's grid.
STRONGER_SNOWS = {SLOPE: [0.5, 0.7], PRESSURE: [10e3, 14e3], COHESION: [0.2, 0.4]}
TILT = "panel.tilt"
TILTS = {TILT: [40.0, 50.0]}
SNOW = [SLOPE, PRESSURE, COHESION]
COMPARED_QUANTITIES = ["height", "length"]


def run(folder: Path) -> None:
    """Compute the stacks, and append them to the record."""
    lab = Scene.preset("lab-50").with_({"dimension": 2, "panel.friction": 0.6, "events.count": 5})
    calibrated = Snow.preset("calibrated").to_data()
    known = {path: [calibrated[path.rpartition(".")[2]]] for path in SNOW}
    tables = [_stacks(lab, STAND_IN, known, STAND_IN_SEEDS, folder / "stand-in")]
    for scheme, snows in (("thesis", GRID), ("objective", GRID), ("objective", STRONGER_SNOWS)):
        name = f"{scheme}-{'grid' if snows is GRID else 'stronger'}"
        tables.append(_stacks(lab, scheme, snows, [1], folder / name))
    append_rows(pd.concat(tables), STACKS)


def _stacks(
    lab: Scene,
    scheme: str,
    snows: Mapping[str, Sequence[float]],
    seeds: Sequence[int],
    folder: Path,
) -> pd.DataFrame:
    scene = lab.with_({"numerics.scheme": scheme, "numerics.dx": 0.01})
    axes = {**TILTS, **{path: list(values) for path, values in snows.items()}}
    rows = Study.product(scene, axes, seeds=seeds).run(folder, threads=1)
    columns = [
        *SNOW,
        TILT,
        "seed",
        "event",
        *map(measured_column, COMPARED_QUANTITIES),
        "centre_height_m",
    ]
    return rows[columns].assign(scheme=scheme)


def ranked(scheme: str) -> pd.DataFrame:
    """Return the snows of a scheme, sorted from the best.

    Returns
    -------
    pandas.DataFrame
        The table of `rank_sets` with the mean deviation of the height, ``height_bias_m`` (m).
    """
    columns = {TILT: "tilt", **{measured_column(name): name for name in COMPARED_QUANTITIES}}
    table = pd.read_csv(STACKS).rename(columns=columns)
    is_stand_in = (table["scheme"] == STAND_IN) & table["seed"].isin(STAND_IN_SEEDS)
    means = table[is_stand_in].groupby(["tilt", "event"])[COMPARED_QUANTITIES].mean()
    targets = [
        Measurement(tilt, event, 1, name, row[name], 1.0)
        for (tilt, event), row in means.iterrows()
        for name in COMPARED_QUANTITIES
    ]
    rows = table[~is_stand_in & (table["scheme"] == scheme)]
    rows = rows.assign(set=rows.groupby(SNOW, sort=False).ngroup() + 1)
    sets = rows.drop_duplicates("set").set_index("set")[SNOW]
    rows = rows.reindex(columns=["tilt", "seed", "event", *QUANTITIES, "set"])
    stacks = SimulatedStacks(SNOW, sets, rows)
    comparison = compare_stacks(stacks, targets)
    heights = comparison[comparison["quantity"] == "height"]
    bias = (heights["simulated"] - heights["value"]).groupby(heights["set"]).mean()
    return rank_sets(stacks, comparison).assign(height_bias_m=lambda of: of["set"].map(bias))


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("run").add_argument("folder", type=Path)
    commands.add_parser("rank")
    chosen = parser.parse_args()
    if chosen.command == "run":
        run(chosen.folder)
    else:
        for scheme in SCHEMES:
            print(scheme, ranked(scheme).head(6).round(3).to_string(index=False), sep="\n")


if __name__ == "__main__":
    main()
