"""Single deviations from the thesis: their panels, their runs, and the texts on changes."""

import json
import math

import numpy as np
import pandas as pd
import pytest
from reproduce_helpers import TINY, few_fits, fill
from reproductions.frischholz2023 import studies, variants
from reproductions.frischholz2023.deviations import DEVIATIONS, THESIS_DX
from reproductions.frischholz2023.sections import deviations as section
from reproductions.frischholz2023.settings import FULL, MIDDLE, QUICK
from reproductions.frischholz2023.stages import ThesisComputation
from reproductions.frischholz2023.variant_errors import variant_errors

from snowshed import Scene, Simulation
from snowshed._core import InputError
from snowshed.analysis.regression import CrossValidation
from snowshed.analysis.regression.geometry import DAMPING_RATE


def stacks(**factors):
    """Stacks of three panels, and of variants that multiply their height and length by factors."""
    rows = []
    for name, (height, length) in {"defaults": (1.0, 1.0), **factors}.items():
        for panel, wobble in ((1.0, 0.99), (2.0, 1.0), (3.0, 1.01)):
            for event in (1, 2):
                noise = 1.0 if name == "defaults" else wobble
                row = {"variant": name, "same_runs": name == "defaults", "dx": 0.02, "seed": 1}
                row.update({"panel.tilt": 40.0, "panel.height": panel, "panel.length": 1.0})
                row.update(event=event, outermost_first_height_m=0.1 * panel * height * noise)
                row["outermost_first_length_m"] = 0.5 * event * length
                row["equal_pace_height_m"] = 0.1 * panel
                row["equal_pace_length_m"] = event
                rows.append(row)
    return pd.DataFrame(rows)


@pytest.mark.parametrize("settings", [QUICK, MIDDLE, FULL], ids=["quick", "middle", "full"])
def test_the_sample_covers_tilts_and_lengths(settings):
    panels = studies.sampled_panels(settings)
    count = len(panels["panel.tilt"])
    assert count >= 3 and max(panels["panel.length"]) <= settings.deviation_max_length
    assert len(set(zip(*panels.values()))) == count
    if settings is not QUICK:
        assert set(panels["panel.tilt"]) == {40, 50, 60, 70}
        steep = {x for x, t in zip(panels["panel.length"], panels["panel.tilt"]) if t > 40}
        assert len(steep) > 1, "the same length again and again"


def test_variants_share_panels_and_differ_only_in_their_deviation():
    scenes = {
        study.name: [json.loads(run.scene) for run in study.runs()]
        for study in studies.deviations(FULL)
    }
    assert list(scenes) == [
        f"deviations-{name}" for name in ("defaults", *list(DEVIATIONS)[:5], "thesis")
    ]
    for name, variant_scenes in scenes.items():
        panels = [
            (s["panel"]["tilt"], s["panel"]["height"], s["panel"]["length"]) for s in variant_scenes
        ]
        assert panels == [
            (s["panel"]["tilt"], s["panel"]["height"], s["panel"]["length"])
            for s in scenes["deviations-defaults"]
        ], name
    dx = {name: variant_scenes[0]["numerics"]["dx"] for name, variant_scenes in scenes.items()}
    assert dx["deviations-grid"] == dx["deviations-thesis"] == 0.01
    assert {dx[f"deviations-{name}"] for name in ("defaults", "slip", "frames")} == {0.015}
    assert studies.study_of("trimming") == "deviations-defaults"


def test_only_the_thesis_damps_by_a_share_per_step():
    numerics = {
        study.name: json.loads(study.runs()[0].scene)["numerics"]
        for study in (*studies.deviations(FULL), *studies.variations(FULL))
    }
    rates = {name: settings.get("damping_rate") for name, settings in numerics.items()}
    assert rates["deviations-defaults"] == rates["variations-short-steps"] == DAMPING_RATE
    assert rates["deviations-damping"] is rates["deviations-thesis"] is None
    assert numerics["deviations-damping"]["flip_ratio"] == 0.99
    assert rates["variations-half-damping"] == DAMPING_RATE / 2
    # The rate damps as the thesis's share per step does, with the thesis's cells and steps.
    scene = Scene.preset("geometry").update({"numerics.dx": THESIS_DX, "events.count": 1})
    simulation = Simulation(scene.update({"panel.length": 0.2, "seeding.particles_per_voxel": 4}))
    simulation.begin_event()
    simulation.step(20)
    share = -math.log(0.99) / (simulation.time / 20)
    assert share == pytest.approx(DAMPING_RATE, rel=0.05)


