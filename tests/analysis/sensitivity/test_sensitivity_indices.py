"""Indices against functions whose indices are known in closed form."""

import numpy as np
import pandas as pd
import pytest
from synthetic_studies import BETA, P0, REFERENCE, SEED, XI, E, M, designed_runs, noisy, study_runs

from snowshed import InputError
from snowshed.analysis.sensitivity import (
    StudyRuns,
    fixation_table,
    local_index,
    morris_effects,
    seeding_noise,
    sobol_indices,
)


def power_law(snow, event):
    return 0.02 * event * snow[M] ** 0.5 * snow[BETA]


def unit(snow):
    """The parameters in the unit cube of Table 3.2.1."""
    return {
        M: (snow[M] - 0.3) / 0.4,
        P0: (snow[P0] - 2e3) / 6e3,
        BETA: (snow[BETA] - 0.1) / 0.2,
        XI: np.log10(snow[XI] / 0.1),
        E: (snow[E] - 1e6) / 2e6,
    }


def pick(table, parameter, target="height", event=1, column=None):
    rows = table[table["parameter"] == parameter]
    (row,) = rows[(rows["target"] == target) & (rows["event"] == event)].to_dict("records")
    return row if column is None else row[column]


def test_s_of_a_power_law():
    table = local_index(designed_runs("s", power_law, seeds=1))
    for event in (1, 2, 3):
        assert pick(table, M, event=event, column="s") == pytest.approx(2**0.5 - 1)
        assert pick(table, BETA, event=event, column="s") == pytest.approx(1)
        for path in (P0, XI, E):
            assert pick(table, path, event=event, column="s") == 0
    assert (table.loc[table["target"] == "length", "s"] == 0).all()
    assert pick(table, BETA, column="nominal") == 0.15 and pick(table, BETA)["altered"] == 0.3
    assert table["standard_error"].isna().all() and table["distinct"].isna().all()


def test_the_standard_error_of_s():
    """Over many repetitions the standard error is the deviation of S, and noise is not distinct."""
    tables = [
        local_index(
            designed_runs("s", noisy(power_law, 0.05, random), seeds=4)
        ).assign(random=random)
        for random in range(25)
    ]  # fmt: skip
    table = pd.concat(tables)
    table = table[table["target"] == "height"]
    for parameter in (M, P0, BETA):
        rows = table[table["parameter"] == parameter]
        ratio = rows["standard_error"].mean() / rows.groupby("event")["s"].std().mean()
        assert 0.7 < ratio < 1.4
    assert table.loc[table["parameter"] == BETA, "distinct"].all()
    assert 0.01 < table.loc[table["parameter"] == P0, "distinct"].mean() < 0.12  # 5 % by chance


def test_s_compares_the_lowest_and_the_highest_value():
    points = [{BETA: beta, M: slope} for beta in (0.1, 0.2, 0.4) for slope in (0.4, 0.5)]
    table = local_index(study_runs(points, power_law))
    assert pick(table, BETA, column="pairs") == 2 and pick(table, BETA)["altered"] == 0.4
    assert pick(table, BETA, column="s") == pytest.approx(1)
    with pytest.raises(InputError, match="no two of its runs differ in one parameter alone"):
        local_index(study_runs([{BETA: 0.1, M: 0.4}, {BETA: 0.2, M: 0.5}], power_law))
    with pytest.raises(InputError, match=r"cohesion: S is not defined at the nominal value 0"):
        local_index(study_runs([{BETA: 0.0}, {BETA: 0.2}], lambda snow, event: 1.0))


def test_noise_is_pooled_over_points():
    points = [{BETA: beta, SEED: seed} for beta in (0.1, 0.2, 0.3) for seed in range(1, 101)]
    noise = seeding_noise(study_runs(points, noisy(power_law_of_beta, 0.05)))
    assert noise.loc[(1, "height"), "noise"] == pytest.approx(0.05, rel=0.1)
    assert noise.loc[(1, "height"), "freedom"] == 297
    assert noise.loc[(1, "length"), "noise_m"] == pytest.approx(0, abs=1e-12)


def power_law_of_beta(snow, event):
    return event * snow[BETA]


