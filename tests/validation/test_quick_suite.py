"""The quick suite: every case over its quick matrix, and every bar on what was measured."""

import pytest
from validation.bars import compare
from validation.measurement_file import MeasurementFile
from validation.report import Suite, problems
from validation.runner import run_suite
from validation.suite import case_modules, cases_of

from snowshed.analysis.accuracy.measurements import to_table


@pytest.mark.parametrize("module", case_modules())
def test_bars_hold(module, tmp_path):
    cases = cases_of(module)
    measurements = run_suite(cases, MeasurementFile(tmp_path / "measurements.jsonl"))
    assert {one.case for one in measurements} == {case.name for case in cases}
    found = compare(to_table(measurements), cases)
    assert not problems(Suite(cases, measurements, full=False), found)