def test_regressions_of_variants_have_a_row_for_each_reading_and_model():
    scheme = CrossValidation(rounds=1, folds=2, inner_folds=2)
    rng = np.random.default_rng(1)
    table = pd.concat(
        [stacks(reseed=(1.5, 1.0)).assign(**{"panel.length": x}) for x in range(1, 5)]
    )
    for column in table.filter(like="length_m"):
        table[column] *= rng.uniform(0.9, 1.1, len(table))
    with few_fits():
        errors = variant_errors(table, scheme, jobs=1)
    assert len(errors) == 2 * 2 * 2 and set(errors["rows"]) == {24}
    median = errors.set_index(["variant", "trimming", "model"])["Q2"]
    changed = median["reseed"] / median["defaults"]
    assert changed["outermost_first", "rbf"] == pytest.approx(1.5, rel=0.15)
    assert changed["equal_pace", "rbf"] == pytest.approx(
        1.0, rel=0.15
    )  # `stacks` keeps this reading constant


def test_a_change_is_the_mean_over_panels():
    table = stacks(reseed=(1.2, 0.8), frames=(1.0, 1.0))
    height = variants.change(table, "reseed", "height")
    assert height.value == pytest.approx(0.2, abs=1e-3)
    assert height.noise == pytest.approx(1.2 * 0.01 / math.sqrt(3) * 2.26, rel=0.02)
    length = variants.change(table, "reseed", "length")
    assert (length.value, length.noise) == (pytest.approx(-0.2), pytest.approx(0.0, abs=1e-12))
    assert variants.change(table, "reseed", "ratio").value == pytest.approx(0.5, abs=1e-3)
    with pytest.raises(LookupError, match="stacks of slip"):
        variants.change(table, "slip", "ratio")


def test_the_deviation_in_trimming_compares_readings_of_the_same_stacks():
    table = stacks()
    both = pd.concat([table, table.assign(variant="trimming", same_runs=True)])
    assert variants.change(both, "trimming", "length").value == pytest.approx(1.0)
    assert variants.change(both, "trimming", "height").value == pytest.approx(0.0)
    ours, theirs = (
        variants.quartiles(table, trimming) for trimming in ("outermost_first", "equal_pace")
    )
    np.testing.assert_allclose(ours, 2 * np.array(theirs))


def test_the_sum_of_deviations_is_given_with_and_without_trimming():
    table = stacks(thesis=(1.1, 1.0))
    rows = {row[0]: row[1:] for row in section.changes_grid(table).rows}
    assert rows["all except the trimming"][0].startswith("+10 ± ")
    assert rows["all: the preset thesis"][1].startswith("+100 ± ")


def test_deviations_are_sorted_by_size():
    table = stacks(slip=(1.0, 1.1), reseed=(1.2, 0.8), frames=(0.9, 1.0))
    assert variants.by_size(table) == ["reseed", "frames", "slip"]
    grid = section.changes_grid(table)
    assert [row[0] for row in grid.rows] == ["reseed", "frames", "slip"]
    assert grid.rows[0][3].startswith("+50 ± ")


def test_a_deviation_without_changed_scenes_is_marked_as_not_switched():
    table = stacks(slip=(1.0, 1.0))
    table.loc[table["variant"] == "slip", "same_runs"] = True
    assert section.changes_grid(table).rows[0][0] == "slip (not switched)"
    assert len(section.quartiles_grid(table).rows) == 2 + 1  # both readings, and the thesis


def test_the_section_is_written_from_the_store(tmp_path):
    computation = ThesisComputation(tmp_path / "out", TINY, None)
    assert computation.study_stages["deviations"].state().done == 0  # enters the studies
    with pytest.raises(InputError, match="no panel of the sample is computed yet"):
        section.build(computation)
    fill(computation, ["deviations", "variations"])
    content = section.build(computation)
    titles = [title for title, _ in content.tables]
    assert len(titles) == 4 and "by both trimming rules" in titles[3]
    file = tmp_path / "out" / "deviations" / "stacks.csv"
    stored = variants.read_variants_file(file)
    assert set(stored["variant"]) == {*studies.VARIANTS, *studies.VARIATIONS}
    (tmp_path / "not.csv").write_text("variant\nslip\n")
    with pytest.raises(InputError, match=r"not\.csv: no column dx, equal_pace_height_m"):
        variants.read_variants_file(tmp_path / "not.csv")
