"""The quick suite: every case over its quick matrix, and every criterion that it measures."""

import pytest
from validation.framework.cases import case_modules, cases_of
from validation.framework.criteria import compare
from validation.framework.measure import measure_cases
from validation.framework.measurement_file import MeasurementFile
from validation.framework.report import Validation, problems

from snowshed.snow.accuracy.measurements import to_table

MODULES = case_modules()
#: The slowest modules. Faster tests, here in `test_case_*.py` or in C++, cover the same code.
SLOW_MODULES = {
    "elastic_vibration",
    "laboratory_between_events",
    "manufactured",
    "material_paths",
    "mps_channel",
    "mps_snow",
    "slide_extremes",
}


def modules():
    """Return the modules as parameters; `make test-slow` runs the long ones."""
    return [
        pytest.param(module, id=name, marks=[pytest.mark.slow] if name in SLOW_MODULES else [])
        for name, module in MODULES.items()
    ]


def test_modules_are_found():
    assert len(MODULES) > 20 and len(set(MODULES.values())) == len(MODULES)


@pytest.mark.parametrize("module", modules())
def test_criteria_hold(module, tmp_path):
    cases = cases_of(module)
    measurements = measure_cases(cases, MeasurementFile(tmp_path / "measurements.jsonl"))
    assert {measurement.case for measurement in measurements} == {case.name for case in cases}
    criteria = compare(to_table(measurements), cases)
    assert not problems(Validation(cases, measurements, full=False), criteria)
