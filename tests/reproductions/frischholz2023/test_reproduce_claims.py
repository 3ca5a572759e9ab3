"""Every claim on made-up tables: confirmed, contradicted, undecided."""

import itertools
import math

import numpy as np
import pandas as pd
import pytest
from reproductions.common.hypothesis_tests import (
    CONFIRMED,
    CONTRADICTED,
    UNDECIDED,
    Claim,
    Estimate,
    Finding,
    all_of,
    is_near,
    is_negative,
    is_positive,
    is_small,
    judge,
    mean_of,
)
from reproductions.frischholz2023.claims import (
    calibration,
    fixation,
    geometry,
    lab,
    regression,
    s_index,
)

ORDER = (CONFIRMED, CONTRADICTED, UNDECIDED)


def verdicts(claim, *data):
    return tuple(claim(table).verdict for table in data)


def test_a_claim_is_decided_at_two_standard_deviations():
    values = [Estimate(2.1, 1.0), Estimate(-2.1, 1.0), Estimate(1.9, 1.0)]
    assert tuple(is_positive(value, "").verdict for value in values) == ORDER
    mirrored = [Estimate(-value.value, value.noise) for value in values]
    assert tuple(is_negative(value, "").verdict for value in mirrored) == ORDER
    assert is_positive(Estimate(1.0, math.nan), "").verdict == UNDECIDED
    assert is_positive(Estimate(math.nan, 0.1), "").verdict == UNDECIDED


def test_claims_of_small_and_near_values_have_bounds():
    values = [Estimate(-0.2, 0.1), Estimate(1.0, 0.1), Estimate(0.6, 0.1)]
    assert tuple(is_small(value, 0.5, "").verdict for value in values) == ORDER
    values = [Estimate(2.1, 0.1), Estimate(3.0, 0.1), Estimate(2.6, 0.1)]
    assert tuple(is_near(value, 2.0, 0.5, "").verdict for value in values) == ORDER


def test_claims_with_parts_hold_if_all_parts_do():
    confirmed, contradicted, undecided = (Finding(verdict, verdict[:2]) for verdict in ORDER)
    assert all_of([confirmed, confirmed]).verdict == CONFIRMED
    assert all_of([confirmed, undecided]).verdict == UNDECIDED
    assert all_of([confirmed, undecided, contradicted]) == Finding(CONTRADICTED, "co; un; co")


def test_the_noise_of_a_mean_is_pooled():
    mean = mean_of([Estimate(1.0, 3.0), Estimate(3.0, 4.0)])
    assert (mean.value, mean.noise) == (2.0, 2.5)


def test_missing_data_leave_a_claim_open():
    def lacking(data):
        raise LookupError("it")

    (judged,) = judge([Claim("1", "x", "y", lacking)], None)
    assert judged.finding.verdict == UNDECIDED and "it" in judged.finding.sentence


# --- laboratory


def lab_rows(*, noise=0.0005, tilts=(40, 50), seeds=(1, 2, 3), **changes):
    """Stacks as the thesis describes them; `changes` are functions of event and tilt."""
    shape = {
        "height": lambda event, tilt: 0.05 * event**0.7,
        "head": lambda event, tilt: 0.2 - 0.02 * event + 0.003 * (tilt - 40),
        "tail": lambda event, tilt: 0.4 + (0.05 if event > 1 else 0.02) + 0.003 * (tilt - 40),
        **changes,
    }
    generator = np.random.default_rng(1)
    rows = []
    for tilt, seed, event in itertools.product(tilts, seeds, range(1, 6)):
        row = {
            name: function(event, tilt) + noise * generator.normal()
            for name, function in shape.items()
        }
        rows.append({"tilt": tilt, "seed": seed, "event": event, **row})
    table = pd.DataFrame(rows)
    return table.assign(length=table["tail"] - table["head"])


LAB = {
    lab.head_walks_back: {"head": lambda event, tilt: 0.02 * event},
    lab.tail_stays: {"tail": lambda event, tilt: 0.4 + 0.1 * event},
    lab.head_makes_the_length: {"tail": lambda event, tilt: 0.4 + 0.1 * event},
    lab.length_grows_most_at_second: {"tail": lambda event, tilt: 0.4 + 0.02 * event**2},
    lab.height_grows_always: {"height": lambda event, tilt: 0.1 - 0.01 * event},
    lab.height_slope_falls: {"height": lambda event, tilt: 0.02 * event**1.5},
    lab.steeper_throws_further: {
        "head": lambda event, tilt: 0.2 - 0.01 * (tilt - 40),
        "tail": lambda event, tilt: 0.4 - 0.01 * (tilt - 40),
    },
    lab.mean_height: {"height": lambda event, tilt: 0.2 * event},
    lab.mean_length: {"head": lambda event, tilt: -1.0},
}


