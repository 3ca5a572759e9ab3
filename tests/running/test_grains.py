"""Runs of loading tests: figures, curve, resuming, snapshots, energies."""

import csv
import json

import numpy as np
import pytest
from helpers.grain_files import VOXEL, column_of_grains, write_labels

from snowshed import GrainsSettings, InputError, LoadingStage
from snowshed.analysis.tomography.example import example_grains
from snowshed.analysis.tomography.sphere_packing import sphere_snow
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import record_notes
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.grains.curve import LoadingCurve, carried_stress
from snowshed.methods.grains.strength_scatter import recorded_scatter, scatter_words
from snowshed.methods.grains.summary import GrainsSummary
from snowshed.running.run import run
from snowshed.running.sequence import open_sequence
from snowshed.scene import grains_scene


@pytest.fixture
def scene(tmp_path):
    """Three stacked cubes, compressed by a five-hundredth of their height."""
    return grains_scene(
        write_labels(tmp_path),
        VOXEL,
        [LoadingStage(kind="compress", strain=2e-3, speed=0.05)],
        settings=GrainsSettings(density_scaling=100.0, threads=1),
    ).update({"gravity": 0})


def test_synthetic_samples_are_marked(scene, tmp_path):
    """The sample's folder or the title marks them; a user's own image is not marked."""
    short = scene.set("loading.0.strain", 1e-5)
    assert run(short, tmp_path / "own", pictures=False).summary.synthetic is None
    facts = {"voxel_size_m": VOXEL, "synthetic": True, "source": "synthetic: by hand"}
    (tmp_path / "microstructure.json").write_text(json.dumps(facts))
    run(short, tmp_path / "made", pictures=False)
    stored = json.loads((tmp_path / "made/grains.json").read_text())
    assert stored["synthetic"] == "synthetic: by hand"
    (tmp_path / "microstructure.json").unlink()
    titled = short.set("title", "synthetic: elsewhere")
    assert run(titled, tmp_path / "titled", pictures=False).summary.synthetic is not None


def test_figures_agree_with_the_curve(scene, tmp_path):
    summary = run(scene, tmp_path / "out", pictures=False).summary
    curve = LoadingCurve.read(tmp_path / "out/curve.csv")
    stored = json.loads((tmp_path / "out/grains.json").read_text())
    assert stored["ended"] == summary.ended == "rest"
    assert (summary.final_particles, summary.bonds) == (3, 2 * 16)
    assert summary.spheres == 3 * (4**3 - 2**3)  # inner voxels are left out
    assert summary.density_kg_m3 == pytest.approx(917.0)
    assert curve["axial_strain"][0] == pytest.approx(0.0, abs=1e-12)
    assert curve["axial_strain"][-1] == pytest.approx(2e-3, rel=0.02)
    assert summary.axial_strain == curve["axial_strain"][-1]
    assert 100 < len(curve) <= 302


def test_the_modulus_of_a_column_follows_from_its_springs(scene, tmp_path):
    """Four layers in series, between grains and at the plates, of 16 springs with E r each."""
    scene.update({"loading.0.strain": 2e-4, "loading.0.speed": 0.002})
    scene.update({"numerics.density_scaling": 1.0, "numerics.damping": 0.5})
    summary = run(scene, tmp_path / "out", pictures=False).summary
    radius, modulus = VOXEL / 2, 1e9
    stiffness = 16 * modulus * radius / 4
    expected = stiffness * (24 * radius) / (8 * radius) ** 2
    assert summary.tangent_modulus_pa == pytest.approx(expected, rel=0.005)
    assert summary.linearity > 0.999
    assert summary.broken_in_tension == summary.broken_in_shear == 0


