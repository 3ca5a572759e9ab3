"""Compare the laboratory's stacks on several grids, with both schemes of the MPM.

Usage: python -m benchmarks.stack_grid run FOLDER [--case lab2d] [--seeds 12]
       [--cells 0.02 0.01 0.005]
       python -m benchmarks.stack_grid time [--case lab2d] [--seeds 3] [--cells 0.02 0.01 0.005]
       python -m benchmarks.stack_grid draw

`run` makes the stacks of the record (hours on 0.25 cm cells) and appends them to
benchmarks/results/stack-grid.csv. `time` runs each seed on each grid, scheme after scheme on one
thread, and appends the times to stack-grid-times.csv; nothing else should run on the machine
meanwhile. `draw` draws errors over run time into docs/images/stack-grid.png, and prints the
deviations. It also writes the table from which commands take the error of the grid.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from benchmarks.keeping import RESULTS, append_rows
from matplotlib.axes import Axes

from snowshed.io.csv_table import write_csv
from snowshed.plot import INK, blank_figure, save_figure
from snowshed.scene.scene import Scene
from snowshed.snow.accuracy.panel_errors import COLUMNS as ERROR_COLUMNS
from snowshed.snow.accuracy.panel_errors import ERRORS
from snowshed.snow.accuracy.panel_errors import TABLE as ERROR_TABLE
from snowshed.study import Study
from snowshed.study.table import read_table

STACKS = RESULTS / "stack-grid.csv"
TIMES = RESULTS / "stack-grid-times.csv"
PICTURE = Path(__file__).parents[1] / "docs" / "images" / "stack-grid.png"

SCHEMES = ("thesis", "objective")
COLOURS = {"thesis": INK, "objective": "tab:blue"}
QUANTITIES = {
    "height_m": "height",
    "length_m": "length",
    "centre_height_m": "height of the centre of mass",
}
#: Distance of a label from its point, points.
LABEL_ABOVE = {"thesis": 7, "objective": -15}
TIME_TICKS = (0.5, 1, 2, 5, 10, 20)  # s
ERROR_TICKS = (2, 5, 10, 20, 50, 100)  # percent
#: Cases of the picture, a row each, with the title of the row.
ROWS = {"lab2d": "2D, five slide-offs", "lab3d": "3D, two slide-offs"}
#: Columns of the record, with the fields of a panel.
PANEL = {"tilt": "tilt", "panel_length": "length", "friction": "friction"}
COLUMNS = (
    *("case", "scheme", *PANEL, "dx", "seed", "event", *QUANTITIES),
    *("spread_m", "steps"),
)


@dataclass(frozen=True)
class Case:
    """Values of a scene, and the factors of its study."""

    values: Mapping[str, Any]
    factors: Mapping[str, Sequence[float]]


CASES = {
    "lab2d": Case({"dimension": 2}, {"panel.tilt": [50.0, 40.0], "panel.friction": [0.3, 0.6]}),
    "lab3d": Case({"events.count": 2}, {"panel.tilt": [50.0]}),
    # Panels of the thesis's chapter 5.
    "chap5": Case(
        {"dimension": 2, "panel.height": 2.0, "slab.thickness": 0.05, "events.count": 2},
        {"panel.tilt": [40.0], "panel.length": [0.5, 2.0, 4.0]},
    ),
}
#: Columns that identify a stack, for any size of cells.
GROUP_COLUMNS = ("case", "scheme", "tilt", "panel_length", "friction", "event")


def scene_of(scheme: str, cells: float, case: str = "lab2d") -> Scene:
    """Return the scene of a case, with the laboratory's panel of 50 degrees and friction 0.3."""
    return Scene.preset("lab-50").with_(
        {
            **CASES[case].values,
            "numerics.scheme": scheme,
            "numerics.dx": cells,
            "panel.friction": 0.3,
        }
    )


