"""Required heights: intervals cover the truth, and unknowns of two kinds are kept apart."""

import numpy as np
import pytest

from snowshed.analysis.clearance.common_effects import common_effects
from snowshed.analysis.clearance.extreme_values import ExtremeValues, standard_quantile
from snowshed.analysis.clearance.statistics import PROBABILITIES, RequiredHeights

#: Location and scale of the true heights, m.
LOCATION, SCALE = 2.0, 0.4


def winters_of(shape, count, random):
    """Return the heights of winters whose distribution has a shape."""
    quantiles = [standard_quantile(p, np.array(shape)) for p in random.random(count)]
    return LOCATION + SCALE * np.array(quantiles, float)


def true_heights(shape):
    return np.array(
        [LOCATION + SCALE * float(standard_quantile(p, np.array(shape))) for p in PROBABILITIES]
    )


def coverage(shape, count, repetitions, seed=1, confidence=0.9):
    """Return the share of samples whose interval contains the true height, by probability."""
    random = np.random.default_rng(seed)
    truth, inside = true_heights(shape), np.zeros(len(PROBABILITIES))
    tail = 0.5 * (1.0 - confidence)
    for _ in range(repetitions):
        sample = ExtremeValues.of_maxima(winters_of(shape, count, random), 1000, random)
        heights = np.array([sample.quantile(probability) for probability in PROBABILITIES])
        low, high = np.quantile(heights, [tail, 1.0 - tail], axis=1)
        inside += (low <= truth) & (truth <= high)
    return inside / repetitions


@pytest.mark.parametrize(("winters", "shape"), [(5, 0.2), (10, -0.2), (30, 0.0)])
def test_intervals_of_winters_contain_the_truth_as_often_as_they_say(winters, shape):
    assert coverage(shape, winters, 250) == pytest.approx(0.905, abs=0.07)


@pytest.mark.slow
@pytest.mark.parametrize("winters", [3, 5, 10, 20, 30])
@pytest.mark.parametrize("shape", [-0.2, -0.1, 0.0, 0.1, 0.2])
def test_coverage_holds_for_every_shape_and_number_of_winters(winters, shape):
    confidence = 0.9 if winters >= 5 else 0.95
    shares = coverage(shape, winters, 2000, confidence=confidence)
    print(f"{winters} winters, shape {shape:+.1f}: " + ", ".join(f"{s:.1%}" for s in shares))
    noise = 0.01  # 1.5 standard errors
    assert (shares >= (0.86 if winters >= 5 else 0.9) - noise).all()
    assert (shares <= (0.95 if winters >= 5 else 1.0) + noise).all()


def seasons_with_a_common_factor(winters, draws, effect, random):
    """Return heights of seasons, their winters and positions, and the factor of the true panel."""
    count = winters * draws
    position = (random.permutation(count) + random.random(count)) / count - 0.5
    numbers = np.repeat(np.arange(winters), draws)
    chance = 1.0 + 0.03 * random.normal(size=count)
    heights = winters_of(0.0, winters, random)[numbers] * np.exp(effect * position) * chance
    return heights, numbers, {"adhesion": position}, np.exp(effect * (random.random() - 0.5))


def covered_with_a_common_factor(repetitions, winters=10, effect=0.6):
    random, truth = np.random.default_rng(2), true_heights(0.0)[1]
    inside = 0
    for _ in range(repetitions):
        *seasons, factor = seasons_with_a_common_factor(winters, 3, effect, random)
        level = RequiredHeights(*seasons).levels[1]
        inside += level.low <= truth * factor <= level.high
    return inside / repetitions


def test_intervals_contain_what_is_unknown_but_the_same_in_every_winter():
    assert 0.8 <= covered_with_a_common_factor(50) <= 0.98


@pytest.mark.slow
def test_coverage_with_a_common_factor():
    assert 0.85 <= covered_with_a_common_factor(1000) <= 0.96


def test_an_unknown_common_factor_widens_the_interval_of_many_winters():
    """Averaged over winters, the factor would vanish."""
    random = np.random.default_rng(3)
    *seasons, _ = seasons_with_a_common_factor(200, 3, 0.6, random)
    uncertain = RequiredHeights(*seasons)
    level = uncertain.levels[1]
    assert np.log(level.high / level.low) > 0.9 * 0.6
    largest = uncertain.shares[0]
    assert largest.cause == "adhesion" and largest.part > 0.8
    assert largest.high - largest.low < 0.5 * (level.high - level.low)


def test_effects_are_those_that_made_the_heights():
    random = np.random.default_rng(4)
    numbers = np.repeat(np.arange(8), 4)
    positions = {name: random.random(32) - 0.5 for name in ("adhesion", "friction")}
    factor = np.exp(0.3 * positions["adhesion"] - 0.1 * positions["friction"])
    effects = common_effects((1.0 + 0.2 * numbers) * factor, numbers, positions)
    assert effects.names == ("adhesion", "friction")
    assert effects.slopes == pytest.approx([0.3, -0.1], abs=1e-6)
    assert effects.factor(positions) == pytest.approx(factor)


