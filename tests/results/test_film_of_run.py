"""The film that a run records, beside its particles and its snapshots."""

import struct

import numpy as np
import pytest
from conftest import tiny_scene
from helpers import film_files

from snowshed import InputError, Results, run_events
from snowshed.analysis.tomography.example import example_grains
from snowshed.io.film import Film
from snowshed.running.run import run
from snowshed.scene import example_slide

HALF_MILLIMETRE = 5e-4


def forget_the_film(checkpoint):
    """Make a checkpoint one of the version before, which says nothing of the film."""
    content = checkpoint.read_bytes().replace(b"film\0\0\0\0", b"mlif\0\0\0\0")[:-8]
    state = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", content):
        state = (state ^ word) * 0x9E3779B97F4A7C15 % 2**64
        state ^= state >> 32
    checkpoint.write_bytes(content + struct.pack("<Q", state))


@pytest.fixture(scope="module")
def snapped(tmp_path_factory):
    """A run of one event whose film and snapshots are of the same times."""
    folder = tmp_path_factory.mktemp("snapped") / "results"
    scene = tiny_scene(**{"events.count": 1, "output.snapshot_interval": 0.05})
    run_events(scene.set("output.film_interval", 0.05), folder, pictures=False)
    return Results(folder)


def test_frames_agree_with_the_particles_at_the_end_of_each_event(finished):
    results = Results(finished)
    last = {one.event: one for one in results.film}  # the last of each event
    for event, frame in last.items():
        particles = results.particles(event)
        assert np.array_equal(frame.ids, particles.particle)
        assert np.abs(frame.positions - particles.position).max() <= HALF_MILLIMETRE
        assert np.array_equal(frame.events, particles.event)


def test_frames_agree_with_snapshots_of_the_same_times(snapped):
    film = snapped.film_dataset()
    times = film.time.to_numpy()
    compared = 0
    for snapshot in snapped.snapshots():
        (same,) = np.flatnonzero(times == float(snapshot.time))
        frame = film.isel(frame=int(same))
        assert np.abs(frame.position - snapshot.position).max() <= HALF_MILLIMETRE
        speed = np.linalg.norm(snapshot.velocity, axis=1)
        for name, values in (("speed", speed), ("density", snapshot.density)):
            step = {"speed": 0.05, "density": 1.0}[name]
            assert frame[name].to_numpy() == pytest.approx(np.asarray(values), abs=step, rel=0.009)
        compared += 1
    assert compared > 5
    assert film.time.attrs["units"] == "s" and film.density.attrs["units"] == "kg/m3"


def test_a_film_keeps_few_quantities(snapped):
    """Each takes half a byte of a particle in a frame; the demo's page must stay below 5 MB."""
    kept = {one.name for one in snapped.film.quantities}
    assert kept == {"speed", "density", "pressure", "volumetric_plastic_strain"}


def test_a_film_that_was_cut_while_it_was_written_goes_on_to_the_same_bytes(tmp_path, tiny):
    halted = []

    def halt(progress):
        if progress.event == 2 and not halted:
            halted.append((tmp_path / "checkpoint.bin").read_bytes())

    run_events(tiny, tmp_path, progress=halt, pictures=False)
    film = tmp_path / "film.bin"
    whole = film.read_bytes()
    (tmp_path / "checkpoint.bin").write_bytes(halted[0])
    film.write_bytes(whole[: len(whole) - 100])
    assert not Film(film).whole
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == whole


def halted_in_event_2(folder, tiny):
    """Run to the end, with the checkpoint of the second event in the folder."""
    halted = []

    def halt(progress):
        if progress.event == 2 and not halted:
            halted.append((folder / "checkpoint.bin").read_bytes())

    run_events(tiny, folder, progress=halt, pictures=False)
    (folder / "checkpoint.bin").write_bytes(halted[0])


