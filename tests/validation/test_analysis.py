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

from snowshed.snow.accuracy.measurements import Measured, MeasuredSolution, to_table
from snowshed.snow.accuracy.solutions import (
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


def test_zero_errors_and_equal_sizes_give_no_order():
    assert isnan(observed_order(np.array([0.2, 0.1]), np.array([0.1, 0.0])))
    assert isnan(observed_order(np.array([0.2, 0.2]), np.array([0.1, 0.2])))
    assert isnan(observed_order(np.array([0.2, 0.1]), np.array([0.1, nan])))


def test_each_series_has_its_order_from_coarse_to_fine():
    results = [
        solution(0.01, dx=0.1, basis="cubic"),
        solution(0.2, dx=0.2, basis="quadratic"),
        solution(0.04, dx=0.2, basis="cubic"),
        solution(0.1, dx=0.1, basis="quadratic"),
        solution(0.3, dx=0.1, basis="linear"),
        solution(0.3, basis="linear"),
    ]
    cubic, quadratic = convergences(results, "dx")
    assert cubic.settings == {"basis": "cubic"}
    assert cubic.sizes.tolist() == [0.2, 0.1]
    assert cubic.order == pytest.approx(2.0)
    assert quadratic.order == pytest.approx(1.0)


def test_seedings_are_averaged():
    table = table_of(
        ({"dx": 0.1, "seed": 1}, 0.03, 1.0),
        ({"dx": 0.1, "seed": 2}, -0.04, 2.0),
        ({"dx": 0.1, "seed": 3}, nan, 0.0),  # failed
        ({"dx": 0.2, "seed": 1}, 0.5, 1.0),
    )
    averaged, single = solutions(rows_of(table, "made_up", "height"))
    assert averaged.settings == {"dx": 0.1}
    assert averaged.error == pytest.approx(np.sqrt((0.0009 + 0.0016) / 2))
    assert averaged.wall_s == 1.5
    assert single.error == 0.5


def test_only_differing_settings_vary():
    settings = [{"dx": 0.1, "basis": "cubic"}, {"dx": 0.1, "seed": 1, "basis": "quadratic"}]
    assert varying(settings) == ["basis", "seed"]
    assert varying(settings[:1]) == varying([]) == []


def test_a_lucky_coarse_solution_assures_no_accuracy():
    results = [
        solution(0.001, dx=0.4),
        solution(-0.2, dx=0.2),
        solution(0.05, dx=0.1),
        solution(0.002, dx=0.4, basis="cubic"),
    ]
    assert assured_errors(results, "dx") == [0.2, 0.2, 0.05, 0.002]
    assert assured_errors(results, None) == [0.001, 0.2, 0.05, 0.002]
    assert assured_errors(results, "step_factor") == [0.001, 0.2, 0.05, 0.002]


def test_the_pareto_front_agrees_with_a_plain_search():
    rng = np.random.default_rng(1)
    costs, errors = rng.integers(1, 9, 60).astype(float), rng.integers(1, 9, 60).astype(float)
    front = pareto_front(costs, errors)
    points = list(zip(costs, errors))
    for point, on_front in zip(points, front):
        dominated = any(
            rival[0] <= point[0] and rival[1] <= point[1] and rival != point for rival in points
        )
        assert not (on_front and dominated)
        assert on_front or dominated or points.count(point) > 1
    assert len(set(np.array(points)[front][:, 0])) == front.sum()
    assert not pareto_front([], []).size


def test_the_quickest_accurate_solution_is_chosen_or_else_the_most_accurate():
    costs, errors = [4.0, 1.0, 2.0, 3.0], [0.01, 0.2, 0.04, 0.01]
    assert [quickest(costs, errors, accuracy) for accuracy in (0.5, 0.1, 0.01, 0.001)] == [
        1,
        2,
        3,
        3,
    ]


def test_the_cheapest_settings_are_given_for_each_accuracy():
    table = table_of(
        ({"dx": 0.4}, 0.004, 1.0),  # small by chance, because the next error is larger
        ({"dx": 0.2}, 0.04, 8.0),
        ({"dx": 0.1}, 0.015, 64.0),
    )
    answers = cheapest(table, [case_with(order_in="dx")])
    assert [answer.wanted for answer in answers] == [0.10, 0.05, 0.02, 0.01]
    assert [answer.solution.settings["dx"] for answer in answers] == [0.4, 0.4, 0.1, 0.1]
    assert [answer.reached for answer in answers] == [True, True, True, False]
    assert answers[0].error == 0.04
    assert answers[-1].error == 0.015
    assert cheapest(table, [case_with(relative=False)]) == []
    failed = table_of(({"dx": 0.1}, nan, 0.0), ({"dx": 0.2}, nan, 0.0))
    assert cheapest(failed, [case_with()]) == []


def test_easier_problems_do_not_count_for_harder_ones():
    table = table_of(
        ({"dx": 0.2, "friction": 0.0}, 0.001, 1.0),
        ({"dx": 0.2, "friction": 0.6}, 0.3, 1.0),
        ({"dx": 0.1, "friction": 0.6}, 0.04, 8.0),
        ({"dx": 0.1, "friction": 0.8, "seed": 1}, 0.04, 8.0),
        ({"dx": 0.1, "friction": 0.8, "seed": 2}, 0.04, 8.0),
    )
    case = case_with(order_in="dx")
    problems = by_problem(case, solutions(rows_of(table, "made_up", "height")))
    assert [(problem, len(entries)) for problem, entries in problems] == [
        *(({"friction": 0.0}, 1), ({"friction": 0.6}, 2), ({"friction": 0.8}, 1))
    ]
    answers = cheapest(table, [case], wanted=[0.05])  # problems with several solutions
    assert [(answer.problem, answer.solution.settings["dx"]) for answer in answers] == [
        ({"friction": 0.6}, 0.1)
    ]


def test_a_criterion_holds_if_its_worst_error_is_within_the_limit():
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
    (unmeasured,) = compare(table, [case_with(limit=0.03, limit_for={"basis": "cubic"})])
    assert (unmeasured.holds, unmeasured.worst, unmeasured.count) == (None, None, 0)


def test_a_criterion_may_apply_to_several_values_of_a_setting():
    flip, apic, default = {"transfer": "flip"}, {"transfer": "apic"}, {"scheme": "objective"}
    table = table_of((flip, 0.01, 1.0), (apic, 0.5, 1.0), (default, 0.02, 1.0))
    (criterion,) = compare(table, [case_with(limit=0.1, limit_for={"transfer": ("flip", None)})])
    assert (criterion.holds, criterion.count, criterion.worst) == (True, 2, 0.02)
    assert settings_text(criterion) == "flip or transfer default"


@pytest.mark.parametrize("error", [nan, inf])
def test_a_failed_measurement_meets_no_criterion(error):
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


def test_cases_and_quantities_are_separate():
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
