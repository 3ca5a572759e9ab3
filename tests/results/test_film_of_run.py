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


def remove_film_record(checkpoint):
    """Turn a checkpoint into one of an earlier version, which does not record the film."""
    content = checkpoint.read_bytes().replace(b"film\0\0\0\0", b"mlif\0\0\0\0")[:-8]
    state = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", content):
        state = (state ^ word) * 0x9E3779B97F4A7C15 % 2**64
        state ^= state >> 32
    checkpoint.write_bytes(content + struct.pack("<Q", state))


@pytest.fixture(scope="module")
def with_snapshots(tmp_path_factory):
    """A run of one event with film frames and snapshots at the same times."""
    folder = tmp_path_factory.mktemp("snapped") / "results"
    scene = tiny_scene(**{"events.count": 1, "output.snapshot_interval": 0.05})
    run_events(scene.set("output.film_interval", 0.05), folder, pictures=False)
    return Results(folder)


def test_frames_agree_with_the_particles_at_the_end_of_each_event(finished):
    results = Results(finished)
    last = {frame.event: frame for frame in results.film}
    for event, frame in last.items():
        particles = results.particles(event)
        assert np.array_equal(frame.ids, particles.particle)
        assert np.abs(frame.positions - particles.position).max() <= HALF_MILLIMETRE
        assert np.array_equal(frame.events, particles.event)


def test_frames_agree_with_snapshots_of_the_same_times(with_snapshots):
    film = with_snapshots.film_dataset()
    times = film.time.to_numpy()
    compared = 0
    for snapshot in with_snapshots.snapshots():
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


def test_a_film_stores_few_quantities(with_snapshots):
    """Each takes half a byte per particle and frame; the demo's page must stay below 5 MB."""
    names = {quantity.name for quantity in with_snapshots.film.quantities}
    assert names == {"speed", "density", "pressure", "volumetric_plastic_strain"}


def test_a_truncated_film_is_resumed_to_the_same_bytes(tmp_path, tiny):
    checkpoints = []

    def halt(progress):
        if progress.event == 2 and not checkpoints:
            checkpoints.append((tmp_path / "checkpoint.bin").read_bytes())

    run_events(tiny, tmp_path, progress=halt, pictures=False)
    film = tmp_path / "film.bin"
    complete = film.read_bytes()
    (tmp_path / "checkpoint.bin").write_bytes(checkpoints[0])
    film.write_bytes(complete[: len(complete) - 100])
    assert not Film(film).whole
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == complete


def halted_in_event_2(folder, tiny):
    """Run to the end, with the checkpoint of the second event in the folder."""
    checkpoints = []

    def halt(progress):
        if progress.event == 2 and not checkpoints:
            checkpoints.append((folder / "checkpoint.bin").read_bytes())

    run_events(tiny, folder, progress=halt, pictures=False)
    (folder / "checkpoint.bin").write_bytes(checkpoints[0])


def test_a_lost_film_begins_where_the_run_resumes(tmp_path, tiny):
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    film.unlink()
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert {frame.event for frame in Film(film).frames} == {2}
    assert Results(tmp_path).film.closed


def test_a_run_resumes_only_with_its_own_film(tmp_path, tiny):
    """A film that is damaged, cut, or from another run is refused by name."""
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    complete = film.read_bytes()
    interrupted = Film(film)
    first = next(k for k, frame in enumerate(interrupted.frames) if frame.event == 2)
    assert first > 3
    frames = film_files.falling_film(40, 6)
    for content in (
        *(b"", b"damaged", complete[:300], complete[: len(complete) // 3]),
        *(
            complete[:at] + bytes([complete[at] ^ 8]) + complete[at + 1 :]
            for at in range(5, 3000, 211)
        ),
        film_files.film_bytes(frames, closed=True),
        film_files.film_bytes(frames, version=1),
    ):
        film.write_bytes(content)
        with pytest.raises(InputError, match=r"film\.bin.*restore the file, or remove it"):
            run_events(tiny, tmp_path, resume=True, pictures=False)
        assert film.read_bytes() == content
    film.write_bytes(complete)
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == complete


def test_frames_after_the_checkpoint_are_recorded_again(tmp_path, tiny):
    """A power failure can leave any bytes there."""
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    complete = film.read_bytes()
    film.write_bytes(complete[:-200] + bytes(200))
    with pytest.raises(InputError, match="damaged"):
        _ = Results(tmp_path).film
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == complete


def test_a_film_of_an_earlier_version_is_resumed(tmp_path, tiny):
    halted_in_event_2(tmp_path, tiny)
    film = tmp_path / "film.bin"
    complete = film.read_bytes()
    film.write_bytes(film_files.as_version_1(complete))
    remove_film_record(tmp_path / "checkpoint.bin")
    run_events(tiny, tmp_path, resume=True, pictures=False)
    assert film.read_bytes() == complete


def test_without_the_setting_no_film_is_written(tmp_path, tiny):
    run_events(tiny.update({"output.film": False, "events.count": 1}), tmp_path, pictures=False)
    assert not (tmp_path / "film.bin").exists()
    with pytest.raises(InputError, match=r"output\.film"):
        _ = Results(tmp_path).film


def test_a_film_of_many_particles_records_a_share(tmp_path):
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


def test_slides_and_grains_record_films(tmp_path):
    for name in ("s", "g"):
        (tmp_path / name).mkdir()
    slide = example_slide(tmp_path / "s").update({"events.max_time": 2.0})
    run(slide, tmp_path / "slide", pictures=False, compact=True)
    film = Film(tmp_path / "slide" / "film.bin")
    assert len(film.frames) > 3 and "thickness" in {quantity.name for quantity in film.quantities}
    grains = example_grains(tmp_path / "g").set("loading.0.strain", 0.001)
    run(grains, tmp_path / "grains", pictures=False)
    film = Film(tmp_path / "grains" / "film.bin")
    (first, *_) = film
    assert (first.radii > 0).all() and film.quantum < 0.05 * np.median(first.radii)


def test_a_dataset_that_exceeds_the_memory_is_refused(finished, monkeypatch):
    import snowshed._core as _core

    monkeypatch.setattr(_core, "available_memory_bytes", lambda: 1000)
    with pytest.raises(InputError, match="every=2"):
        Results(finished).film_dataset()
    with pytest.raises(InputError, match="every"):
        Results(finished).film_dataset(every=0)