def test_a_column_is_as_strong_as_its_bonds(scene, tmp_path):
    scene.update({"loading.0.kind": "stretch", "loading.0.strain": 1e-3, "loading.0.speed": 0.005})
    scene.update({"numerics.density_scaling": 1.0, "numerics.damping": 0.5})
    scene.update({"numerics.bonded_plates": True, "numerics.tensile_strength": 8e5})
    summary = run(scene, tmp_path / "out", pictures=False).summary
    assert summary.strength_pa == pytest.approx(8e5, rel=0.03)
    assert summary.bonds == 4 * 16  # with those to the plates
    assert summary.broken_in_tension > 0 and summary.broken_in_tension % 16 == 0


def test_an_interrupted_test_resumes_to_the_same_files(scene, tmp_path):
    run(scene, tmp_path / "whole", pictures=False)

    def stop(progress):
        if progress.time > 0.0:
            raise KeyboardInterrupt

    with pytest.raises((Interrupted, KeyboardInterrupt)):
        run(scene, tmp_path / "two", progress=stop, pictures=False)
    run(scene, tmp_path / "two", resume=True, pictures=False)
    for name in ("curve.csv", "grains.json", "contacts.csv"):
        expected, resumed = ((tmp_path / folder / name).read_bytes() for folder in ("whole", "two"))
        assert expected == resumed


def test_a_test_killed_before_its_first_event_makes_the_same_film(scene, tmp_path):
    """The film's resolution depends on the grains, which exist only from the first event on."""
    run(scene, tmp_path / "whole", pictures=False)
    with open_sequence(scene.resolve(), tmp_path / "two", resume=False):
        pass
    run(scene, tmp_path / "two", resume=True, pictures=False)
    expected, resumed = (
        (tmp_path / folder / "film.bin").read_bytes() for folder in ("whole", "two")
    )
    assert expected == resumed


def test_threads_do_not_change_the_curve(scene, tmp_path):
    for threads in (1, 2):
        scene.set("numerics.threads", threads)
        run(scene, tmp_path / str(threads), pictures=False)
    single, parallel = ((tmp_path / f"{n}/curve.csv").read_bytes() for n in (1, 2))
    assert single == parallel


def test_the_energy_balance_is_written(scene, tmp_path):
    run(scene.set("output.energy", True), tmp_path / "out", pictures=False)
    run(scene, tmp_path / "out", pictures=False, resume=True)  # adds no second row
    (row,) = list(csv.DictReader((tmp_path / "out/energy.csv").open()))
    curve = LoadingCurve.read(tmp_path / "out/curve.csv")
    assert set(curve.energies) == set(row) - {"event"}
    for name in curve.energies:
        # The table is rounded.
        assert curve[name][-1] == pytest.approx(float(row[name]), rel=1e-7, abs=1e-20)
    assert curve["boundary_work_j"][-1] > 0
    assert abs(curve["residual_j"]).max() < 0.01 * curve["boundary_work_j"][-1]


def test_snapshots_hold_the_spheres_of_the_grains(scene, tmp_path):
    scene.set("output.snapshot_interval", 1e-5)
    summary = run(scene, tmp_path / "out", pictures=False).summary
    files = sorted((tmp_path / "out/snapshots").glob("*.vtp"))
    assert len(files) > 3
    snapshot = read_particles(files[0])
    assert len(snapshot["grain"]) == summary.spheres
    labels = column_of_grains()
    assert (np.bincount(snapshot["grain"]) == (labels == 1).sum() - 8).all()
    assert (snapshot["bonded_grains"][snapshot["grain"] == 1] == 2).all()


def test_the_strength_agrees_with_a_finely_sampled_run(scene, tmp_path):
    """Many short stages have a row for nearly every step; the steps are those of a single stage."""
    snow = sphere_snow((16, 16, 16), VOXEL, diameter=5e-4, density=300, seed=1)
    write_labels(tmp_path, snow.labels)
    scene.set("loading.0.strain", 0.04)
    coarse = run(scene, tmp_path / "coarse", pictures=False).summary
    curve = LoadingCurve.read(tmp_path / "coarse/curve.csv")
    parts = 50
    stage = {**scene.resolve().data["loading"][0], "strain": 0.04 / parts}
    run(scene.set("loading", [stage] * parts), tmp_path / "fine", pictures=False)
    rows = LoadingCurve.read(tmp_path / "fine/curve.csv")
    assert len(rows) > 10 * len(curve)
    finest = carried_stress(rows, "compress").max()
    sampled = carried_stress(curve, "compress").max()
    assert coarse.strength_pa > 1.001 * sampled
    assert coarse.strength_pa == pytest.approx(finest, rel=2e-3)