@pytest.mark.parametrize("claim", LAB, ids=lambda claim: claim.__name__)
def test_laboratory_claims(claim):
    as_described, opposite, noisy = lab_rows(), lab_rows(**LAB[claim]), lab_rows(noise=0.3)
    assert verdicts(claim, as_described, opposite, noisy) == ORDER
    assert claim(lab_rows(seeds=(1,))).verdict == UNDECIDED  # one seed gives no noise


def test_claims_about_several_tilts_need_them():
    (judged,) = judge(
        [claim for claim in lab.GROWTH if "Steeper" in claim.text], lab_rows(tilts=(40,))
    )
    assert judged.finding.verdict == UNDECIDED


def test_the_ratio_of_dimensions_is_judged():
    planar = lab_rows()
    spatial = [
        lab_rows(height=lambda event, tilt, f=f: f * 0.05 * event**0.7) for f in (0.66, 0.95)
    ]
    noisy = lab_rows(noise=0.2)
    data = [(spatial[0], planar), (spatial[1], planar), (noisy, planar)]
    assert verdicts(lab.ratio_of_dimensions, *data) == ORDER


def test_noise_of_few_seedings_is_widened():
    """Claims on pure chance are decided in five of a hundred cases."""
    generator = np.random.default_rng(3)
    rows = pd.DataFrame(itertools.product((40, 50), (1, 2)), columns=["tilt", "seed"])
    rows = rows.assign(event=1)
    decided = 0
    for _ in range(400):
        table = rows.assign(height=generator.normal(size=4))
        mean = lab.mean_over_runs(table, lambda run: float(run["height"].iloc[0]))
        decided += is_positive(mean, "").verdict != UNDECIDED
    assert 8 <= decided <= 32  # 18 are expected; 74 with the plain standard error


def test_slabs_stop_at_30_degrees():
    rows = pd.DataFrame({"friction": [0.3, 0.6], "stayed": [0.0, 1.0]})
    data = [rows, rows.assign(stayed=0.0), rows.assign(stayed=np.nan)]
    expected = (UNDECIDED, CONTRADICTED, UNDECIDED)
    assert verdicts(lab.slabs_stop_at_30_degrees, *data) == expected


# --- the index S

INDICES = {
    ("height", s_index.SLOPE): 0.15,
    ("height", s_index.PRESSURE): -0.1,
    ("height", s_index.COHESION): 0.4,
    ("height", s_index.HARDENING): 0.0,
    ("height", s_index.MODULUS): 0.01,
    ("length", s_index.SLOPE): -0.1,
    ("length", s_index.PRESSURE): 0.02,
    ("length", s_index.COHESION): -0.1,
    ("length", s_index.HARDENING): 0.0,
    ("length", s_index.MODULUS): 0.01,
}


def index_table(factor=1.0, error=0.01, **changes):
    """S as the thesis describes it; the first event has half of it."""
    values = {**{key: factor * s for key, s in INDICES.items()}, **changes.get("s", {})}
    rows = [
        {
            "parameter": path,
            "target": target,
            "event": event,
            "s": s * part,
            "standard_error": error,
        }
        for (target, path), s in values.items()
        for event, part in ((1, changes.get("first", 0.5)), (3, 1.0))
    ]
    return pd.DataFrame(rows)


@pytest.mark.parametrize("claim", s_index.S_INDEX, ids=lambda claim: claim.text)
def test_index_claims(claim):
    swapped = {
        (("length" if target == "height" else "height"), path): s
        for (target, path), s in INDICES.items()
    }
    large = {(target, s_index.MODULUS): 1.0 for target in ("height", "length")}
    contradicting = [
        index_table(-1.0),
        index_table(s=swapped),
        index_table(s=large),
        index_table(first=2.0),
    ]
    assert claim.judge(index_table()).verdict == CONFIRMED
    assert CONTRADICTED in verdicts(claim.judge, *contradicting)
    assert claim.judge(index_table(error=1.0)).verdict == UNDECIDED
    assert judge([claim], index_table().iloc[:0])[0].finding.verdict == UNDECIDED


# --- fixation

EFFECTS = {
    s_index.SLOPE: (0.01, -0.02),
    s_index.PRESSURE: (0.01, 0.02),
    s_index.COHESION: (0.02, -0.02),
    s_index.HARDENING: (-0.001, -0.003),
    s_index.MODULUS: (0.0, 0.001),
}


