"""Recovery: ranges contain the snow whose noisy measurements they come from."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from stand_in import COHESION, HIGH, LOW, measured, study_table, thesis_triplets

from snowshed import InputError
from snowshed.analysis.calibration import Surrogate, calibrate, posterior, sample_posterior
from snowshed.analysis.calibration.comparison import SimulatedStacks, simulated
from snowshed.analysis.calibration.posterior import Posterior, outputs_of

STEPS = 200


@pytest.fixture(scope="module")
def stacks():
    return simulated(study_table(thesis_triplets()))


@pytest.fixture(scope="module")
def surrogate(stacks):
    return Surrogate.fitted(stacks, outputs_of(measured((0.5, 5e3, 0.1))))


def sampled_posterior(surrogate, snow, **options):
    return sample_posterior(surrogate, measured(snow, **options), steps=STEPS)


def test_the_surrogate_predicts_runs_left_out_of_its_fit(surrogate):
    accuracy = surrogate.accuracy()
    assert (accuracy["explained"] > 0.95).all()
    assert accuracy["within_two"].mean() == pytest.approx(0.95, abs=0.03)
    five = accuracy[(accuracy["quantity"] == "height") & (accuracy["event"] == 5)]
    assert np.allclose(five["noise_m"], 0.02 * 0.16, rtol=0.4)  # 2 % of about 0.16 m


def test_ranges_contain_the_true_snow(surrogate):
    """Nearly all 95 % ranges of three snows hold the true value, and most 68 % ranges do."""
    random = np.random.default_rng(3)
    within = {"68": 0, "95": 0}
    for number in range(3):
        snow = LOW + random.uniform(0.1, 0.9, 3) * (HIGH - LOW)
        ranges = sampled_posterior(surrogate, snow, random=100 + number).ranges()
        for level in within:
            inside = (ranges[f"lower_{level}"] <= snow) & (snow <= ranges[f"upper_{level}"])
            within[level] += int(inside.sum())
    assert within["95"] >= 8  # of 9; fewer have a probability of 7 %
    assert within["68"] >= 4  # fewer: 4 %


def test_better_measurements_give_narrower_ranges(surrogate):
    widths = []
    for uncertainty in (0.01, 0.1):
        ranges = sampled_posterior(surrogate, (0.55, 5.5e3, 0.12), uncertainty=uncertainty).ranges()
        widths.append((ranges["upper_95"] - ranges["lower_95"]).to_numpy() / (HIGH - LOW))
    # M and beta compensate for each other, so only the grid's box bounds their ranges.
    assert widths[0][1] < 0.85 * widths[1][1]
    assert widths[0].mean() < 0.95 * widths[1].mean()


def test_rounds_share_the_error_of_the_model(surrogate):
    """More rounds of an exact measurement average the seeding's noise, not the model's error."""
    single_round = measured((0.55, 5.5e3, 0.12), uncertainty=1e-4, noise=0)
    widths = []
    for rounds in (1, 40):
        repeated = [
            type(measurement)(**{**vars(measurement), "round": r})
            for measurement in single_round
            for r in range(1, rounds + 1)
        ]
        ranges = sample_posterior(surrogate, repeated, steps=STEPS).ranges()
        widths.append((ranges["upper_95"] - ranges["lower_95"]).to_numpy() / (HIGH - LOW))
    assert (widths[1] < widths[0]).all()  # less noise
    assert widths[1].mean() > 0.4 * widths[0].mean()  # independent errors: a sixth


def test_a_poor_round_beside_a_good_one_does_not_widen_the_ranges(surrogate):
    good = measured((0.55, 5.5e3, 0.12), uncertainty=0.01, noise=0)
    poor = [type(item)(**{**vars(item), "round": 2, "uncertainty": 0.5}) for item in good]
    good_ranges, all_ranges = (
        sample_posterior(surrogate, rounds, steps=STEPS).ranges() for rounds in (good, good + poor)
    )
    widths = [
        (ranges["upper_95"] - ranges["lower_95"]).to_numpy() / (HIGH - LOW)
        for ranges in (good_ranges, all_ranges)
    ]
    assert widths[1] == pytest.approx(widths[0], rel=0.1)


def test_a_large_discrepancy_reveals_a_wrong_model(surrogate):
    """Stacks twice as high as any snow's need a discrepancy beyond its prior."""
    snow = (0.55, 5.5e3, 0.12)
    right = sampled_posterior(surrogate, snow)
    doubled = [
        type(measurement)(
            **{
                **vars(measurement),
                "value": measurement.value * (2 if measurement.quantity == "height" else 1),
            }
        )
        for measurement in measured(snow)
    ]
    wrong = sample_posterior(surrogate, doubled, steps=STEPS)
    assert wrong.quantities == ["height", "length"]
    assert np.median(wrong.discrepancy[:, 0]) > 0.2 > 4 * np.median(right.discrepancy[:, 0])
    assert np.median(wrong.discrepancy[:, 1]) < 0.1


