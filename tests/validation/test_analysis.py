"""Analysis of made-up tables with known answers."""

from dataclasses import replace
from math import inf, isnan, nan

import numpy as np
import pytest
from made_up import made_up_case
from validation.framework.case import Quantity
from validation.framework.cheapest import by_problem, cheapest, pareto_front
from validation.framework.convergence import convergences, observed_order, pairwise_orders
from validation.framework.criteria import compare
from validation.framework.schemes import varying
from validation.framework.sections import settings_text

from snowshed.analysis.accuracy.measurements import Measured, MeasuredSolution, to_table
from snowshed.analysis.accuracy.solutions import (
    Solution,
    assured_errors,
    quickest,
    rows_of,
    solutions,
)


def table_of(*results, quantity="height"):
    """Return a table with one measurement for each (settings, error, time)."""
    return to_table(
        MeasuredSolution("made_up", settings, [Measured(quantity, error, 0.0, error)], wall_s=wall)
        for settings, error, wall in results
    )


def case_with(**facts):
    return made_up_case(quantities=[Quantity("height", "height, m", **facts)])


def solution(error, **settings):
    return Solution(settings, error, wall_s=1.0)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 3.7])
def test_power_laws_have_their_order(order):
    sizes = np.array([0.4, 0.3, 0.1, 0.02])
    errors = -7.0 * sizes**order
    assert observed_order(sizes, errors) == pytest.approx(order)
    assert pairwise_orders(sizes, errors) == pytest.approx([order] * 3)


def test_the_order_is_the_least_squares_slope():
    # Logarithms (base 2) 2, 1, 0 and 3, 3, 0: the slope of the best line is 3/2.
    sizes, errors = np.array([4.0, 2.0, 1.0]), np.array([8.0, 8.0, 1.0])
    assert observed_order(sizes, errors) == pytest.approx(1.5)
    assert pairwise_orders(sizes, errors) == pytest.approx([0.0, 3.0])


def test_there_is_no_order_where_an_error_is_zero_or_sizes_are_equal():
    assert isnan(observed_order(np.array([0.2, 0.1]), np.array([0.1, 0.0])))
    assert isnan(observed_order(np.array([0.2, 0.2]), np.array([0.1, 0.2])))
    assert isnan(observed_order(np.array([0.2, 0.1]), np.array([0.1, nan])))


def test_series_converge_on_their_own_from_the_coarsest():
    found = [
        solution(0.01, dx=0.1, basis="cubic"),
        solution(0.2, dx=0.2, basis="quadratic"),
        solution(0.04, dx=0.2, basis="cubic"),
        solution(0.1, dx=0.1, basis="quadratic"),
        solution(0.3, dx=0.1, basis="linear"),
        solution(0.3, basis="linear"),
    ]
    cubic, quadratic = convergences(found, "dx")
    assert cubic.settings == {"basis": "cubic"}
    assert cubic.sizes.tolist() == [0.2, 0.1]
    assert cubic.order == pytest.approx(2.0)
    assert quadratic.order == pytest.approx(1.0)


def test_seedings_are_taken_together():
    table = table_of(
        ({"dx": 0.1, "seed": 1}, 0.03, 1.0),
        ({"dx": 0.1, "seed": 2}, -0.04, 2.0),
        ({"dx": 0.1, "seed": 3}, nan, 0.0),  # failed
        ({"dx": 0.2, "seed": 1}, 0.5, 1.0),
    )
    both, single = solutions(rows_of(table, "made_up", "height"))
    assert both.settings == {"dx": 0.1}
    assert both.error == pytest.approx(np.sqrt((0.0009 + 0.0016) / 2))
    assert both.wall_s == 1.5
    assert single.error == 0.5


def test_only_what_differs_varies():
    settings = [{"dx": 0.1, "basis": "cubic"}, {"dx": 0.1, "seed": 1, "basis": "quadratic"}]
    assert varying(settings) == ["basis", "seed"]
    assert varying(settings[:1]) == varying([]) == []