def fixation_table(
    sign=1.0, noise=0.0002, *, growth=0.03, bend=1.0, spread=1.0, hardening=None, scatter=0.0015
):
    """Means over three events that grow by `growth`; effects as the thesis describes them."""
    rows = []
    for path, effects in EFFECTS.items():
        yielding = path in fixation.YIELD
        strong = hardening if hardening is not None and not yielding else None
        for (target, effect), (step, value), event in itertools.product(
            zip(("height", "length"), effects), enumerate((0.1, 0.2, 0.3)), (1, 2, 3)
        ):
            added = event**0.5 if bend > 0 else event**2.0
            change = (sign * effect if strong is None else strong) * step / 2
            rows.append(
                {
                    "group": "yield" if yielding else "hardening",
                    "parameter": path,
                    "value": value,
                    "event": event,
                    "target": target,
                    "points": 9 if yielding else 3,
                    "mean_m": 0.1 + growth * added + change,
                    "deviation_m": scatter * (1 + 9 * step) ** spread * event ** (0.3 * bend),
                    "noise_m": noise,
                }
            )
    return pd.DataFrame(rows)


@pytest.mark.parametrize("claim", fixation.FIXATION, ids=lambda claim: claim.text)
def test_fixation_claims(claim):
    assert claim.judge(fixation_table(growth=0.1)).verdict == CONFIRMED
    contradicting = [
        fixation_table(-1.0),
        fixation_table(growth=0.001),
        fixation_table(bend=-1.0),
        fixation_table(spread=-1.0),
        fixation_table(scatter=0.2),
        fixation_table(hardening=0.2),
    ]
    assert CONTRADICTED in verdicts(claim.judge, *contradicting)
    undecided = [fixation_table(noise=1.0), fixation_table(spread=0.0)]
    assert UNDECIDED in verdicts(claim.judge, *undecided)


# --- geometry


def panels(of_length=np.log, *, height=-0.1, bend=0.0, tilt=-0.02, noise=0.002, **changes):
    """Stacks whose ratio is a function of the panel."""
    generator = np.random.default_rng(2)
    sign, steeper = changes.get("sign", 1.0), changes.get("steeper", 0.0)
    rows = []
    for event, h, length, angle in itertools.product(
        (1, 2), (1.0, 2.0, 3.0, 4.0), (0.5, 1.0, 2.0, 4.0, 8.0), (40.0, 55.0, 70.0)
    ):
        fall = height * (1 + steeper * (event - 1)) / event
        shape = sign * 0.2 * of_length(length) + bend * (h - 2.5) ** 2
        ratio = 0.1 * event * (1.2 + shape + fall * (h - 2.5) + tilt * (angle - 55) / 15)
        ratio *= 1 + noise * generator.normal()
        stack_length = 2.0 + sign * 0.6 * h + sign * 0.01 * (angle - 55) / 15
        stack_height = ratio * stack_length
        rows.append((event, h, length, angle, ratio, stack_height, stack_length))
    names = [*geometry.INPUTS, "ratio", "height", "length"]
    table = pd.DataFrame(rows, columns=names)
    table["length"] *= 1 + noise * generator.normal(size=len(table))
    return table


@pytest.mark.parametrize("claim", geometry.GEOMETRY, ids=lambda claim: claim.text)
def test_geometry_claims(claim):
    assert claim.judge(panels()).verdict == CONFIRMED
    contradicting = [
        panels(sign=-1.0, height=0.1),
        panels(lambda length: 0.3 * length),
        panels(bend=0.1),
        panels(tilt=0.3),
        panels(steeper=2.0),
    ]
    assert CONTRADICTED in verdicts(claim.judge, *contradicting)
    assert claim.judge(panels(noise=3.0)).verdict == UNDECIDED
    assert judge([claim], panels().iloc[:1])[0].finding.verdict == UNDECIDED


def test_a_fit_recovers_slope_and_error():
    """The fit agrees with the closed form of a straight line with one offset."""
    table = panels(noise=0.05)
    table = table[
        (table["event"] == 1) & (table["panel_tilt"] == 40) & (table["panel_length"] == 2)
    ]
    x = table["panel_height"].to_numpy()
    y = table["ratio"].to_numpy() / table["ratio"].mean()
    slope, offset = np.polyfit(x, y, 1)
    residual = y - slope * x - offset
    error = math.sqrt((residual @ residual) / (len(x) - 2) / ((x - x.mean()) ** 2).sum())
    (estimate,) = geometry.fit(table, "panel_height", "ratio", geometry.straight).slopes
    assert (estimate.value, estimate.noise) == pytest.approx((slope, error))


