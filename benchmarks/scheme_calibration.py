"""Search the snow with which each scheme of the MPM makes the stacks of the calibrated snow.

Usage: python benchmarks/scheme_calibration.py run FOLDER
       python benchmarks/scheme_calibration.py rank

`run` makes the stacks (a quarter of an hour on two cores) and appends them to
benchmarks/results/calibration-schemes.csv. `rank` prints the snows of each scheme by their errors.
"""

from __future__ import annotations

import argparse
import datetime
from pathlib import Path

import pandas as pd

from snowshed.analysis.calibration.parameter_ranges import COHESION, GRID, PRESSURE, SLOPE
from snowshed.analysis.sensitivity.fixed_parameter import rescaled
from snowshed.base.machine import cpu_name
from snowshed.scene.components import Snow
from snowshed.scene.scene import Scene
from snowshed.study import Study

STACKS = Path(__file__).parent / "results" / "calibration-schemes.csv"
#: The six stacks of the scheme thesis that stand in for measured ones.
STAND_IN, STAND_IN_SEEDS = "thesis", range(101, 107)
#: Snows stronger than those of the thesis's grid.
STRONGER = {SLOPE: [0.5, 0.7], PRESSURE: [10e3, 14e3], COHESION: [0.2, 0.4]}
TILTS = {"panel.tilt": [40.0, 50.0]}
SNOW = [SLOPE, PRESSURE, COHESION]
QUANTITIES = ["height_m", "length_m"]


def run(folder: Path) -> None:
    """Make the stacks and append them to the record."""
    lab = Scene.preset("lab-50").with_({"dimension": 2, "panel.friction": 0.6, "events.count": 5})
    calibrated = Snow.preset("calibrated").to_data()
    known = {path: [calibrated[path.rpartition(".")[2]]] for path in SNOW}
    tables = [_stacks(lab, STAND_IN, known, STAND_IN_SEEDS, folder / "stand-in")]
    for scheme, snows in (("thesis", GRID), ("objective", GRID), ("objective", STRONGER)):
        name = f"{scheme}-{'grid' if snows is GRID else 'stronger'}"
        tables.append(_stacks(lab, scheme, snows, [1], folder / name))
    origin = {"machine": cpu_name(), "date": datetime.date.today().isoformat()}
    rows = pd.concat([pd.read_csv(STACKS), pd.concat(tables).assign(**origin)])
    rows.to_csv(STACKS, index=False, float_format="%.6g")


def _stacks(lab: Scene, scheme: str, snows, seeds, folder: Path) -> pd.DataFrame:
    scene = lab.with_({"numerics.scheme": scheme, "numerics.dx": 0.01})
    axes = {**TILTS, **{path: list(values) for path, values in snows.items()}}
    rows = Study.product(scene, axes, seeds=seeds).run(folder, threads=1)
    columns = [*SNOW, *TILTS, "seed", "event", *QUANTITIES, "centre_height_m"]
    return rows[columns].assign(scheme=scheme)


def errors() -> pd.DataFrame:
    """Return the errors of each scheme's snows, the best of each scheme first.

    Returns
    -------
    pandas.DataFrame
        Mean absolute errors (``_error``), mean deviations (``_bias``) and root mean squares
        (``_rmse``) of height and length over tilts and events, m; and ``score``, the mean of the
        rescaled root mean squares, by which the thesis ranks.
    """
    table = pd.read_csv(STACKS)
    of_stand_in = (table["scheme"] == STAND_IN) & table["seed"].isin(STAND_IN_SEEDS)
    target = table[of_stand_in].groupby([*TILTS, "event"])[QUANTITIES].mean()
    rows = table[~of_stand_in].join(target.add_suffix("_target"), on=[*TILTS, "event"])
    scores = rows[["scheme", *SNOW]].drop_duplicates().set_index(["scheme", *SNOW])
    for name in QUANTITIES:
        rows["off"] = rows[name] - rows[f"{name}_target"]
        off = rows.groupby(["scheme", *SNOW])["off"]
        scores[f"{name}_error"] = off.apply(lambda values: values.abs().mean())
        scores[f"{name}_bias"] = off.mean()
        scores[f"{name}_rmse"] = off.apply(lambda values: (values**2).mean() ** 0.5)
    parts = [
        scores.groupby("scheme")[f"{name}_rmse"].transform(lambda values: rescaled(values))
        for name in QUANTITIES
    ]
    scores["score"] = sum(parts) / len(parts)
    return scores.sort_values(["scheme", "score"]).reset_index()


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
        print(errors().groupby("scheme").head(6).round(3).to_string(index=False))


if __name__ == "__main__":
    main()