def test_too_few_seasons_leave_the_parameters_with_the_winters():
    heights, numbers = np.array([1.0, 1.2, 1.5]), np.arange(3)
    result = RequiredHeights(heights, numbers, {"adhesion": np.array([-0.3, 0.0, 0.4])})
    assert not result.separable and result.shares == []
    one_season = RequiredHeights(heights[:1], numbers[:1], {"adhesion": np.array([0.2])})
    assert not one_season.separable


def test_seasons_of_a_scenario_keep_the_spread_of_their_parameters():
    draws = np.array([1.0, 2.0, 3.0])
    result = RequiredHeights(draws, np.zeros(3), {"adhesion": np.array([-0.3, 0.0, 0.3])})
    assert result.highest == (2.0, 1.0, 3.0)
    assert [share.cause for share in result.shares] == ["chance"]


def test_burial_and_height_agree():
    random = np.random.default_rng(5)
    result = RequiredHeights(winters_of(0.0, 20, random), np.arange(20), {}, 0.1)
    for level in result.levels:
        buried, low, high = result.burial(level.height)
        assert buried == pytest.approx(1.0 - level.probability, rel=0.1)
        assert low < buried < high


def test_the_interval_of_a_burial_contains_the_error_of_the_grid():
    heights = winters_of(0.0, 20, np.random.default_rng(5))
    _, low, high = RequiredHeights(heights, np.arange(20), {}).burial(2.5)
    _, lower, higher = RequiredHeights(heights, np.arange(20), {}, 0.3).burial(2.5)
    assert higher - lower > 1.3 * (high - low)


def test_one_winter_has_no_probabilities():
    result = RequiredHeights(np.array([2.6, 2.7, 2.8]), np.zeros(3), {}, 0.2)
    assert result.levels == [] and result.burial(2.0) is None
    height, low, high = result.highest
    assert height == pytest.approx(2.7, abs=0.03) and low < 2.35 < 3.1 < high
    assert {share.cause for share in result.shares} == {"grid", "chance"}
    assert all(2.2 < share.low < share.high < 3.3 for share in result.shares)


def test_few_winters_have_wider_intervals():
    heights = np.array([1.4, 1.9, 1.6, 1.5, 2.1])
    widths = []
    for count in (2, 3, 4, 5):
        level = RequiredHeights(heights[:count], np.arange(count), {}).levels[1]
        widths.append(level.high / level.low)
    assert widths == sorted(widths, reverse=True) and widths[0] > 5.0


def test_equal_winters_have_a_narrow_interval():
    level = RequiredHeights(np.full(6, 1.5), np.arange(6), {}).levels[1]
    assert level.low == pytest.approx(1.5, abs=0.02) and 1.502 < level.high < 1.6


def test_winters_without_snow_do_not_bend_the_distribution_of_the_others():
    """Fourteen of 20 winters shed no snow; the others need 1.0 to 1.5 m."""
    heights = np.array([0.1] * 14 + [1.0, 1.1, 1.2, 1.3, 1.4, 1.5])
    result = RequiredHeights(heights, np.arange(20), {}, floor=0.11)
    median, ninetieth, _ = result.levels
    assert median.height == 0.11 and 1.1 < ninetieth.height < 1.4
    buried, low, high = result.burial(0.9)
    assert low < 0.3 < high and buried == pytest.approx(0.3, abs=0.06)


@pytest.mark.slow
def test_coverage_with_winters_without_snow():
    random, inside, covered = np.random.default_rng(8), 0, 0
    true = 1.0 + 0.2 * float(standard_quantile((0.9 - 0.6) / 0.4, np.array(0.0)))
    for _ in range(300):
        snowy = random.random(20) < 0.4
        heights = np.where(snowy, 1.0 + 0.2 * random.gumbel(size=20), 0.1)
        if snowy.sum() < 2:
            continue
        level = RequiredHeights(heights, np.arange(20), {}, floor=0.11).levels[1]
        covered, inside = covered + 1, inside + (level.low <= true <= level.high)
    print(f"{inside / covered:.1%}")
    assert 0.86 <= inside / covered <= 0.97


def test_winters_without_any_snow_have_no_probabilities():
    result = RequiredHeights(np.full(8, 0.1), np.arange(8), {}, 0.0, floor=0.11)
    assert result.levels == [] and result.shares == [] and result.burial(1.0) is None
    assert result.highest == pytest.approx((0.1, 0.1, 0.1))


def test_only_the_shed_part_has_an_error_of_the_grid():
    heights, winters = np.linspace(1.0, 2.0, 20), np.arange(20)
    all_shed = RequiredHeights(heights, winters, {}, 0.3).highest
    half = RequiredHeights(heights, winters, {}, 0.3, shed_part=0.5).highest
    assert half[2] - 2.0 == pytest.approx(0.5 * (all_shed[2] - 2.0), rel=0.02)


def test_the_answer_does_not_depend_on_the_unit():
    """Heights in the family of location and scale: a change of unit changes nothing else."""
    heights = winters_of(0.1, 12, np.random.default_rng(6))
    metres = RequiredHeights(heights, np.arange(12), {}).levels[1]
    feet = RequiredHeights(heights / 0.3048, np.arange(12), {}).levels[1]
    assert feet.high * 0.3048 == pytest.approx(metres.high)