def test_a_lucky_coarse_solution_assures_nothing():
    found = [
        solution(0.001, dx=0.4),
        solution(-0.2, dx=0.2),
        solution(0.05, dx=0.1),
        solution(0.002, dx=0.4, basis="cubic"),
    ]
    assert assured_errors(found, "dx") == [0.2, 0.2, 0.05, 0.002]
    assert assured_errors(found, None) == [0.001, 0.2, 0.05, 0.002]
    assert assured_errors(found, "step_factor") == [0.001, 0.2, 0.05, 0.002]


def test_the_pareto_front_is_what_a_plain_search_finds():
    rng = np.random.default_rng(1)
    costs, errors = rng.integers(1, 9, 60).astype(float), rng.integers(1, 9, 60).astype(float)
    front = pareto_front(costs, errors)
    points = list(zip(costs, errors))
    for point, on_it in zip(points, front):
        beaten = any(
            other[0] <= point[0] and other[1] <= point[1] and other != point for other in points
        )
        assert not (on_it and beaten)
        assert on_it or beaten or points.count(point) > 1
    assert len(set(np.array(points)[front][:, 0])) == front.sum()
    assert not pareto_front([], []).size


def test_the_quickest_is_accurate_enough_or_else_the_most_accurate():
    costs, errors = [4.0, 1.0, 2.0, 3.0], [0.01, 0.2, 0.04, 0.01]
    assert [quickest(costs, errors, wanted) for wanted in (0.5, 0.1, 0.01, 0.001)] == [1, 2, 3, 3]


def test_cheapest_settings_for_each_accuracy():
    table = table_of(
        ({"dx": 0.4}, 0.004, 1.0),  # small by chance, because the next error is larger
        ({"dx": 0.2}, 0.04, 8.0),
        ({"dx": 0.1}, 0.015, 64.0),
    )
    answers = cheapest(table, [case_with(order_in="dx")])
    assert [one.wanted for one in answers] == [0.10, 0.05, 0.02, 0.01]
    assert [one.solution.settings["dx"] for one in answers] == [0.4, 0.4, 0.1, 0.1]
    assert [one.reached for one in answers] == [True, True, True, False]
    assert answers[0].error == 0.04
    assert answers[-1].error == 0.015
    assert cheapest(table, [case_with(relative=False)]) == []
    failed = table_of(({"dx": 0.1}, nan, 0.0), ({"dx": 0.2}, nan, 0.0))
    assert cheapest(failed, [case_with()]) == []


def test_an_easier_problem_buys_no_accuracy():
    table = table_of(
        ({"dx": 0.2, "friction": 0.0}, 0.001, 1.0),
        ({"dx": 0.2, "friction": 0.6}, 0.3, 1.0),
        ({"dx": 0.1, "friction": 0.6}, 0.04, 8.0),
        ({"dx": 0.1, "friction": 0.8, "seed": 1}, 0.04, 8.0),
        ({"dx": 0.1, "friction": 0.8, "seed": 2}, 0.04, 8.0),
    )
    case = case_with(order_in="dx")
    found = by_problem(case, solutions(rows_of(table, "made_up", "height")))
    assert [(problem, len(ways)) for problem, ways in found] == [
        *(({"friction": 0.0}, 1), ({"friction": 0.6}, 2), ({"friction": 0.8}, 1))
    ]
    answers = cheapest(table, [case], wanted=[0.05])  # problems with several solutions
    assert [(one.problem, one.solution.settings["dx"]) for one in answers] == [
        ({"friction": 0.6}, 0.1)
    ]


