"""Keep what a benchmark has measured, with its machine and date."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

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
