"""A run that crashes, hangs or raises gives a record, and the next run starts."""

import os
import sys
import time
from pathlib import Path

from validation.stress import process
from validation.stress.process import ProcessRun, record, stress_pool
from validation.stress.space import reference


def faulty_compute(run, report):
    """Stand in for `process.compute`; `steps` selects the failure."""
    if run.steps == 1:
        sys.stderr.write("first\nlast words\n")
        sys.stderr.flush()
        os.abort()
    if run.steps == 2:
        time.sleep(600)
    return {"ended": str(run.steps), "message": os.environ["OMP_NUM_THREADS"]}


def test_crashes_and_hangs_are_recorded_and_the_next_run_starts(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    monkeypatch.setattr(process, "compute", faulty_compute)
    with stress_pool(limit_s=10.0) as pool:
        assert record(pool, ProcessRun({}, 7)) == {"ended": "7", "message": "1"}
        crash = record(pool, ProcessRun({}, 1))
        assert crash["ended"] == "crashed"
        assert crash["message"] == "was killed by signal 6 (Aborted) last words"
        assert record(pool, ProcessRun({}, 8))["ended"] == "8"
        assert record(pool, ProcessRun({}, 2)) == {
            "ended": "hung",
            "message": "took more than 10 s",
        }
        assert record(pool, ProcessRun({}, 9))["ended"] == "9"


def test_the_record_has_the_result_of_solve():
    with stress_pool() as pool:
        solved = record(pool, ProcessRun({**reference(), "kind": "collide"}, 30))
        assert solved["ended"] == "time_limit"
        assert solved["finite"] and solved["checkpoint"]
        raised = record(pool, ProcessRun({"kind": "no such kind"}, 30))
        assert raised["ended"] == "raised"
        assert "KeyError" in raised["message"]
        refused = record(
            pool, ProcessRun({**reference(), "ground_tilt": 45.0, "tilt": 1.0, "cells": 1}, 30)
        )
        assert refused["ended"] == "refused"
        assert refused["message"].startswith("/panel/tilt")