def test_a_criterion_holds_if_the_worst_it_is_for_is_small_enough():
    table = table_of(
        ({"dx": 0.1, "transfer": "apic", "seed": 1}, -0.04, 1.0),
        ({"dx": 0.1, "transfer": "apic", "seed": 2}, 0.01, 1.0),
        ({"dx": 0.1, "transfer": "pic"}, 0.5, 1.0),
        ({"dx": 0.2, "transfer": "apic"}, 0.5, 1.0),
    )
    applies_to = {"dx": 0.1, "transfer": "apic"}
    (criterion,) = compare(table, [case_with(limit=0.05, limit_for=applies_to)])
    assert (criterion.kind, criterion.demanded, criterion.worst, criterion.count) == (
        "error",
        0.05,
        0.04,
        2,
    )
    assert criterion.settings == {"dx": 0.1, "transfer": "apic", "seed": 1}
    assert criterion.holds is True
    (strict,) = compare(table, [case_with(limit=0.03, limit_for=applies_to)])
    assert strict.holds is False
    (other,) = compare(table, [case_with(limit=0.03, limit_for={"basis": "cubic"})])
    assert (other.holds, other.worst, other.count) == (None, None, 0)


def test_a_criterion_may_be_for_several_values_of_a_setting():
    flip, apic, none = {"transfer": "flip"}, {"transfer": "apic"}, {"scheme": "objective"}
    table = table_of((flip, 0.01, 1.0), (apic, 0.5, 1.0), (none, 0.02, 1.0))
    (criterion,) = compare(table, [case_with(limit=0.1, limit_for={"transfer": ("flip", None)})])
    assert (criterion.holds, criterion.count, criterion.worst) == (True, 2, 0.02)
    assert settings_text(criterion) == "flip or transfer default"


@pytest.mark.parametrize("error", [nan, inf])
def test_a_failed_measurement_holds_no_criterion(error):
    table = table_of(({"dx": 0.2}, 0.04, 1.0), ({"dx": 0.1}, error, 0.0), ({"dx": 0.4}, 0.1, 1.0))
    facts = {"limit": 9.0, "order_in": "dx", "min_order": 0.1}
    assert [criterion.holds for criterion in compare(table, [case_with(**facts)])] == [False, False]


def test_every_series_must_converge_fast_enough():
    table = table_of(
        *(({"dx": dx, "transfer": "apic"}, dx**2, 1.0) for dx in (0.4, 0.2, 0.1)),
        *(({"dx": dx, "transfer": "pic"}, dx, 1.0) for dx in (0.4, 0.2, 0.1)),
        ({"dx": 0.4, "transfer": "flip"}, 0.1, 1.0),
    )
    facts = {"order_in": "dx", "min_order": 1.8}
    (criterion,) = compare(table, [case_with(**facts)])
    assert (criterion.kind, criterion.worst, criterion.count) == ("order", pytest.approx(1.0), 2)
    assert criterion.settings == {"transfer": "pic"}
    assert criterion.holds is False
    # A criterion for the error on the finest grid does not restrict the order to that grid.
    applies_to = {"dx": 0.1, "transfer": "apic"}
    error, order = compare(table, [case_with(limit=0.02, limit_for=applies_to, **facts)])
    assert error.holds and order.holds
    assert order.applies_to == {"transfer": "apic"}
    (one_size,) = compare(table, [case_with(limit_for={"transfer": "flip"}, **facts)])
    assert one_size.holds is None


def test_cases_and_quantities_are_kept_apart():
    table = to_table(
        [
            MeasuredSolution("made_up", {"dx": 0.1}, [Measured("height", 1.0, 1.0, 0.0)]),
            MeasuredSolution("made_up", {"dx": 0.1}, [Measured("width", 1.0, 1.0, 0.5)]),
            MeasuredSolution("other", {"dx": 0.1}, [Measured("height", 1.0, 1.0, 0.5)]),
        ]
    )
    case = case_with(limit=0.1)
    assert [criterion.holds for criterion in compare(table, [case])] == [True]
    assert [criterion.holds for criterion in compare(table, [replace(case, name="other")])] == [
        False
    ]
