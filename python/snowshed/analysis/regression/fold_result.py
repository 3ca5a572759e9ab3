"""The result of one outer fold, and its file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.kernels import Expansion
from snowshed.base.arrays import Floats, Integers
from snowshed.base.damage import DAMAGED
from snowshed.io.array_archive import open_archive
from snowshed.io.atomic import replacing
from snowshed.io.input_file import read_regular

NUMBERS = ("inner_score", "development_score", "validation_score", "fits", "elapsed_s")
ARRAYS = ("validation", "held_out", "predictions")


@dataclass(frozen=True)
class FoldResult:
    """The model that one outer fold elected.

    Attributes
    ----------
    parameters
        Its hyper-parameters.
    inner_score, development_score, validation_score
        Median absolute errors in the target's unit: mean over the inner folds of the search; of
        the elected model on the rows it was trained on; and on those it never saw.
    fits, elapsed_s
        Models fitted, and the processor time of search and training, s.
    validation, held_out
        Held-out rows, and the predictions for them, in the target's unit: shape (v,).
    predictions
        Predictions for all rows after training on all of them (5.2.4), shape (n,).
    expansion
        The model that was trained on all rows; None if it is not a sum of kernels.
    """

    parameters: Mapping[str, float]
    inner_score: float
    development_score: float
    validation_score: float
    fits: int
    elapsed_s: float
    validation: Integers
    held_out: Floats
    predictions: Floats
    expansion: Optional[Expansion]

    def save(self, path: Path) -> None:
        """Write the result; the file appears whole or not at all."""
        facts = {name: getattr(self, name) for name in NUMBERS}
        arrays: dict[str, Any] = {name: getattr(self, name) for name in ARRAYS}
        if self.expansion is not None:
            arrays["coefficients"] = self.expansion.coefficients
            arrays["intercept"] = np.array(self.expansion.intercept)
            arrays["rates"] = self.expansion.rates
        path.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps({**facts, "parameters": dict(self.parameters)})
        with replacing(path) as beside:
            np.savez(beside, facts=np.array(text), **arrays)

    @classmethod
    def load(cls, path: Path, points: Floats) -> Optional[FoldResult]:
        """Read a result; None if it is missing, or cannot be read.

        Parameters
        ----------
        path
            Its file.
        points
            The standardised inputs of all rows.
        """
        try:
            with open_archive(read_regular(path)) as data:
                facts = json.loads(str(data["facts"]))
                expansion = None
                if "coefficients" in data:
                    intercept = float(data["intercept"])
                    expansion = Expansion(points, data["coefficients"], intercept, data["rates"])
                return cls(
                    **facts,
                    **{name: data[name] for name in ARRAYS},
                    expansion=expansion,
                )
        except (InputError, OSError, *DAMAGED):
            return None  # it is computed again