def test_fixation_averages_over_the_rest_of_the_group():
    study = designed_runs("fixation", lambda snow, event: event * snow[BETA] + snow[M], seeds=1)
    table = fixation_table(study)
    held = table[(table["group"] == "yield") & (table["target"] == "height")]
    assert (held["points"] == 9).all() and set(held["parameter"]) == {M, P0, BETA}
    assert set(table.loc[table["group"] == "hardening", "points"]) == {3}
    row = held[(held["parameter"] == BETA) & (held["value"] == 0.2) & (held["event"] == 3)]
    assert row["mean_m"].item() == pytest.approx(3 * 0.2 + 0.5)
    assert row["deviation_m"].item() == pytest.approx(np.std([0.3, 0.5, 0.7] * 3, ddof=1))
    low, high = 0.1 + 0.3, 3 * 0.3 + 0.7
    assert row["mean"].item() == pytest.approx((1.1 - low) / (high - low))  # equation 3.4.1
    flat = held[held["parameter"] == P0].groupby("event")["mean_m"]
    assert np.allclose(flat.std(), 0)


def test_fixation_of_a_full_product_uses_all_its_points():
    points = [{BETA: b, XI: x} for b in (0.1, 0.2) for x in (0.1, 0.2, 0.4)]
    table = fixation_table(study_runs(points, lambda snow, event: snow[BETA] + snow[XI]))
    assert (table.loc[table["parameter"] == BETA, "points"] == 3).all()
    with pytest.raises(InputError, match="no parameter varies"):
        fixation_table(study_runs([{BETA: 0.1}], power_law_of_beta))


def test_sobol_indices_of_a_function_with_an_interaction():
    """f = a x1 + b x2 + c (x3 - 1/2)(x5 - 1/2) has the variances a²/12, b²/12 and c²/144."""
    a, b, c = 2.0, 1.0, 4.0

    def height(snow, event):
        x = unit(snow)
        return 5 + a * x[M] + b * x[XI] + c * (x[P0] - 0.5) * (x[E] - 0.5)

    table = sobol_indices(designed_runs("sobol", height, events=(1,), samples=256))
    shares = np.array([a**2 / 12, b**2 / 12, c**2 / 144])
    shares /= shares.sum()
    for path, first, total in (
        (M, shares[0], shares[0]),
        (XI, shares[1], shares[1]),
        (P0, 0, shares[2]),
        (E, 0, shares[2]),
        (BETA, 0, 0),
        (SEED, 0, 0),
    ):
        row = pick(table, path)
        assert row["first"] == pytest.approx(first, abs=0.06)
        assert row["total"] == pytest.approx(total, abs=0.04)
        assert row["blocks"] == 256


def test_noise_leaves_out_points_without_a_stack():
    """At one of two points all snow stays on the panel."""
    points = [{BETA: beta, SEED: seed} for beta in (0.1, 0.2) for seed in range(1, 301)]
    sloping = noisy(power_law_of_beta, 0.05)
    study = study_runs(points, lambda snow, event: sloping(snow, event) * (snow[BETA] > 0.15))
    assert seeding_noise(study).loc[(1, "height"), "noise"] == pytest.approx(0.05, rel=0.1)


def test_noise_shows_in_the_total_index_of_the_seed():
    """With noise of the same variance as the effect, each explains a half."""
    base = designed_runs("sobol", lambda snow, event: 5 + unit(snow)[M], events=(1,), samples=256)
    generator = np.random.default_rng(1)
    rows = base.rows.assign(
        height=base.rows["height"] + generator.normal(0, 12**-0.5, len(base.rows))
    )
    table = sobol_indices(StudyRuns("noisy", base.axes, base.points, rows))
    assert pick(table, SEED, column="total") == pytest.approx(0.5, abs=0.1)
    assert pick(table, BETA, column="total") == pytest.approx(0.5, abs=0.1)  # no more than noise
    assert pick(table, M, column="first") == pytest.approx(0.5, abs=0.15)


