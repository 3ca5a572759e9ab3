"""The grid of triplets: its study, its misfits by hand, its ranking."""

import json

import numpy as np
import pandas as pd
import pytest
from stand_in import COHESION, PRESSURE, SLOPE, measured, stack, study_table, thesis_triplets

from snowshed import InputError
from snowshed.analysis.calibration import Measurement, calibration_study, compare_stacks, rank_sets
from snowshed.analysis.calibration.comparison import simulated
from snowshed.analysis.calibration.misfit import statistics

TRUTH = (0.5, 7e3, 0.2)


def test_the_study_is_the_thesis_table_4_1_1():
    scenes = [json.loads(run.scene) for run in calibration_study(measured(TRUTH), seeds=1).runs()]
    snow = [scene["snow"] for scene in scenes]
    names = ("critical_state_slope", "preconsolidation_pressure", "cohesion")
    assert {tuple(values[name] for name in names) for values in snow} == set(thesis_triplets())
    assert len(scenes) == 96 and {scene["panel"]["tilt"] for scene in scenes} == {40, 50}
    for scene in scenes:
        assert (scene["dimension"], scene["numerics"]["dx"], scene["events"]["count"]) == (
            3,
            0.01,
            5,
        )
        assert (scene["panel"]["height"], scene["panel"]["length"]) == (0.33, 0.245)
        assert (scene["snow"]["youngs_modulus"], scene["snow"]["hardening_factor"]) == (1e6, 0.1)
    with pytest.raises(InputError, match="seeds: 0 is not positive"):
        calibration_study(measured(TRUTH), seeds=0)


def test_scores_match_hand_calculations():
    """Set 1 is 1 cm too low and has the right length; set 2 has the right height, 5 cm too long."""
    rows = [
        {"hash": "a", "panel.tilt": 40.0, COHESION: beta, "seed": seed, "event": 1,
         "height_m": height + 0.001 * (seed - 1.5), "length_m": length, "head_m": 0.1,
         "tail_m": 0.3}
        for beta, height, length in ((0.1, 0.09, 0.2), (0.2, 0.1, 0.25))
        for seed in (1, 2)
    ]  # fmt: skip
    measurements = [
        Measurement(40.0, 1, 1, "height", 0.1, 0.01),
        Measurement(40.0, 1, 1, "length", 0.2, 0.02),
    ]
    stacks = simulated(pd.DataFrame(rows))
    ranked = rank_sets(stacks, compare_stacks(stacks, measurements)).set_index(COHESION)
    assert ranked.loc[0.1, "height_rmse_m"] == pytest.approx(0.01)
    assert ranked.loc[0.1, "height_relative_error"] == pytest.approx(0.1)
    assert ranked.loc[0.2, "length_relative_error"] == pytest.approx(-0.25)
    assert ranked.loc[0.2, "length_mean_error_m"] == pytest.approx(0.05)
    assert ranked.loc[0.1, "chi_square"] == pytest.approx(0.5)
    assert ranked["height_rescaled"].tolist() == [1, 0]
    assert ranked["rescaled_rmse"].tolist() == [0.5, 0.5]
    table = statistics(ranked)
    assert table.loc["length_rmse_m"].tolist() == pytest.approx([0, 0.05, 0.025, 0.025])


def test_errors_of_both_signs_do_not_cancel_in_the_rmse():
    rows = [
        {"hash": "a", "panel.tilt": 40.0, COHESION: beta, "seed": 1, "event": event,
         "height_m": height, "length_m": 0.2, "head_m": 0.1, "tail_m": 0.3}
        for beta, event, height in ((0.1, 1, 0.07), (0.1, 2, 0.14), (0.2, 1, 0.2), (0.2, 2, 0.2))
    ]  # fmt: skip
    measurements = [Measurement(40.0, event, 1, "height", 0.1, 0.01) for event in (1, 2)]
    stacks = simulated(pd.DataFrame(rows))
    ranked = rank_sets(stacks, compare_stacks(stacks, measurements)).set_index(COHESION).loc[0.1]
    assert ranked["height_rmse_m"] == pytest.approx((0.5 * (0.03**2 + 0.04**2)) ** 0.5)
    assert ranked["height_mean_error_m"] == pytest.approx(0.035)
    assert ranked["height_relative_error"] == pytest.approx(-0.05)


