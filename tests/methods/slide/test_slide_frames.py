"""A slide over time, from its film."""

import numpy as np
import pytest

from snowshed import InputError
from snowshed.io.film import Film
from snowshed.methods.slide.frames import Frame, slide_frames
from snowshed.methods.slide.maps import slide_maps
from snowshed.running.run import run
from snowshed.scene import Scene, example_slide
from snowshed.scene.terrain_grid import slide_terrain


def test_a_frame_returns_its_values_in_any_window():
    frame = Frame(0.0, np.full((3, 3), 9.0, dtype=np.float32), 5, 2)
    window = frame.window(slice(4, 9), slice(0, 6))
    expected = np.zeros((5, 6))
    expected[1:4, 2:5] = 9.0
    assert (window == expected).all()
    assert (frame.window(slice(6, 7), slice(3, 4)) == 9.0).all()
    assert not frame.window(slice(10, 15), slice(0, 6)).any()


@pytest.fixture(scope="module")
def slide(tmp_path_factory) -> tuple[Scene, Film]:
    folder = tmp_path_factory.mktemp("slide")
    scene = example_slide(folder).set("events.max_time", 3.0)
    run(scene, folder / "out", pictures=False)
    return scene, Film(folder / "out/film.bin")


def test_the_last_frame_shows_the_snow_at_the_end(slide):
    """Nodes have a thickness only near particles, of about the particles' thickness."""
    scene, film = slide
    frames = slide_frames(film, slide_terrain(scene))
    import snowshed._core as core

    resolved = scene.resolve()
    simulation = core.Simulation(resolved.json, resolved.base_dir)
    simulation.begin_event()
    while simulation.time_s < frames[-1].time - 1e-9:
        simulation.step(1)
    truth = slide_maps(simulation).thickness
    thickness = frames[-1].window(*(slice(0, size) for size in truth.shape))
    # Positions are rounded, so that a particle at the very border of a cell may change it.
    assert ((thickness > 0) != (truth > 0)).sum() <= 2
    inside = truth > 0.5 * truth.max()
    assert np.abs(thickness - truth)[inside].mean() < 0.1 * truth[inside].mean()


def test_a_thinned_film_has_no_holes(slide):
    scene, film = slide
    ground = slide_terrain(scene)
    full = slide_frames(film, ground)[0]

    class Thinned(Film):
        def __iter__(self):
            for frame in super().__iter__():
                chosen = frame.ids % 9 == 0
                yield type(frame)(
                    frame.time, frame.event, frame.ids[chosen], frame.events[chosen],
                    frame.materials[chosen], frame.radii, frame.positions[chosen],
                    frame.codes[chosen],
                )  # fmt: skip

    thinned = Thinned(film.path)
    thinned.share = 1 / 9
    frames = slide_frames(thinned, ground, most=2)
    assert len(frames) == 2
    area = tuple(slice(0, size) for size in ground.heights.shape)
    snow, thinned_snow = (frame.window(*area) > 0 for frame in (full, frames[0]))
    assert (snow & ~thinned_snow).sum() < 0.1 * snow.sum()
    middle = np.argwhere(snow).mean(axis=0) - np.argwhere(thinned_snow).mean(axis=0)
    assert np.abs(middle).max() < 1.0  # cell


def test_the_film_of_another_method_is_refused(tmp_path):
    from snowshed import run_events

    tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    run_events(tiny, tmp_path, pictures=False)
    ground = type("Ground", (), {"cell": 1.0, "heights": np.zeros((2, 2))})()
    with pytest.raises(InputError, match="not the film of a slide; it holds no thickness"):
        slide_frames(Film(tmp_path / "film.bin"), ground)