def test_events_of_one_panel_are_not_independent():
    """Events that repeat the scatter of their panels add no information to one event."""
    single = panels(noise=0.0)
    single = single[
        (single["event"] == 1) & (single["panel_length"] == 2) & (single["panel_tilt"] == 40)
    ]
    single = pd.concat([single.assign(panel_height=height) for height in (1.0, 2.0)] * 3)
    single["panel_height"] = np.linspace(1, 4, len(single))
    single["ratio"] = 0.1 + 0.01 * np.random.default_rng(4).normal(size=len(single))
    repeated = pd.concat([single.assign(event=event) for event in range(1, 10)])
    (one_event,), (nine_events,) = (
        geometry.fit(table, "panel_height", "ratio", geometry.straight).slopes
        for table in (single, repeated)
    )
    assert nine_events.value == pytest.approx(one_event.value)
    assert nine_events.noise == pytest.approx(one_event.noise, rel=0.4)  # independent: a third


def test_a_dip_between_tilts_contradicts_the_claim():
    table = panels()
    table.loc[table["panel_tilt"] == 55, "ratio"] *= 0.7
    finding = geometry.hardly_depends_on_tilt(table)
    assert finding.verdict == CONTRADICTED and "and 55 degrees" in finding.sentence


# --- regression


def regression_results(
    rbf=0.005, linear=0.012, *, errors=(0.004, 0.015), spread=0.0002, off=1.0, rows=610, **changes
):
    models = {"linear": linear, "rbf": rbf}
    overfit = changes.get("overfit", 0.6)
    scores = [
        {
            "model": model,
            "round": 1,
            "fold": fold,
            "development_score": (0.99 if model == "linear" else overfit) * score,
            "validation_score": score + spread * (-1) ** fold,
            "C": 10.0 ** (fold % 3 if (model == "linear") == (overfit < 1) else 1),
        }
        for model, score in models.items()
        for fold in range(changes.get("folds", 10))
    ]
    table = pd.DataFrame({"mean_absolute_error": errors, "standard_deviation": 0.005})
    table.index = ["rbf", "linear"]
    quartiles = pd.DataFrame.from_dict(
        {name: off * np.array(values) for name, values in regression.THESIS_QUARTILES.items()},
        orient="index",
        columns=["Q1", "Q2", "Q3", "Q4"],
    )
    return regression.RegressionResults(rows, rows // 5, pd.DataFrame(scores), table, quartiles)


@pytest.mark.parametrize("claim", regression.REGRESSION, ids=lambda claim: claim.text)
def test_regression_claims(claim):
    assert claim.judge(regression_results()).verdict == CONFIRMED
    contradicting = [
        regression_results(0.02, 0.010),
        regression_results(errors=(0.05, 0.05)),
        regression_results(off=3.0),
        regression_results(overfit=1.1),
    ]
    assert CONTRADICTED in verdicts(claim.judge, *contradicting)
    tie = regression_results()
    tie.scores["C"] = 1.0
    undecided = [
        tie,
        regression_results(spread=0.1),
        regression_results(folds=1),
        regression_results(errors=(0.1, 0.1), off=1.3),
        regression_results(errors=(0.0101, 0.019)),
        regression_results(errors=(0.0051, 0.019)),
        regression_results(rows=27),
    ]
    assert UNDECIDED in verdicts(claim.judge, *undecided)


# --- calibration


def recovery(rank, inside=True):
    truth = calibration.CALIBRATED
    rows = [{"rank": position, **truth} for position in range(1, 13)]
    for row in rows:
        if row["rank"] != rank:
            row["snow.cohesion"] = 0.05
    ranges = pd.DataFrame(
        {
            "parameter": list(truth),
            "low": [0.5 * value for value in truth.values()],
            "high": [1.5 * value for value in truth.values()],
            "lower_95": [value * (0.9 if inside else 1.1) for value in truth.values()],
            "upper_95": [1.2 * value for value in truth.values()],
            "open": "",
        }
    )
    return calibration.Recovery(pd.DataFrame(rows), ranges)


def test_calibration_claims():
    ranks = [recovery(1), recovery(12), recovery(3)]
    assert verdicts(calibration.is_ranked_well, *ranks) == ORDER
    both = [recovery(1), recovery(1, inside=False)]
    assert verdicts(calibration.is_in_the_ranges, *both) == (CONFIRMED, CONTRADICTED)
    ranges = recovery(1, inside=False).ranges.tail(1)  # of one parameter
    for open_, verdict in (("", UNDECIDED), ("above", UNDECIDED), ("below", CONFIRMED)):
        single = calibration.Recovery(recovery(1).ranked, ranges.assign(open=open_))
        assert calibration.is_in_the_ranges(single).verdict == verdict
    assert calibration.is_the_laboratory(recovery(1)).verdict == UNDECIDED
    (judged,) = judge(calibration.CALIBRATION[1:2], recovery(99))
    assert judged.finding.verdict == UNDECIDED