def test_exact_measurements_find_their_triplet():
    stacks = simulated(study_table(thesis_triplets(), noise=0, seeds=(1,)))
    ranked = rank_sets(stacks, compare_stacks(stacks, measured(TRUTH, uncertainty=1e-9, noise=0)))
    assert tuple(ranked.iloc[0][[SLOPE, PRESSURE, COHESION]]) == TRUTH
    assert ranked.iloc[0]["rescaled_rmse"] == pytest.approx(0, abs=1e-6)
    assert ranked["rank"].tolist() == list(range(1, 49))
    assert (np.diff(ranked["rescaled_rmse"]) >= 0).all()


def test_sets_with_failed_runs_are_not_ranked():
    table = study_table(thesis_triplets(), noise=0, seeds=(1,))
    at = (table[SLOPE] == 0.5) & (table[PRESSURE] == 7e3) & (table[COHESION] == 0.2)
    table.loc[at & (table["panel.tilt"] == 50) & (table["event"] > 3), "height_m"] = np.nan
    stacks = simulated(table)
    ranked = rank_sets(stacks, compare_stacks(stacks, measured(TRUTH)))
    assert len(stacks.sets) == 48 and len(ranked) == 47
    assert not (ranked[[SLOPE, PRESSURE, COHESION]].to_numpy() == TRUTH).all(axis=1).any()


def test_sets_of_failed_runs_are_counted():
    """They still count for the bounds of the parameters."""
    table = study_table(thesis_triplets(), noise=0, seeds=(1,))
    table.loc[table[COHESION] == 0.2, ["height_m", "length_m", "head_m", "tail_m"]] = np.nan
    stacks = simulated(table)
    assert len(stacks.sets) == 48 and stacks.sets[COHESION].max() == 0.2
    assert len(rank_sets(stacks, compare_stacks(stacks, measured(TRUTH)))) == 32


def test_head_and_tail_are_scored_but_do_not_rank():
    stacks = simulated(study_table(thesis_triplets(), noise=0, seeds=(1,)))
    measurements = measured(TRUTH, noise=0)
    without_head = rank_sets(stacks, compare_stacks(stacks, measurements))
    head = Measurement(40.0, 1, 1, "head", 0.1, 0.01, 9)
    with_head = rank_sets(stacks, compare_stacks(stacks, [*measurements, head]))
    assert with_head["head_rmse_m"].tolist() == pytest.approx([0.01] * 48)
    assert with_head["rescaled_rmse"].tolist() == without_head["rescaled_rmse"].tolist()
    with pytest.raises(InputError, match="neither height_m nor length_m was measured"):
        rank_sets(stacks, compare_stacks(stacks, [head]))


def test_measurements_and_tables_that_do_not_match_are_refused():
    table = study_table(thesis_triplets()[:8], seeds=(1,))
    stacks = simulated(table)
    value = stack(TRUTH, 40, 1)[0]
    for measurement, message in (
        (
            Measurement(30.0, 1, 1, "height", value, 0.01, 7, "line 7"),
            "tilt 30, measured in line 7",
        ),
        (Measurement(40.0, 6, 1, "height", value, 0.01, 8, "row 8"), "event 6, measured in row 8"),
    ):
        with pytest.raises(InputError, match=message):
            compare_stacks(stacks, [measurement])
    for wrong, message in (
        (table.drop(columns="panel.tilt"), "no axis panel.tilt"),
        (table.assign(**{COHESION: 0.1, SLOPE: 0.5, PRESSURE: 1e3}), "only tilt and seed vary"),
        (table.assign(height_m=np.nan), "none of its runs is computed yet"),
        (
            table.assign(**{COHESION: ["soft", "hard"] * (len(table) // 2)}),
            "cohesion: holds 'soft'",
        ),
    ):
        with pytest.raises(InputError, match=message):
            simulated(wrong)


def test_constant_text_columns_are_no_parameters():
    table = study_table(thesis_triplets()[:8], seeds=(1,))
    named = simulated(table.assign(**{"events.between": "carry"}))
    assert named.parameters == simulated(table).parameters


def test_tilts_keep_their_measured_digits():
    measured = [Measurement(tilt, 3, 1, "height", 0.1, 0.01) for tilt in (38.65980825, 40.0)]
    assert "panel.tilt = [38.65980825, 40.0]" in calibration_study(measured).to_toml()