def test_a_lost_film_begins_where_the_run_goes_on(tmp_path, tiny):
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    film.unlink()
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert {one.event for one in Film(film).frames} == {2}
    assert Results(tmp_path).film.closed


def test_a_run_goes_on_with_no_other_film_than_its_own(tmp_path, tiny):
    """A film that is damaged, cut, or of another run is refused, and its name is told."""
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    whole = film.read_bytes()
    begun = Film(film)
    first = next(k for k, one in enumerate(begun.frames) if one.event == 2)
    assert first > 3
    frames = film_files.falling_film(40, 6)
    for content in (
        *(b"", b"damaged", whole[:300], whole[: len(whole) // 3]),
        *(whole[:at] + bytes([whole[at] ^ 8]) + whole[at + 1 :] for at in range(5, 3000, 211)),
        film_files.film_bytes(frames, closed=True),
        film_files.film_bytes(frames, version=1),
    ):
        film.write_bytes(content)
        with pytest.raises(InputError, match=r"film\.bin.*restore the file, or remove it"):
            run_events(tiny, tmp_path, resume=True, pictures=False)
        assert film.read_bytes() == content
    film.write_bytes(whole)
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == whole


def test_what_a_film_holds_beyond_the_checkpoint_is_recorded_anew(tmp_path, tiny):
    """A power failure leaves anything there."""
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    whole = film.read_bytes()
    film.write_bytes(whole[:-200] + bytes(200))
    with pytest.raises(InputError, match="damaged"):
        _ = Results(tmp_path).film
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == whole


def test_a_film_of_the_version_before_is_gone_on_with(tmp_path, tiny):
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    whole = film.read_bytes()
    film.write_bytes(film_files.as_version_1(whole))
    forget_the_film(tmp_path / "checkpoint.bin")
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == whole


def test_without_a_film_there_is_none(tmp_path, tiny):
    run_events(tiny.update({"output.film": False, "events.count": 1}), tmp_path, pictures=False)
    assert not (tmp_path / "film.bin").exists()
    with pytest.raises(InputError, match=r"output\.film"):
        _ = Results(tmp_path).film


def test_of_many_particles_some_are_recorded(tmp_path):
    scene = tiny_scene(
        **{
            "numerics.dx": 0.0006,
            "events.count": 1,
            "events.max_time": 1e-6,
            "events.rest_time": 1e-7,
        }
    )
    run_events(scene, tmp_path, pictures=False)
    results = Results(tmp_path)
    all_ids = results.particles(1).particle.to_numpy().astype(np.int64)
    (frame, *_) = results.film
    assert len(all_ids) > 45_000 and 38_000 < len(frame.ids) < 42_000
    share = results.film.share
    chosen = (all_ids * 2654435769 % 2**32) < share * 2**32
    assert np.array_equal(frame.ids, all_ids[chosen])


def test_slides_and_grains_are_filmed_too(tmp_path):
    for name in ("s", "g"):
        (tmp_path / name).mkdir()
    slide = example_slide(tmp_path / "s").update({"events.max_time": 2.0})
    run(slide, tmp_path / "slide", pictures=False, compact=True)
    film = Film(tmp_path / "slide" / "film.bin")
    assert len(film.frames) > 3 and "thickness" in {one.name for one in film.quantities}
    grains = example_grains(tmp_path / "g").set("loading.0.strain", 0.001)
    run(grains, tmp_path / "grains", pictures=False)
    film = Film(tmp_path / "grains" / "film.bin")
    (first, *_) = film
    assert (first.radii > 0).all() and film.quantum < 0.05 * np.median(first.radii)


def test_a_dataset_that_does_not_fit_is_refused(finished, monkeypatch):
    import snowshed._core as _core

    monkeypatch.setattr(_core, "available_memory_bytes", lambda: 1000)
    with pytest.raises(InputError, match="every=2"):
        Results(finished).film_dataset()
    with pytest.raises(InputError, match="every"):
        Results(finished).film_dataset(every=0)