def test_ranges_clipped_by_the_box_are_open(surrogate):
    samples = np.random.default_rng(1).uniform(size=(4, 500, 3)) ** [4, 1, 0.25]
    assert posterior_with(surrogate, samples).ranges()["open"].tolist() == [
        "below",
        "both",
        "above",
    ]
    middle = posterior_with(surrogate, 0.4 + 0.2 * samples)
    assert middle.ranges()["open"].tolist() == ["", "", ""]


def posterior_with(surrogate, unit):
    """Return a posterior with these draws of the unit cube, shape (chains, draws, parameters)."""
    values = np.moveaxis(surrogate.physical(unit), -1, 0)
    columns = dict(zip([*surrogate.parameters, "discrepancy_height"], [*values, unit[..., 0]]))
    draws = xr.Dataset({name: (("chain", "draw"), column) for name, column in columns.items()})
    return Posterior(surrogate, ["height"], draws)


def test_chains_that_have_not_converged_are_reported(surrogate):
    """Independent draws count fully; few draws, or chains that disagree, do not suffice."""
    unit = np.random.default_rng(1).uniform(0.4, 0.6, size=(8, 500, 3))
    good = posterior_with(surrogate, unit)
    assert good.converged and 3000 < good.effective_samples < 5000
    assert (good.diagnostics["r_hat"] - 1).abs().max() < 0.01
    assert not posterior_with(surrogate, unit[:, :20]).converged
    disagreeing = posterior_with(surrogate, unit + 0.1 * np.arange(8)[:, None, None])
    assert not disagreeing.converged and disagreeing.diagnostics["r_hat"].max() > 1.5
    ranges = good.ranges().set_index("parameter")
    columns = ["ess_bulk", "ess_tail", "r_hat"]
    assert (ranges[columns] == good.diagnostics.loc[ranges.index, columns]).all(axis=None)


@pytest.mark.slow  # the command's test covers this with fewer parameter sets
def test_the_default_number_of_steps_converges(surrogate):
    assert sample_posterior(surrogate, measured((0.55, 5.5e3, 0.12))).converged


def test_the_same_seed_gives_the_same_samples(surrogate):
    first, second = (sampled_posterior(surrogate, (0.5, 5e3, 0.1)) for _ in range(2))
    assert (first.samples == second.samples).all()
    assert (first.samples >= LOW).all() and (first.samples <= HIGH).all()


def test_impossible_calibrations_are_refused(stacks, surrogate):
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


def test_parameters_without_effect_keep_their_prior():
    """Cohesion determines the height; friction affects nothing and keeps its prior."""
    friction = "panel.friction"
    snows = [(0.5, 5e3, beta) for beta in np.linspace(0.05, 0.2, 7)]
    tables = [
        study_table(snows, seeds=(1,), random=number).assign(**{friction: value})
        for number, value in enumerate((0.2, 0.3, 0.4))
    ]
    stacks = simulated(pd.concat(tables, ignore_index=True))
    assert set(stacks.parameters) == {COHESION, friction}
    measurements = measured((0.5, 5e3, 0.12))
    surrogate = Surrogate.fitted(stacks, outputs_of(measurements))
    ranges = sample_posterior(surrogate, measurements, steps=STEPS).ranges().set_index("parameter")
    assert ranges.loc[friction, "open"] == "both" and ranges.loc[COHESION, "open"] == ""
    assert ranges.loc[COHESION, "lower_95"] < 0.12 < ranges.loc[COHESION, "upper_95"]


def test_diagnostics_leave_the_draws_as_they_were(surrogate, monkeypatch):
    """Arviz 1 adds attributes to what it is given, as the stand-in does; no NetCDF file can hold
    them."""

    def summary(draws, **options):
        draws.attrs["sample_dims"] = ["chain", "draw"]
        return pd.DataFrame(1.0, index=list(draws), columns=[*posterior.DIAGNOSTICS])

    monkeypatch.setattr(posterior, "require", lambda *names: SimpleNamespace(summary=summary))
    identical = posterior_with(surrogate, np.full((2, 4, 3), 0.5))
    assert (identical.diagnostics == 1).all(axis=None)
    assert identical.draws.attrs == {}
