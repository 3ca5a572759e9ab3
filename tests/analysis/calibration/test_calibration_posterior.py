"""Recovery: measurements of a known snow, with noise, give ranges that hold that snow."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from stand_in import COHESION, HIGH, LOW, measured, table_of, thesis_triplets

from snowshed import InputError
from snowshed.analysis import Surrogate, calibrate, sample_posterior
from snowshed.analysis.calibration.comparison import SimulatedStacks, simulated
from snowshed.analysis.calibration.posterior import Posterior, outputs_of

STEPS = 200


@pytest.fixture(scope="module")
def stacks():
    return simulated(table_of(thesis_triplets()))


@pytest.fixture(scope="module")
def surrogate(stacks):
    return Surrogate.fitted(stacks, outputs_of(measured((0.5, 5e3, 0.1))))


def posterior_of(surrogate, snow, **options):
    return sample_posterior(surrogate, measured(snow, **options), steps=STEPS)


def test_the_surrogate_knows_runs_it_has_not_seen(surrogate):
    accuracy = surrogate.accuracy()
    assert (accuracy["explained"] > 0.95).all()
    assert accuracy["within_two"].mean() == pytest.approx(0.95, abs=0.03)
    five = accuracy[(accuracy["quantity"] == "height") & (accuracy["event"] == 5)]
    assert np.allclose(five["noise_m"], 0.02 * 0.16, rtol=0.4)  # 2 % of about 0.16 m


def test_known_snow_comes_back_inside_the_ranges(surrogate):
    """Nearly all 95 % ranges of three snows hold the true value, and most 68 % ranges do."""
    random = np.random.default_rng(3)
    within = {"68": 0, "95": 0}
    for number in range(3):
        snow = LOW + random.uniform(0.1, 0.9, 3) * (HIGH - LOW)
        ranges = posterior_of(surrogate, snow, random=100 + number).ranges()
        for level in within:
            inside = (ranges[f"lower_{level}"] <= snow) & (snow <= ranges[f"upper_{level}"])
            within[level] += int(inside.sum())
    assert within["95"] >= 8  # of 9; fewer have a probability of 7 %
    assert within["68"] >= 4  # fewer: 4 %


def test_better_measurements_give_narrower_ranges(surrogate):
    widths = []
    for uncertainty in (0.01, 0.1):
        ranges = posterior_of(surrogate, (0.55, 5.5e3, 0.12), uncertainty=uncertainty).ranges()
        widths.append((ranges["upper_95"] - ranges["lower_95"]).to_numpy() / (HIGH - LOW))
    # M and beta make up for each other, so that only the grid's box bounds their ranges.
    assert widths[0][1] < 0.85 * widths[1][1]
    assert widths[0].mean() < 0.95 * widths[1].mean()


def test_rounds_share_the_error_of_the_model(surrogate):
    """More rounds of an exact measurement reduce the chance of a single round, and nothing else."""
    once = measured((0.55, 5.5e3, 0.12), uncertainty=1e-4, noise=0)
    widths = []
    for rounds in (1, 40):
        repeated = [type(one)(**{**vars(one), "round": r}) for one in once for r in range(rounds)]
        ranges = sample_posterior(surrogate, repeated, steps=STEPS).ranges()
        widths.append((ranges["upper_95"] - ranges["lower_95"]).to_numpy() / (HIGH - LOW))
    assert (widths[1] < widths[0]).all()  # the seeding's noise is averaged
    assert widths[1].mean() > 0.4 * widths[0].mean()  # independent errors: a sixth


def test_a_poor_round_beside_a_good_one_does_not_widen_the_ranges(surrogate):
    good = measured((0.55, 5.5e3, 0.12), uncertainty=0.01, noise=0)
    poor = [type(one)(**{**vars(one), "round": 2, "uncertainty": 0.5}) for one in good]
    alone, both = (
        sample_posterior(surrogate, rounds, steps=STEPS).ranges() for rounds in (good, good + poor)
    )
    widths = [
        (one["upper_95"] - one["lower_95"]).to_numpy() / (HIGH - LOW) for one in (alone, both)
    ]
    assert widths[1] == pytest.approx(widths[0], rel=0.1)


def test_a_model_that_cannot_be_right_says_so(surrogate):
    """The discrepancy explains stacks twice as high as any snow's, beyond its prior."""
    snow = (0.55, 5.5e3, 0.12)
    right = posterior_of(surrogate, snow)
    doubled = [
        type(one)(**{**vars(one), "value": one.value * (2 if one.quantity == "height" else 1)})
        for one in measured(snow)
    ]
    wrong = sample_posterior(surrogate, doubled, steps=STEPS)
    assert wrong.quantities == ["height", "length"]
    assert np.median(wrong.discrepancy[:, 0]) > 0.2 > 4 * np.median(right.discrepancy[:, 0])
    assert np.median(wrong.discrepancy[:, 1]) < 0.1


