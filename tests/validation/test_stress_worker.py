"""A worker that crashes, hangs or raises gives a row and is replaced."""

import sys
from pathlib import Path

from validation.stress.space import reference
from validation.stress.worker import worker

ECHO = """
import json, os, sys, time
for line in sys.stdin:
    steps = json.loads(line)["steps"]
    if steps == 1:
        sys.stderr.write("first\\nlast words\\n")
        sys.stderr.flush()
        os.abort()
    if steps == 2:
        time.sleep(60)
    print(json.dumps({"ended": str(steps), "message": ""}), flush=True)
"""


def test_crashes_and_hangs_are_records_and_the_next_run_goes_on(tmp_path: Path) -> None:
    script = tmp_path / "echo.py"
    script.write_text(ECHO)
    with worker(command=[sys.executable, str(script)]) as process:
        assert process.solve({}, 7)["ended"] == "7"
        crash = process.solve({}, 1)
        assert crash == {"ended": "crashed", "message": "exit code -6 last words"}
        assert process.solve({}, 8)["ended"] == "8"
        process.budget_s = 0.5
        assert process.solve({}, 2) == {"ended": "hung", "message": "took more than 0.5 s"}
        process.budget_s = 60.0
        assert process.solve({}, 9)["ended"] == "9"


def test_the_process_answers_with_what_solve_found() -> None:
    with worker() as process:
        record = process.solve({**reference(), "kind": "collide"}, 30)
        assert record["ended"] == "time_limit"
        assert record["finite"] and record["checkpoint"]
        raised = process.solve({"kind": "no such kind"}, 30)
        assert raised["ended"] == "raised"
        assert "KeyError" in raised["message"]
        refused = process.solve({**reference(), "ground_tilt": 45.0, "tilt": 1.0, "cells": 1}, 30)
        assert refused["ended"] == "refused"
        assert refused["message"].startswith("/panel/tilt")