def test_elementary_effects_of_a_linear_function():
    slopes = {M: 3.0, P0: -2.0, XI: 0.5}

    def height(snow, event):
        return 10 + sum(slope * unit(snow)[path] for path, slope in slopes.items())

    study = designed_runs("morris", height, samples=10)
    table = morris_effects(study)
    mean = study.rows.loc[study.rows["event"] == 1, "height"].mean()
    for path in [*REFERENCE, SEED]:
        row = pick(table, path)
        assert row["effect"] * mean == pytest.approx(slopes.get(path, 0), abs=1e-9)
        assert row["strength"] * mean == pytest.approx(abs(slopes.get(path, 0)), abs=1e-9)
        assert row["spread"] == pytest.approx(0, abs=1e-9)


def test_noise_shows_in_the_strength_of_the_seed():
    """A parameter without effect is as strong as the seed, on average over repetitions."""
    base = designed_runs("morris", lambda snow, event: 5 + unit(snow)[M], events=(1,), samples=20)
    generator = np.random.default_rng(1)
    strengths = []
    for _ in range(8):
        noise = generator.normal(0, 0.05, len(base.rows))
        rows = base.rows.assign(height=base.rows["height"] + noise)
        table = morris_effects(StudyRuns("noisy", base.axes, base.points, rows))
        strengths.append({path: pick(table, path, column="strength") for path in (M, BETA, SEED)})
    mean = pd.DataFrame(strengths).mean()
    assert mean[BETA] == pytest.approx(mean[SEED], rel=0.15)
    # Mean absolute difference of two stacks (deviation sqrt(2) sigma), divided by steps of 2/3.
    expected = np.sqrt(2) * np.sqrt(2 / np.pi) * 0.05 / (2 / 3) / 5.5
    assert mean[SEED] == pytest.approx(expected, rel=0.15)
    assert mean[M] == pytest.approx(1 / 5.5, rel=0.1)


@pytest.mark.parametrize("step", [0.05, 0.4, 2 / 3, 1.0])
def test_effects_of_trajectories_with_any_step(step):
    """Height 2 + x + 2 y over the unit square, whose corners every trajectory starts from."""
    trajectories = [
        [(x, y), (x + (step if x == 0 else -step), y), (x + (step if x == 0 else -step), y + dy)]
        for x, y, dy in ((0, 0, step), (1, 1, -step), (0, 1, -step), (1, 0, step))
    ]
    points = [{M: x, BETA: y} for trajectory in trajectories for x, y in trajectory]
    study = study_runs(points, lambda snow, event: 2 + snow[M] + 2 * snow[BETA])
    table, mean = morris_effects(study), study.rows["height"].mean()
    assert pick(table, M)["effect"] * mean == pytest.approx(1)
    assert pick(table, BETA)["strength"] * mean == pytest.approx(2)


def test_unequal_steps_are_not_a_morris_design():
    points = [{M: 0.3, BETA: 0.1}, {M: 0.5, BETA: 0.1}, {M: 0.5, BETA: 0.3}]
    points += [{M: 0.3, BETA: 0.1}, {M: 0.35, BETA: 0.1}, {M: 0.35, BETA: 0.3}]
    with pytest.raises(InputError, match=f"{M}: its steps differ"):
        morris_effects(study_runs(points, power_law))


@pytest.mark.parametrize(
    ("method", "indices"), [("sobol", sobol_indices), ("morris", morris_effects)]
)
def test_blocks_with_failed_runs_are_left_out(method, indices):
    study = designed_runs(method, lambda snow, event: 5 + unit(snow)[M], samples=8)
    rows = study.rows[study.rows["hash"] != "run3"]
    table = indices(StudyRuns("holes", study.axes, study.points, rows))
    assert (table["blocks"] == 7).all()
    few = study.rows[study.rows["hash"].isin([f"run{number}" for number in range(9)])]
    with pytest.raises(InputError, match=r"event 1: 1 of 8 blocks .* at least 2 are needed"):
        indices(StudyRuns("few", study.axes, study.points, few))


def test_studies_without_a_design_are_refused():
    grid = [{BETA: b, M: m} for b in (0.1, 0.2) for m in (0.3, 0.5)]
    for indices, name in ((sobol_indices, "Saltelli"), (morris_effects, "Morris")):
        with pytest.raises(InputError, match=f"are not .*{name}"):
            indices(study_runs(grid, power_law_of_beta))
    with pytest.raises(InputError, match="points 1 to 3 are not Morris trajectories"):
        morris_effects(study_runs([*grid[:3], *grid[1:]], power_law_of_beta))
