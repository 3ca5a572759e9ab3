"""Chapter 4: the calibration, on synthetic measurements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from reproductions.common.hypothesis_tests import judge
from reproductions.common.section import Content
from reproductions.frischholz2023 import printed
from reproductions.frischholz2023.claims.calibration import CALIBRATION, Recovery
from reproductions.frischholz2023.printed import CALIBRATED
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.studies import GRID, TRUTH, TRUTH_SEED
from reproductions.frischholz2023.tables import PANEL_FRICTION, SAVED_DPI, settings_grid
from snowshed._core import InputError
from snowshed.analysis.calibration.comparison import read_simulated_stacks
from snowshed.analysis.calibration.measurements import Measurement
from snowshed.analysis.calibration.misfit import RANKING_QUANTITIES, statistics
from snowshed.analysis.calibration.report import Calibration, calibrate, write
from snowshed.base.formatting import number, percent
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.scene.labels import label
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

#: Relative standard deviation of the synthetic measurements.
UNCERTAINTY = 0.05
#: Seed of their errors.
ERRORS_SEED = 1
TEXT = (
    "The thesis prints the measured stacks as figures only, so the snow of the laboratory "
    "cannot be calibrated again. This section tests the procedure. A known snow, the calibrated "
    "snow of Table 4.3.1 (M 0.5, p₀ 7 kPa, β 0.2), is simulated at both tilts with a placement of "
    f"particles of its own (seed {TRUTH_SEED}), \u201cmeasured\u201d with random errors of "
    f"{percent(UNCERTAINTY)}, and searched for among the triplets.",
    PANEL_FRICTION,
    "Numbers called synthetic compare simulations with this simulated truth. They do not "
    "reproduce the thesis's scores, which compare with the laboratory. They are smaller, because "
    "the model is exact here.",
)
FIGURES = {
    "relative-error": ("Mean relative error", "As Figure 4.2.1, against the synthetic truth."),
    "rmse": ("RMSE of the triplets", "As Figure 4.2.2, against the synthetic truth."),
    "fit": ("Fit", "“Measured” are the synthetic stacks."),
    "posterior": ("Posterior", "Parameters that the synthetic stacks allow; not in the thesis."),
}
SCORES = {
    "height_mean_error_m": "height, mean error, m",
    "length_mean_error_m": "length, mean error, m",
    "height_rmse_m": "height, RMSE, m",
    "length_rmse_m": "length, RMSE, m",
    "rescaled_rmse": "RMSE, rescaled mean",
}


def build(work: ThesisComputation) -> Content:
    """Return the content.

    Raises
    ------
    InputError
        If not enough is computed, or a library of the extra ``calibration`` is missing.
    """
    stage, folder = work.study_stages["calibration"], work.folder.of_stage("calibration")
    if not stage.state().finished:
        raise InputError("the grid can be ranked only when all its runs are computed")
    measured = synthetic(read_table(work.folder.runs, TRUTH))
    result = calibrate(
        measured, read_simulated_stacks(work.folder.runs, GRID), steps=work.settings.steps
    )
    write(result, folder)
    tables = [
        ("Table 4.1.1: settings", settings_grid(printed.CALIBRATION, stage.scenes(GRID))),
        ("Table 4.2.1: RMSE over the triplets, m", statistics_grid(result)),
        ("Table 4.3.1: scores of the calibrated snow", scores_grid(result)),
        ("Ranges that the synthetic stacks allow", ranges_grid(result.ranges)),
    ]
    pictures = [
        Picture.read(folder / f"{name}.png", title, caption, dpi=SAVED_DPI)
        for name, (title, caption) in FIGURES.items()
    ]
    claims = judge(CALIBRATION, Recovery(result.ranked, result.ranges))
    return Content(TEXT, tables, pictures, claims)


def synthetic(truth: pd.DataFrame) -> list[Measurement]:
    """Return measurements of the simulated truth, with random errors.

    Raises
    ------
    InputError
        If the truth is not computed.
    """
    truth = truth.dropna(subset=["height_m", "length_m"])
    if truth.empty:
        raise InputError("the synthetic measurements are not computed")
    errors = np.random.default_rng(ERRORS_SEED)
    measured = []
    for row in truth.sort_values(["panel.tilt", "event"]).to_dict("records"):
        for quantity in RANKING_QUANTITIES:
            true = row[f"{quantity}_m"]
            value = true * (1 + UNCERTAINTY * errors.normal())
            tilt, event = float(row["panel.tilt"]), int(row["event"])
            measured.append(Measurement(tilt, event, 1, quantity, value, UNCERTAINTY * true))
    return measured


def statistics_grid(calibration: Calibration) -> HtmlTable:
    """Return Table 4.2.1, the thesis's beside the synthetic one."""
    ours = statistics(calibration.ranked)
    rows = []
    for quantity, thesis in printed.RMSE_STATISTICS.items():
        rows.append([quantity, "thesis, 48 triplets, laboratory", *map(_metres, thesis.values())])
        synthetic_row = [_metres(ours[name][f"{quantity}_rmse_m"]) for name in thesis]
        here = f"here, {len(calibration.ranked)} triplets, synthetic truth"
        rows.append(["", here, *synthetic_row])
    return HtmlTable(["RMSE", "against", *thesis], rows, "ll" + "r" * len(thesis))


def scores_grid(calibration: Calibration) -> HtmlTable:
    """Return the scores of the calibrated snow, the thesis's beside the synthetic ones."""
    row = calibration.ranked
    for path, value in CALIBRATED.items():
        row = row[np.isclose(row[path], value)]
    rows = [
        [title, _metres(printed.CALIBRATED_SCORES[name]), _metres(row[name].iloc[0])]
        for name, title in SCORES.items()
        if len(row)
    ]
    if len(row):
        rank = f"{row['rank'].iloc[0]} of {len(calibration.ranked)} (synthetic)"
        rows.append(["rank by the rescaled mean", "1 of 48; " + printed.CALIBRATED_RANKS, rank])
    return HtmlTable(["score", "thesis (laboratory)", "here (synthetic truth)"], rows, "lrr")


def ranges_grid(ranges: pd.DataFrame) -> HtmlTable:
    """Return the posterior's ranges beside the truth."""
    rows = []
    for row in ranges.to_dict("records"):
        parameter_label = label(row["parameter"])
        values = [CALIBRATED[row["parameter"]], row["best_set"], row["median"]]
        ends = [f"{parameter_label.value(row[low])} to {parameter_label.value(row[high])}"
                for low, high in (("lower_68", "upper_68"), ("lower_95", "upper_95"))]  # fmt: skip
        rows.append(
            [
                parameter_label.axis,
                *(parameter_label.value(value) for value in values),
                *ends,
                row["open"],
            ]
        )
    head = ["parameter", "truth", "best triplet", "median", "68 %", "95 %", "open"]
    return HtmlTable(head, rows, "lrrrrrl")


def _metres(value: float) -> str:
    return f"{value:.3f}" if value == value else number(value)
