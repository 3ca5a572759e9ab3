"""Variants of a loading test, and how their stresses compare with the base."""

import numpy as np
import pandas as pd
import pytest
from helpers.grain_files import column_of_grains
from scipy import stats

from snowshed import GrainsSettings, InputError, LoadingStage
from snowshed.analysis.grains.figures import sensitivity_figure
from snowshed.analysis.grains.ratios import STRESSES, compare_variants
from snowshed.analysis.grains.samples import LabelledSample
from snowshed.analysis.grains.sensitivity import evaluate_variants
from snowshed.analysis.grains.variants import BASE, sensitivity_variants


def columns(count):
    """Return columns of grains whose last grain differs in height."""
    return [
        LabelledSample(
            f"c{n}", column_of_grains(4, 4)[: 16 - n, :, :].repeat(3, 1).repeat(3, 2), 5e-5
        )
        for n in range(count)
    ]


def variants(folder, **options):
    settings = GrainsSettings(density_scaling=5.0)
    return sensitivity_variants(columns(2), folder, LoadingStage(speed=0.02), settings, **options)


def test_each_variant_differs_from_the_base_in_one_respect(tmp_path):
    sensitivity = variants(tmp_path)
    base = {("base", n): "" for n in range(2)}
    assert sensitivity.variants[0].name == BASE and not sensitivity.variants[0].changes
    names_by_varied = {}
    for variant in sensitivity.variants[1:]:
        other_sample = list(variant.samples) != list(sensitivity.variants[0].samples)
        assert other_sample != bool(variant.changes), variant.name
        values = set(variant.changes.values())
        assert len(values) <= 1, variant.name  # both bond strengths get the same value
        names_by_varied.setdefault(variant.varied, []).append(variant.name)
    assert set(names_by_varied) == {
        "friction", "elastic modulus", "strength of bonds", "density of ice", "speed",
        "sphere size", "volume",
    }  # fmt: skip
    assert (
        "density of ice x 50" in names_by_varied["density of ice"]
        and len(names_by_varied["density of ice"]) == 1
    )
    assert len(sensitivity.study().runs()) == 2 * len(sensitivity.variants)
    assert (
        len(sensitivity.hashes())
        == len(set(sensitivity.hashes().values()))
        == 2 * len(sensitivity.variants)
    )
    assert set(base) <= set(sensitivity.hashes())


def test_finer_spheres_need_finer_voxels(tmp_path):
    with pytest.raises(InputError, match="no finer voxels"):
        variants(tmp_path, finer=True)


def test_ratios_are_paired_with_students_interval():
    rows = {BASE: [10.0, 30.0, 20.0], "rough": [14.0, 45.0, 26.0], "odd": [5.0, 90.0, np.nan]}
    table = pd.DataFrame(
        [
            {"variant": name, "varied": name, "sample": n, "strength_pa": value}
            for name, values in rows.items()
            for n, value in enumerate(values)
        ]
    )
    ratios = compare_variants(table).set_index("variant")
    logs = np.log([1.4, 1.5, 1.3])
    low, high = stats.t.interval(0.95, 2, logs.mean(), logs.std(ddof=1) / np.sqrt(3))
    rough = ratios.loc["rough"]
    assert rough["ratio"] == pytest.approx(np.exp(logs.mean()))
    assert (rough["low"], rough["high"]) == pytest.approx((np.exp(low), np.exp(high)))
    assert rough["distinct"] and not ratios.loc["odd", "distinct"]
    assert ratios.loc["odd", "samples"] == 2  # the third has no value
    assert ratios.loc[BASE, "scatter"] == pytest.approx(np.log([10, 30, 20]).std(ddof=1))


def test_without_the_base_nothing_is_compared():
    with pytest.raises(InputError, match="base"):
        compare_variants(pd.DataFrame({"variant": ["rough"], "sample": [0], "strength_pa": [1.0]}))


def test_variants_are_computed_and_evaluated(tmp_path):
    """Columns of grains, loaded for an instant, give a table and a figure."""
    stage = LoadingStage(speed=0.1, strain=2e-4)
    settings = GrainsSettings(density_scaling=1e4)
    sensitivity = sensitivity_variants(columns(2), tmp_path / "samples", stage, settings)
    sensitivity.study().compute(tmp_path / "runs", jobs=1, threads=1)
    table = evaluate_variants(sensitivity, tmp_path / "runs", tmp_path)
    assert set(table["variant"]) == {variant.name for variant in sensitivity.variants}
    read = pd.read_csv(tmp_path / "sensitivity.csv")
    assert read["ratio"].tolist() == pytest.approx(table["ratio"].tolist(), nan_ok=True)
    assert (tmp_path / "sensitivity.png").stat().st_size > 1e4
    assert len(pd.read_csv(tmp_path / "tests.csv")) == 2 * len(sensitivity.variants)
    (axes,) = sensitivity_figure(table).axes  # the tests end before the other stresses
    assert axes.get_title(loc="left").startswith(STRESSES["strength_pa"])
