"""Files with the results of benchmarks, their machine and date."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from snowshed.base.machine import cpu_name

RESULTS = Path(__file__).parent / "results"


def keep_cases(cases: Sequence[Mapping[str, object]], kind: str = "") -> str:
    """Write benchmarks/results/DATE-kind.json, or DATE.json; return the date."""
    date = datetime.date.today().isoformat()
    record = {"date": date, "cpu": cpu_name(), "cases": cases}
    RESULTS.mkdir(exist_ok=True)
    file = RESULTS / f"{date}{'-' if kind else ''}{kind}.json"
    file.write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
    return date


def append_rows(rows: pd.DataFrame, file: Path) -> None:
    """Append rows to a CSV file, with the machine and the date."""
    rows = rows.assign(machine=cpu_name(), date=datetime.date.today().isoformat())
    if file.exists():
        rows = pd.concat([pd.read_csv(file), rows], ignore_index=True)
    rows.to_csv(file, index=False, float_format="%.6g")
