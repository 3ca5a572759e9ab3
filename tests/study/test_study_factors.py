"""Values of axes and samples against values computed by hand."""

import pytest

from snowshed import InputError, SnowshedNote
from snowshed.cli.options.number_texts import numbers
from snowshed.study import Factor, Span, axis, latin_hypercube, linear, logarithmic, sobol


def test_points_of_a_single_parameter():
    assert axis("snow.cohesion", [0.1, 0.3]).points() == [
        {"snow.cohesion": 0.1},
        {"snow.cohesion": 0.3},
    ]


def test_several_parameters_may_vary_together():
    factor = Factor({"panel.height": [1, 2, 3], "panel.length": [4, 5, 6]})
    assert len(factor) == 3
    assert factor.points()[2] == {"panel.height": 3, "panel.length": 6}


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({}, "names no parameter"),
        ({"panel.tilt": []}, "panel.tilt: 0 values"),
        ({"panel.tilt": [1, 2], "panel.height": [1]}, "panel.tilt has 2, panel.height has 1"),
    ],
)
def test_empty_and_unequal_factors_are_refused(columns, message):
    with pytest.raises(InputError, match=message):
        Factor(columns)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (linear(0.1, 0.3, step=0.1), [0.1, 0.2, 0.3]),
        (linear(0.3, 0.7, step=0.1), [0.3, 0.4, 0.5, 0.6, 0.7]),
        (linear(0, 1, step=0.4), [0, 0.4, 0.8]),
        (linear(40, 70, step=5), [40, 45, 50, 55, 60, 65, 70]),
        (linear(5, 5, step=1), [5]),
        (linear(1, 3, count=5), [1, 1.5, 2, 2.5, 3]),
        (linear(3, 1, count=3), [3, 2, 1]),
        (logarithmic(1e-4, 1e2, 7), [1e-4, 1e-3, 1e-2, 1e-1, 1, 10, 100]),
        (logarithmic(1, 8, 4), [1, 2, 4, 8]),
    ],
)
def test_ranges_have_the_expected_values(values, expected):
    assert values == expected


def test_integers_stay_integers():
    assert all(isinstance(value, int) for value in linear(1, 5, step=2))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: linear(0, 1), "either a step or a count"),
        (lambda: linear(0, 1, step=0.1, count=3), "either a step or a count"),
        (lambda: linear(0, 1, step=0), "step 0 is not positive"),
        (lambda: linear(0, 1, step=-1), "step -1 is not positive"),
        (lambda: linear(1, 0, step=1), "is below the start"),
        (lambda: linear(0, float("nan"), step=1), "nan is not a finite number"),
        (lambda: linear(0, 1, step=1e-9), "at most"),
        (lambda: linear(-(10**308), 10**308, step=1e-3), "at most"),
        (lambda: linear(0, 1, count=1), "count 1 is outside"),
        (lambda: logarithmic(0, 1, 3), "0 is not positive"),
        (lambda: Span(1, 1), "is not above the lower end"),
        (lambda: Span(-1, 1, "log"), "-1 is not positive"),
        (lambda: Span(0, 1, "cubic"), "'cubic' is none of linear, log"),
        (lambda: sobol({"panel.tilt": Span(0, 1)}, 12), "12 is not a power of two"),
        (lambda: latin_hypercube({"panel.tilt": Span(0, 1)}, 0), "count 0 is outside"),
        (lambda: latin_hypercube({}, 4), "names no parameter"),
    ],
)
def test_wrong_numbers_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_a_latin_hypercube_uses_every_slice_once():
    sample = latin_hypercube({"a": Span(10, 20), "b": Span(1, 1024, "log")}, 10)
    assert sorted(int(value - 10) for value in sample.columns["a"]) == list(range(10))
    assert sorted(len(bin(int(value))) - 3 for value in sample.columns["b"]) == list(range(10))


def test_sobol_points_fill_every_elementary_box():
    sample = sobol({"a": Span(0, 4), "b": Span(0, 4)}, 16)
    boxes = {(int(point["a"]), int(point["b"])) for point in sample.points()}
    assert len(boxes) == 16


def test_a_seed_determines_the_sample():
    spans = {"a": Span(0, 1)}
    for method in (latin_hypercube, sobol):
        assert method(spans, 8, seed=3) == method(spans, 8, seed=3)
        assert method(spans, 8, seed=3) != method(spans, 8, seed=4)


def test_a_range_that_misses_its_end_is_noted(recwarn):
    linear(40, 60, step=10)
    linear(0.1, 0.3, step=0.1)
    assert not recwarn
    with pytest.warns(SnowshedNote, match="from 40 to 60 in steps of 15 ends at 55"):
        assert linear(40, 60, step=15) == [40, 55]
    with pytest.warns(SnowshedNote, match="--heights: 1:2:0.3 ends at 1.9"):
        numbers("--heights", "1:2:0.3", example="1,2", steps=True)
