"""One outer fold of one kind of model for one target: the unit of work."""

from __future__ import annotations

import time
from dataclasses import dataclass

from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.kinds import kinds
from snowshed.analysis.regression.rows import StackRows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.analysis.regression.score import median_absolute_error


@dataclass(frozen=True)
class FoldTask:
    """An outer fold of a kind of model for a target; `round` and `fold` count from 0."""

    target: str
    kind: str
    round: int
    fold: int

    @property
    def file(self) -> str:
        """Path of its result in the results folder."""
        return f"folds/{self.target}/{self.kind}/{self.round:03}-{self.fold:03}.npz"


def compute(task: FoldTask, rows: StackRows, scheme: CrossValidation) -> FoldResult:
    """Choose, train and score a model as section 5.2.3 says; train it again on all rows (5.2.4).

    Inputs and target are standardised over all rows, (5.2.12). Scores are in the target's unit.
    """
    inputs = Scaling.of(rows.inputs).scaled(rows.inputs)
    values = rows.targets[task.target]
    scaling = Scaling.of(values[:, None])
    targets = scaling.scaled(values[:, None])[:, 0]
    unit, offset = float(scaling.deviation[0]), float(scaling.mean[0])
    groups = scheme.groups(rows)
    outer = list(scheme.outer(task.round).split(inputs, groups=groups))
    development, validation = outer[task.fold]
    kind = kinds()[task.kind]

    start = time.process_time()
    search = kind.searcher(scheme.inner(task.round, task.fold))
    search.fit(inputs[development], targets[development], groups=groups[development])
    elapsed = time.process_time() - start

    predictions = search.best_estimator_.predict(inputs)
    errors = (predictions - targets) * unit
    final = kind.estimator(search.best_params_).fit(inputs, targets)
    return FoldResult(
        search.best_params_,
        -search.best_score_ * unit,
        median_absolute_error(errors[development]),
        median_absolute_error(errors[validation]),
        search.n_fits_ + 1,
        elapsed,
        validation,
        predictions[validation] * unit + offset,
        final.predict(inputs) * unit + offset,
        kind.expansion(final),
    )
