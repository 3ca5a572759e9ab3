"""Moving views of many particles: how large their pages are, and that they open."""

import pytest
from helpers.pages import Page
from plot.browser import open_page

from snowshed import Results, Scene, run_events
from snowshed.results.view import write_view

MAX_PAGE = 20e6  # bytes, of 30 000 particles in 300 frames
READY = "document.body.dataset.ready === 'true'"


def slab(length, dx, **values):
    """Return the slide of a slab that covers a panel, m; its snow moves until the end."""
    scene = Scene.preset("lab-40").update({"dimension": 3, "numerics.dx": dx, "events.count": 1})
    size = {"length": length, "width": 0.58 * length}
    scene.update({"panel": {**size, "height": 0.5 * length}})
    scene.update({"slab": {**size, "thickness": 0.053 * length}, "events.rest_speed": 1e-6})
    return scene.update(values)


def open_and_capture(page):
    """Return pictures of the canvas at the beginning and at the end, and the errors."""
    with open_page(page, reduced_motion="reduce", width=500, height=500) as (shown, messages):
        shown.wait_for_function(READY, timeout=300_000)
        last = shown.locator("#picture").screenshot(timeout=300_000)
        shown.focus("#picture")
        shown.keyboard.press("Home")
        first = shown.locator("#picture").screenshot(timeout=300_000)
        return first, last, [message for message in messages if not message.startswith("file:")]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("length", "dx", "interval"), [(3.0, 0.06, 0.008), (10.0, 0.2, 0.016)], ids=["3 m", "10 m"]
)
def test_a_long_film_of_thirty_thousand_particles_opens(length, dx, interval, tmp_path):
    """A long event: after 240 frames the interval doubles."""
    times = {"output.film_interval": interval, "events.max_time": 359 * interval}
    run_events(slab(length, dx, **times), tmp_path, pictures=False)
    film = Results(tmp_path).film
    assert len(film.frames) >= 300 and min(frame.particles for frame in film.frames) >= 30_000
    page = write_view(tmp_path)
    size = page.stat().st_size
    print(f"{film.frames[-1].particles} particles, {len(film.frames)} frames: {size / 1e6:.1f} MB")
    assert size < MAX_PAGE
    first, last, errors = open_and_capture(page)
    assert first != last and errors == []


@pytest.mark.slow
def test_a_million_particles_open_as_a_thinned_film(tmp_path):
    times = {"output.film_interval": 0.02, "events.max_time": 0.04, "events.rest_time": 0.03}
    run_events(slab(3.0, 0.0185, **times), tmp_path, pictures=False)
    results = Results(tmp_path)
    assert results.particles(1).sizes["particle"] > 1_000_000
    assert 38_000 < results.film.frames[-1].particles < 42_000
    page = write_view(tmp_path)
    text = " ".join("".join(Page(page.read_text(encoding="utf-8")).text).split())
    assert "The film holds one of 2" in text and "particles, chosen by their ids" in text
    first, last, errors = open_and_capture(page)
    assert first != last and errors == []