def run(folder: Path, case: str, seeds: int, all_cells: Sequence[float]) -> None:
    """Compute the stacks of a case, and append them to the record."""
    for scheme in SCHEMES:
        for cells in all_cells:
            scene = scene_of(scheme, cells, case)
            study = Study.product(scene, CASES[case].factors, seeds=range(1, seeds + 1))
            rows = study.run(folder / f"{case}-{scheme}-{cells}", threads=1)
            panel = {
                name: rows.get(f"panel.{field}", getattr(scene.panel, field))
                for name, field in PANEL.items()
            }
            rows = rows.assign(case=case, scheme=scheme, dx=cells, **panel)
            append_rows(rows[list(COLUMNS)], STACKS)


def measure_times(case: str, seeds: int, all_cells: Sequence[float]) -> None:
    """Run each seed on each grid with each scheme in turn, and append the times to a file."""
    for cells in all_cells:
        for seed in range(1, seeds + 1):
            for scheme in SCHEMES:
                wall = _wall_time(scene_of(scheme, cells, case), seed)
                print(f"{case} {scheme} {cells} m, seed {seed}: {wall:.2f} s", flush=True)
                row = {"case": case, "scheme": scheme, "dx": cells, "seed": seed, "wall_s": wall}
                append_rows(pd.DataFrame([row]), TIMES)


def _wall_time(scene: Scene, seed: int) -> float:
    """Return the time of a run on the panel of 50 degrees, s."""
    with tempfile.TemporaryDirectory() as folder:
        Study.product(scene, {"panel.tilt": [50.0]}, seeds=[seed]).run(folder, threads=1)
        return float(read_table(folder, timing=True)["run_wall_s"].max())


def deviations() -> pd.DataFrame:
    """Return the deviations of mean stacks from those on the finest grid of their scheme.

    Returns
    -------
    pandas.DataFrame
        A row for each case, scheme, panel, event and size of cells. Columns are the number of seeds
        `n`, means in m, their standard errors (`_sem`) and their relative deviations (`_off`).
    """
    groups = pd.read_csv(STACKS).groupby([*GROUP_COLUMNS, "dx"])
    table = groups[list(QUANTITIES)].mean()
    table["n"] = groups["seed"].count()
    for name in QUANTITIES:
        table[f"{name}_sem"] = groups[name].sem()
        finest = table[name].groupby(level=list(GROUP_COLUMNS)).transform("first")
        table[f"{name}_off"] = table[name] / finest - 1
    return table.reset_index()


def panel_errors(table: pd.DataFrame) -> pd.DataFrame:
    """Return the deviations of heights and lengths on all grids but the finest, for `ERROR_TABLE`.

    Parameters
    ----------
    table : pandas.DataFrame
        Deviations, as `deviations` returns them.
    """
    panel = [name for name in GROUP_COLUMNS if name != "event"]
    finest = table.groupby(panel)["dx"].transform("min")
    has_finest = table.groupby(list(GROUP_COLUMNS))["dx"].transform("min") == finest
    coarse = table[has_finest & (table["dx"] > finest)]
    scenes = {case: scene_of("thesis", 0.01, case) for case in CASES}
    thickness = coarse["case"].map({case: scene.slab.thickness for case, scene in scenes.items()})
    coarse = coarse.assign(
        dimension=coarse["case"].map({case: scene.dimension for case, scene in scenes.items()}),
        cells=(thickness / coarse["dx"]).round(6),
        **{column: coarse[f"{name}_m_off"].round(6) for name, column in ERRORS.items()},
    )
    return coarse.rename(columns={"event": "slide_offs"})[list(ERROR_COLUMNS)]