def test_ranges_that_the_box_cuts_off_are_open(surrogate):
    samples = np.random.default_rng(1).uniform(size=(4, 500, 3)) ** [4, 1, 0.25]
    assert posterior_with(surrogate, samples).ranges()["open"].tolist() == [
        "below",
        "both",
        "above",
    ]
    middle = posterior_with(surrogate, 0.4 + 0.2 * samples)
    assert middle.ranges()["open"].tolist() == ["", "", ""]


def posterior_with(surrogate, unit):
    """The posterior with these draws of the unit cube, shape (chains, draws, parameters)."""
    values = np.moveaxis(surrogate.physical(unit), -1, 0)
    columns = dict(zip([*surrogate.parameters, "discrepancy_height"], [*values, unit[..., 0]]))
    draws = xr.Dataset({name: (("chain", "draw"), of) for name, of in columns.items()})
    return Posterior(surrogate, ["height"], draws)


def test_chains_that_have_not_converged_are_told(surrogate):
    """Independent draws count fully; few draws, or chains that disagree, do not suffice."""
    unit = np.random.default_rng(1).uniform(0.4, 0.6, size=(8, 500, 3))
    good = posterior_with(surrogate, unit)
    assert good.converged and 3000 < good.effective_samples < 5000
    assert (good.diagnostics["r_hat"] - 1).abs().max() < 0.01
    assert not posterior_with(surrogate, unit[:, :20]).converged
    apart = posterior_with(surrogate, unit + 0.1 * np.arange(8)[:, None, None])
    assert not apart.converged and apart.diagnostics["r_hat"].max() > 1.5
    ranges = good.ranges().set_index("parameter")
    columns = ["ess_bulk", "ess_tail", "r_hat"]
    assert (ranges[columns] == good.diagnostics.loc[ranges.index, columns]).all(axis=None)


@pytest.mark.slow  # the command's test asks for it too, on fewer parameter sets
def test_the_default_number_of_steps_converges(surrogate):
    assert sample_posterior(surrogate, measured((0.55, 5.5e3, 0.12))).converged


def test_the_same_seed_gives_the_same_samples(surrogate):
    first, again = (posterior_of(surrogate, (0.5, 5e3, 0.1)) for _ in range(2))
    assert (first.samples == again.samples).all()
    assert (first.samples >= LOW).all() and (first.samples <= HIGH).all()


def test_what_cannot_be_calibrated_is_refused(stacks, surrogate):
    with pytest.raises(InputError, match="steps: 99 are too few; at least 100 are needed"):
        sample_posterior(surrogate, measured((0.5, 5e3, 0.1)), steps=99)
    few = SimulatedStacks(stacks.parameters, stacks.sets, stacks.rows[stacks.rows["set"] <= 4])
    message = "4 parameter sets have event 1 at tilt 40; the surrogate needs at least 6"
    with pytest.raises(InputError, match=message):
        Surrogate.fitted(few, [("height", 40.0, 1)])
    measurements = measured((0.5, 5e3, 0.1), quantities=("height",))
    for quantities, message in (
        (["width"], "quantity: 'width' is unknown; allowed: height, length, head, tail"),
        (["length", "head", "tail"], "length is tail - head"),
        (["length"], "none of length was measured"),
    ):
        with pytest.raises(InputError, match=message):
            calibrate(measurements, stacks, quantities=quantities)


def test_parameters_without_effect_stay_undecided():
    """Cohesion decides the height; friction, which is in no formula, keeps its prior."""
    friction = "panel.friction"
    snows = [(0.5, 5e3, beta) for beta in np.linspace(0.05, 0.2, 7)]
    tables = [
        table_of(snows, seeds=(1,), random=number).assign(**{friction: value})
        for number, value in enumerate((0.2, 0.3, 0.4))
    ]
    stacks = simulated(pd.concat(tables, ignore_index=True))
    assert set(stacks.parameters) == {COHESION, friction}
    measurements = measured((0.5, 5e3, 0.12))
    surrogate = Surrogate.fitted(stacks, outputs_of(measurements))
    ranges = sample_posterior(surrogate, measurements, steps=STEPS).ranges().set_index("parameter")
    assert ranges.loc[friction, "open"] == "both" and ranges.loc[COHESION, "open"] == ""
    assert ranges.loc[COHESION, "lower_95"] < 0.12 < ranges.loc[COHESION, "upper_95"]
