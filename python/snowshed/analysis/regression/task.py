"""One outer fold of one kind of model for one target: the unit of work."""

from __future__ import annotations

import time
from dataclasses import dataclass

from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.folds import CrossValidation
from snowshed.analysis.regression.kernels import Expansion
from snowshed.analysis.regression.kinds import Development, kinds, median_absolute_error
from snowshed.analysis.regression.rows import StackRows
from snowshed.analysis.regression.scaling import Scaling


@dataclass(frozen=True)
class Task:
    """Which fold of what; `round` and `fold` count from 0."""

    target: str
    kind: str
    round: int
    fold: int

    @property
    def file(self) -> str:
        """Where its result lies in the results folder."""
        return f"folds/{self.target}/{self.kind}/{self.round:03}-{self.fold:03}.npz"


def compute(task: Task, rows: StackRows, scheme: CrossValidation) -> FoldResult:
    """Choose, train and score a model as section 5.2.3 says; train it anew on all rows (5.2.4).

    Inputs and target are standardised over all rows, (5.2.12). Scores are in the target's unit.
    """
    inputs = Scaling.of(rows.inputs).scaled(rows.inputs)
    values = rows.targets[task.target]
    scaling = Scaling.of(values[:, None])
    targets = scaling.scaled(values[:, None])[:, 0]
    unit, offset = float(scaling.deviation[0]), float(scaling.mean[0])
    development, validation = scheme.outer(rows, task.round)[task.fold]
    splits = scheme.inner(rows, development, task.round, task.fold)
    kind = kinds()[task.kind]

    start = time.process_time()
    choice = kind.search(Development(inputs, targets, development, splits))
    model = kind.fit(choice.parameters, inputs[development], targets[development])
    elapsed = time.process_time() - start

    found = model.predict(inputs)
    errors = (found - targets) * unit
    final = kind.fit(choice.parameters, inputs, targets)
    return FoldResult(
        choice.parameters,
        choice.score * unit,
        median_absolute_error(errors[development]),
        median_absolute_error(errors[validation]),
        choice.fits + 1,
        elapsed,
        validation,
        found[validation] * unit + offset,
        final.predict(inputs) * unit + offset,
        final if isinstance(final, Expansion) else None,
    )
