"""Models, tables and figures from a table of stacks, for ``snowshed regress``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Optional

from snowshed._core import InputError, available_cores
from snowshed.analysis.regression import summary
from snowshed.analysis.regression.ensemble import Ensemble
from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.kinds import Kind, kinds_named
from snowshed.analysis.regression.model_file import STORED_KINDS, Member, StackModel, save_model
from snowshed.analysis.regression.nested import Results, cross_validate
from snowshed.analysis.regression.rows import TARGETS, StackRows
from snowshed.analysis.regression.spread import predict_unseen_panels, stack_spread
from snowshed.analysis.regression.threads import one_thread
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MODEL = "model.npz"


@dataclass(frozen=True)
class TargetReport:
    """The results for one target.

    Attributes
    ----------
    target
        Name of the target.
    quartiles, errors
        Tables 5.3.1 and 5.3.2; see `snowshed.analysis.regression.summary`.
    expression
        The linear model as a formula; otherwise empty.
    """

    target: str
    quartiles: pd.DataFrame
    errors: pd.DataFrame
    expression: str


@checked
def regress(
    rows: StackRows,
    folder: PathLike,
    *,
    targets: Sequence[str] = (),
    models: Sequence[str] = (),
    scheme: Optional[CrossValidation] = None,
    jobs: Optional[int] = None,
    title: str = "",
    measure: str = "stack",
    figures: bool = True,
    progress: Optional[Reporter] = None,
) -> list[TargetReport]:
    """Regress stacks on panels, and write models, tables and figures.

    Parameters
    ----------
    rows
        The data set.
    folder
        Results folder: new, empty, or one whose regression was interrupted.
    targets
        Some of "ratio", "height", "length". [default: all]
    models
        Some of "linear", "rbf", "gaussian-process", "gradient-boosting". [default: all]
    scheme
        Rounds and folds. [default: those of section 5.2.3]
    jobs
        Number of processes. [default: the number of cores]
    title, measure
        Title of the data, and measure of the stack; kept in the model file.
    figures
        Whether figures are drawn.
    progress
        Called after each outer fold.

    Returns
    -------
    list of TargetReport
        One for each target.

    Raises
    ------
    InputError
        If a name is unknown, there are too few rows, or the folder holds something else.
    RegressionInterrupted
        On Ctrl-C; the same call resumes.
    """
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs: {jobs} is not positive")
    for name in targets:
        if name not in TARGETS:
            raise InputError(f"target: {name!r} is unknown; allowed: {', '.join(TARGETS)}")
    chosen = [name for name in TARGETS if not targets or name in targets]
    kinds = kinds_named(models)
    results = cross_validate(
        rows,
        Path(folder),
        targets=chosen,
        kinds=kinds,
        scheme=scheme or CrossValidation(),
        jobs=jobs or available_cores(),
        progress=progress,
    )
    with one_thread():
        output = _Output(rows, Path(folder), kinds, results, figures=figures)
        return output.write(chosen, title, measure)


class _Output:
    """Turns the folds' results into files."""

    def __init__(
        self,
        rows: StackRows,
        folder: Path,
        kinds: Mapping[str, Kind],
        results: Results,
        *,
        figures: bool,
    ) -> None:
        self._figures = figures
        self._rows, self._folder, self._kinds, self._results = rows, folder, kinds, results
        self._titles = {name: kind.title for name, kind in kinds.items()}

    def write(self, targets: Sequence[str], title: str, measure: str) -> list[TargetReport]:
        write_csv(
            summary.score_table(self._results), self._folder / "scores.csv", float_format="%.6g"
        )
        members: dict[tuple[str, str], Member] = {}
        reports = []
        for target in targets:
            elected = summary.elected_models(self._results, target)
            unseen = {}
            for kind in (name for name in STORED_KINDS if name in elected):
                members[target, kind], unseen[kind] = self._member(target, kind, elected[kind])
            reports.append(self._report(target, elected, unseen, members))
        if members:
            rows = self._rows
            model = StackModel(rows.inputs, members, title, measure, rows.settings, rows.names)
            save_model(model, self._folder / MODEL)
        else:
            (self._folder / MODEL).unlink(missing_ok=True)  # an earlier call's
        return reports

    def _member(
        self, target: str, kind: str, results: Sequence[FoldResult]
    ) -> tuple[Member, Floats]:
        """Return the ensemble with its spread, and its errors on unseen panels."""
        rounds: dict[int, list[Mapping[str, float]]] = {}
        for task, result in self._results.items():
            if (task.target, task.kind) == (target, kind):
                rounds.setdefault(task.round, []).append(result.parameters)
        predictions = predict_unseen_panels(
            self._kinds[kind], list(rounds.values()), self._rows, target
        )
        ensemble = Ensemble.of(results)
        values = self._rows.targets[target]
        unit = float(values.std()) or 1.0
        deviation = ensemble.predict(ensemble.points).std(axis=0) * unit
        spread = stack_spread(self._rows, target, predictions, deviation)
        return Member(ensemble, float(values.mean()), unit, spread), predictions - values

    def _report(
        self,
        target: str,
        elected: Mapping[str, Sequence[FoldResult]],
        unseen: Mapping[str, Floats],
        members: Mapping[tuple[str, str], Member],
    ) -> TargetReport:
        folder = self._folder / target
        folder.mkdir(exist_ok=True)
        values = self._rows.targets[target]
        linear = elected.get("linear")
        report = TargetReport(
            target,
            summary.quartile_table(elected, values),
            summary.error_table(elected, self._rows, target, unseen),
            summary.linear_expression(linear, self._rows, target) if linear else "",
        )
        write_csv(report.quartiles.reset_index(), folder / "quartiles.csv", float_format="%.6g")
        write_csv(report.errors.reset_index(), folder / "errors.csv", float_format="%.6g")
        if report.expression:
            write_text(folder / "linear.txt", report.expression + "\n")
        of_target = {kind: member for (name, kind), member in members.items() if name == target}
        if self._figures:
            self._draw(report, elected, of_target)
        return report

    def _draw(
        self,
        report: TargetReport,
        elected: Mapping[str, Sequence[FoldResult]],
        members: Mapping[str, Member],
    ) -> None:
        from snowshed.analysis.regression import figures
        from snowshed.plot.figure_style import save_figure

        target, titles = report.target, self._titles
        values = self._rows.targets[target]
        drawings: dict[str, Optional[Figure]] = {
            "selection.png": figures.selection_figure(elected, titles, target),
            "hyperparameters.png": figures.hyperparameter_figure(
                elected, titles, target, self._rows.names
            ),
            "qq.png": figures.quantile_figure(elected, titles, values, target),
            "predictions.png": figures.prediction_figure(members, titles, self._rows, target),
            "cost.png": figures.cost_figure(report.errors, titles, target),
        }
        for name, figure in drawings.items():
            if figure is not None:
                save_figure(figure, self._folder / target / name)