def test_the_scatter_between_samples_stands_beside_the_strength(scene, tmp_path):
    summary = run(scene, tmp_path / "out", pictures=False).summary
    assert summary.lines()["strength"].endswith("MPa, scatter between samples not known")
    assert any("scatter is not known: load several" in note for note in summary.notes)
    assert GrainsSummary.read(tmp_path / "out").strength_scatter == summary.strength_scatter
    known = recorded_scatter(110, 310.0, 5e-5, "compress")
    assert scatter_words(known) == "scatter between samples 30 %"
    for other in (
        (110, 310.0, 5e-5, "stretch"),
        (400, 310.0, 5e-5, "compress"),
        (110, 200.0, 5e-5, "compress"),
        (110, 310.0, 2e-5, "compress"),
    ):
        assert recorded_scatter(*other) is None


def test_without_contact_with_the_plates_figures_are_null(scene, tmp_path):
    labels = column_of_grains()
    labels[:2] = labels[-2:] = 0
    write_labels(tmp_path, labels)
    summary = run(scene, tmp_path / "out").summary
    stored = json.loads((tmp_path / "out/grains.json").read_text())
    assert stored["strength_pa"] is stored["tangent_modulus_pa"] is summary.strength_pa is None
    assert "the plates never touched the snow" in " ".join(stored["notes"])


def test_labels_with_several_pieces_are_noted_and_recorded(scene, tmp_path):
    labels = column_of_grains()
    labels[labels == 3] = 1
    write_labels(tmp_path, labels)
    short = scene.set("loading.0.strain", 1e-5)
    with record_notes() as notes:
        summary = run(short, tmp_path / "out", pictures=False).summary
    assert notes == [*summary.sample_notes, *summary.notes]
    assert "1 of 2 labels lie in several places, 3 pieces in all" in notes[0]
    assert json.loads((tmp_path / "out/grains.json").read_text())["sample_notes"] == notes[:1]
    split = run(short.set("sample.split_labels", True), tmp_path / "split", pictures=False).summary
    assert (summary.final_particles, split.final_particles) == (2, 3)


def test_a_scene_of_an_earlier_version_is_resumed(scene, tmp_path):
    """It does not have the key of split labels."""
    short = scene.set("loading.0.strain", 1e-5)
    run(short, tmp_path / "out", pictures=False)
    data = json.loads((tmp_path / "out/scene.json").read_text())
    del data["sample"]["split_labels"]
    (tmp_path / "out/scene.json").write_text(json.dumps(data))
    run(tmp_path / "out/scene.json", tmp_path / "out", resume=True, pictures=False)


def test_the_example_draws_its_pictures(tmp_path):
    scene = example_grains(tmp_path).set("loading.0.strain", 1e-3)
    run(scene, tmp_path / "out")
    for name in ("grains.png", "forces.png"):
        assert (tmp_path / "out" / name).stat().st_size > 10_000


def test_progress_begins_at_once_and_names_the_stage(scene, tmp_path):
    reports = []
    run(scene, tmp_path / "out", progress=reports.append, pictures=False)
    assert reports[0].fraction == 0.0 and reports[-1].fraction == 1.0
    assert reports[0].doing.startswith("stage 1 of 1, compress: 0.0%")


def test_other_methods_have_no_curve(tmp_path):
    from snowshed import Scene, _core

    resolved = Scene.preset("lab-50").resolve()
    with pytest.raises(InputError, match='/method: is not "grains"'):
        _core.Simulation(resolved.json).grains_curve()