def work_precision(table: pd.DataFrame) -> pd.DataFrame:
    """Return the errors of stacks below the panel of 50 degrees and friction 0.3, with run times.

    Parameters
    ----------
    table : pandas.DataFrame
        Deviations, as `deviations` returns them.

    Returns
    -------
    pandas.DataFrame
        A row for each case, scheme and size of cells but the finest. Columns are the mean run time
        `wall_s` and, for each quantity, the root mean square of its deviations over the events.
    """
    lab = table[(table["tilt"] == 50) & (table["friction"] == 0.3)]
    grid = ["case", "scheme", "dx"]
    coarse = lab[lab["dx"] > lab.groupby(grid[:2])["dx"].transform("min")]
    deviation = coarse.set_index(grid)[[f"{name}_off" for name in QUANTITIES]]
    errors = (deviation**2).groupby(grid).mean() ** 0.5
    errors.columns = pd.Index(QUANTITIES)
    times = pd.read_csv(TIMES).groupby(grid)["wall_s"].mean()
    return errors.join(times, how="inner").reset_index()


def pareto_front(time: pd.Series, error: pd.Series) -> pd.Index:
    """Return the rows that no other row beats in both time and error, from short times to long."""
    by_time = error[time.sort_values().index]
    return by_time.index[by_time < by_time.cummin().shift(fill_value=float("inf"))]


def draw() -> None:
    """Draw the error of stacks over the time of a run, and write the errors of all panels."""
    table = deviations()
    print(table.round(4).to_string(index=False))
    write_csv(panel_errors(table), ERROR_TABLE)
    precision = work_precision(table)
    print(precision.round(4).to_string(index=False))
    figure = blank_figure(9.0, 6.2)
    axes = figure.subplots(2, 3, sharex="row", sharey=True)
    for row, (case, title) in zip(axes, ROWS.items()):
        points = precision[precision["case"] == case]
        for panel, (name, label) in zip(row, QUANTITIES.items()):
            _draw_errors(panel, points, name)
            panel.set_title(label, fontsize=10)
            panel.set_xlabel("run time, s")
        row[0].set_ylabel(f"{title}:\ndeviation from the finest grid, %")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    save_figure(figure, PICTURE)


def _draw_errors(axes: Axes, points: pd.DataFrame, name: str) -> None:
    time, percent = points["wall_s"], 100 * points[name]
    for scheme in SCHEMES:
        of_scheme = points["scheme"] == scheme
        axes.loglog(time[of_scheme], percent[of_scheme], "o-", color=COLOURS[scheme], label=scheme)
    front = pareto_front(time, percent)
    axes.loglog(
        time[front], percent[front], color="0.85", linewidth=7, zorder=1, label="Pareto front"
    )
    for row in points.index:
        axes.annotate(
            f"{100 * points['dx'][row]:g} cm",
            (time[row], percent[row]),
            textcoords="offset points",
            xytext=(0, LABEL_ABOVE[points["scheme"][row]]),
            ha="center",
            fontsize=8,
        )
    for axis, ticks in ((axes.xaxis, TIME_TICKS), (axes.yaxis, ERROR_TICKS)):
        axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xlim(0.4, 20)
    axes.set_ylim(2, 200)
    axes.minorticks_off()


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    commands = parser.add_subparsers(dest="command", required=True)
    running = commands.add_parser("run")
    running.add_argument("folder", type=Path)
    running.add_argument("--case", choices=CASES, default="lab2d")
    running.add_argument("--seeds", type=int, default=12)
    running.add_argument("--cells", type=float, nargs="+", default=[0.02, 0.01, 0.005])
    timing = commands.add_parser("time")
    timing.add_argument("--case", choices=CASES, default="lab2d")
    timing.add_argument("--seeds", type=int, default=3)
    timing.add_argument("--cells", type=float, nargs="+", default=[0.02, 0.01, 0.005])
    commands.add_parser("draw")
    chosen = parser.parse_args()
    if chosen.command == "run":
        run(chosen.folder, chosen.case, chosen.seeds, chosen.cells)
    elif chosen.command == "time":
        measure_times(chosen.case, chosen.seeds, chosen.cells)
    else:
        draw()


if __name__ == "__main__":
    main()
