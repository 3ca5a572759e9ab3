"""The quick suite: every case over its quick matrix, and every bar on what was measured."""

import pytest

from snowshed.verify.analysis import bars
from snowshed.verify.measurements import MeasurementFile, to_table
from snowshed.verify.report import Suite, problems
from snowshed.verify.runner import run_suite
from snowshed.verify.suite import case_modules, cases_of


@pytest.mark.parametrize("module", case_modules())
def test_bars_hold(module, tmp_path):
    cases = cases_of(module)
    measurements = run_suite(cases, MeasurementFile(tmp_path / "measurements.jsonl"))
    assert {one.case for one in measurements} == {case.name for case in cases}
    found = bars(to_table(measurements), cases)
    assert not problems(Suite(cases, measurements, full=False), found)
