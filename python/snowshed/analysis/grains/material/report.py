"""The files of fitted snow: a snow for scenes, the table of ranges, the figure."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from snowshed import _core
from snowshed.analysis.grains.material.fit import FittedSnow
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.scene.components import PROVENANCE

TABLE = "material.csv"


def snow_file(folder: Path, fitted: FittedSnow) -> Path:
    """Return the file of a fitted snow; its name contains the density."""
    return folder / f"snow-{fitted.law.density:.0f}.json"


def write_snow(folder: Path, fitted: FittedSnow, source: Mapping[str, Any]) -> Path:
    """Write a snow that `Snow.load` reads, with its provenance, and return its file.

    Parameters
    ----------
    folder
        The results folder.
    fitted
        The snow.
    source
        Description of the samples and the tests.
    """
    ranges = {name: _finite(asdict(interval)) for name, interval in fitted.ranges.items()}
    data = {
        **{name: _rounded(value) for name, value in fitted.law.snow.to_data().items()},
        PROVENANCE: {
            "made_by": f"snowshed {_core.version} grains material",
            **source,
            "ranges": ranges,
            "steps_over_calibrated": _rounded(fitted.step_count_ratio),
            "strength_lost_after_dilation": _rounded(fitted.law.dilation_at_strength_loss),
            "notes": fitted.notes,
        },
    }
    file = snow_file(folder, fitted)
    write_text(file, json.dumps(data, indent=2) + "\n")
    return file


def write_table(folder: Path, fits: Sequence[FittedSnow]) -> None:
    """Write one row per density and parameter: value, interval, deviation, samples."""
    import pandas as pd

    rows = [
        {"density_kg_m3": fit.law.density, "parameter": name, **asdict(interval)}
        for fit in fits
        for name, interval in fit.ranges.items()
    ]
    write_csv(pd.DataFrame(rows), folder / TABLE)


def _rounded(value: Any) -> Any:
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _finite(values: Mapping[str, float]) -> dict[str, Any]:
    return {
        name: _rounded(value) if math.isfinite(value) else None for name, value in values.items()
    }
