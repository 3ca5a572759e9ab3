"""The interactive view: the contents of the page, and its behaviour in a browser."""

import base64
import json
import re
import shutil
from html import unescape

import numpy as np
import pytest
from helpers import film_files
from helpers.pages import Page
from plot.browser import check_page, open_page
from plot.firefox import open_in_firefox

from snowshed import InputError, Results, Scene
from snowshed.base.messages import HARMFUL
from snowshed.io.film import Film
from snowshed.plot.film_page import VIEWER, MeasureLine, ViewContent, write_view_page
from snowshed.plot.film_summary import summarise_film
from snowshed.plot.solids import Box, scene_solids
from snowshed.results.video import write_video
from snowshed.results.view import view_content, write_view

READY = "document.body.dataset.ready === 'true'"
POST = {"type": "cylinder", "from": [0.9, 0, 0], "to": [0.9, 0, 0.5], "radius": 0.05}
BLOCK = {"type": "box", "center": [0, 0.6, 0.1], "size": [0.2, 0.2, 0.2]}
SCENE = {
    "dimension": 3, "numerics": {"dx": 0.02}, "ground": {"tilt": 0.0},
    "panel": {"height": 0.8, "length": 0.8, "width": 0.6, "tilt": 40.0, "thickness": 0.05},
    "slab": {"thickness": 0.05},
    "obstacles": [
        {"name": "post", "shape": POST},
        {"shape": {"type": "capsule", "from": [-1, 0, 0], "to": [-1, 0, 0.5], "radius": 0.1}},
        {"shape": BLOCK, "motion": {"velocity": [1, 0, 0]}},
    ],
}  # fmt: skip


def test_hostile_texts_of_scene_and_film_are_escaped(tmp_path):
    hostile = "\x1b[2J\u202e$\\frac$<b>\x9b"
    quantity = {"name": hostile, "unit": hostile, "meaning": "," + hostile, "step": 0.01}
    frames = film_files.falling_film(40, 3)
    (tmp_path / "film.bin").write_bytes(film_files.film_bytes(frames, quantities=[quantity]))
    content = ViewContent(
        hostile, hostile, [(hostile, hostile)], [], Box(np.zeros(3), np.ones(3)), [hostile],
        [MeasureLine(1, (0, 0, 0), (1, 0, 0), hostile)],
    )  # fmt: skip
    write_view_page(tmp_path / "view.html", Film(tmp_path / "film.bin"), content)
    text = (tmp_path / "view.html").read_text(encoding="utf-8")
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])
    labels = [
        data["measures"][0]["label"],
        *(colouring["title"] for colouring in data["colourings"]),
    ]
    assert not HARMFUL.search(text + "".join(labels)) and "<b>" not in text


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of a small film, written by hand, with every part that a page may have."""
    folder = tmp_path_factory.mktemp("page")
    file = folder / "film.bin"
    file.write_bytes(film_files.film_bytes(film_files.falling_film(600, 24), share=0.1))
    film = Film(file)
    scene = Scene.from_data(SCENE).resolve()
    solids, focus = scene_solids(scene, summarise_film(film).bounds, None)
    content = ViewContent(
        title="Snow </script> & more",
        sentence="Two slide-offs.",
        facts=[("scene", "a panel")],
        solids=solids,
        focus=focus,
        measures=[MeasureLine(2, (0, 0, 0), (0, 0, 0.4), "height 0.4 m")],
        events=2,
    )
    write_view_page(folder / "view.html", film, content)
    return folder / "view.html"


def test_the_page_needs_no_other_file(page):
    text = page.read_text(encoding="utf-8")
    parsed = Page(text)
    assert len(parsed.ids) == len(set(parsed.ids))
    assert all(source.startswith("data:image/png;base64,") for source in parsed.sources)
    assert "one of 10 particles" in text and "Snow &lt;/script&gt; &amp; more" in text
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert [colouring["name"] for colouring in data["colourings"]] == ["event", "speed"]
    assert {mesh["kind"] for mesh in data["meshes"]} == {"ground", "panel", "solid"}


def picture(shown):
    """Return a picture of the canvas as bytes of a PNG."""
    return shown.locator("#picture").screenshot()


def test_the_view_plays_and_follows_keys_and_mouse(page):
    with open_page(page, reduced_motion="reduce") as (shown, messages):
        shown.wait_for_function(READY, timeout=60_000)
        assert shown.inner_text("#clock").startswith("event 2 of 2")
        assert "height 0.4 m" in shown.inner_text("#told")
        pictures = [picture(shown)]
        shown.focus("#picture")
        for key in ("Home", ".", "ArrowLeft", "Shift+ArrowUp", "+", "r"):
            shown.keyboard.press(key)
            pictures.append(picture(shown))
        assert len({*pictures}) >= 6  # R returns to the picture before the camera moved
        box = shown.locator("#picture").bounding_box()
        shown.mouse.move(box["x"] + 300, box["y"] + 200)
        shown.mouse.down()
        shown.mouse.move(box["x"] + 420, box["y"] + 260)
        shown.mouse.up()
        pictures.append(picture(shown))
        shown.mouse.wheel(0, -400)
        pictures.append(picture(shown))
        shown.select_option("#colour", label="speed")
        assert "Speed, m/s" in shown.inner_text("#legend")
        pictures.append(picture(shown))
        shown.select_option("#axis", label="across")
        pictures.append(picture(shown))
        shown.click("#theme")
        pictures.append(picture(shown))
        assert len({*pictures[-6:]}) == 6
        shown.click("#play")
        before = shown.inner_text("#clock")
        shown.wait_for_function(
            "text => document.getElementById('clock').textContent !== text",
            arg=before,
        )
        shown.keyboard.press("Space")
        assert shown.inner_text("#play") in ("Play", "Pause")
        assert [message for message in messages if not message.startswith("file:")] == []


def test_the_view_plays_and_follows_keys_and_mouse_in_firefox(page, tmp_path):
    with open_in_firefox(page, tmp_path) as shown:
        if not shown.evaluate("!!document.createElement('canvas').getContext('webgl2')"):
            assert shown.evaluate("document.querySelector('figure.still img').offsetHeight") > 0
            pytest.skip("this Firefox has no WebGL2, and shows the still picture")
        shown.wait_for(READY)
        shown.evaluate("document.getElementById('picture').focus()")
        pictures = [shown.picture()]
        for key in ("\ue011", ".", "\ue012", "+"):  # Home, the next frame, left, nearer
            shown.press(key)
            pictures.append(shown.changed_picture(pictures[-1]))
        shown.drag((300, 300), (420, 360))
        pictures.append(shown.changed_picture(pictures[-1]))
        assert all(picture != following for picture, following in zip(pictures, pictures[1:]))
        before = shown.evaluate("document.getElementById('clock').textContent")
        shown.evaluate("document.getElementById('play').click()")
        shown.wait_for(f"document.getElementById('clock').textContent !== {json.dumps(before)}")
        assert shown.errors == []
        assert [url for url in shown.requests if not url.startswith(("file:", "data:"))] == []


def test_positions_in_the_browser_agree_with_the_film(page):
    """The page has its own decoder, independent of the library's."""
    film = Film(page.with_name("film.bin"))
    source = (VIEWER / "film.js").read_text(encoding="utf-8")
    last = list(film)[-1]
    with open_page(page, reduced_motion="reduce") as (shown, _):
        shown.wait_for_function(READY, timeout=60_000)
        coordinates, codes = shown.evaluate(
            "async ([source, film, bounds]) => {"
            " const make = new Function(source + '; return { Film, bytesOfBase64 };')();"
            " const read = await new make.Film(make.bytesOfBase64(film), bounds).decode(() => {});"
            " const last = read.frames[read.frames.length - 1];"
            " return [Array.from(last.positions), Array.from(last.codes[0])]; }",
            [
                source,
                base64.b64encode(film.path.read_bytes()).decode(),
                {"low": [-2, -2, -2], "high": [2, 2, 2]},
            ],
        )
    positions = np.array(coordinates).reshape(-1, 3) * 4.0 / 65535 - 2.0
    assert np.abs(positions - last.positions).max() < 4.0 / 65535
    assert codes == last.codes[:, 0].tolist()


def test_the_page_fits_and_can_be_read(page):
    check_page(page)


def test_without_webgl_the_page_shows_a_still_picture(page):
    with open_page(page, java_script_enabled=False) as (shown, _):
        assert shown.is_visible("figure.still img") and not shown.is_visible("#picture")


def test_a_run_is_shown_with_its_measures(finished, tmp_path):
    file = write_view(finished, tmp_path / "page.html")
    content = view_content(Results(finished), Results(finished).film)
    assert {measure.label.split(" ")[0] for measure in content.measures} == {
        "height",
        "length",
        "free",
    }
    assert "2 slide-offs" in file.read_text(encoding="utf-8")


def test_a_run_is_shown_with_its_notes(finished, tmp_path):
    notes = Results(finished).run["notes"]
    text = unescape(write_view(finished, tmp_path / "page.html").read_text(encoding="utf-8"))
    assert notes and all(f"<li>{note}</li>" in text for note in notes)


def test_a_season_shows_its_slide_offs_and_its_notes(finished, tmp_path):
    shutil.copytree(finished, tmp_path / "run")
    (tmp_path / "season.json").write_text('{"notes": ["no <snow> settles"]}', encoding="utf-8")
    file = write_view(tmp_path)
    assert file == tmp_path / "view.html"
    text = file.read_text(encoding="utf-8")
    assert "2 slide-offs" in text and "<li>no &lt;snow&gt; settles</li>" in text


def test_without_a_film_no_page_is_written(tmp_path, finished):
    with pytest.raises(InputError, match="no results"):
        write_view(tmp_path)
    (tmp_path / "scene.json").write_bytes((finished / "scene.json").read_bytes())
    with pytest.raises(InputError, match=r"film\.bin: missing"):
        write_view(tmp_path)
    (tmp_path / "film.bin").write_bytes(film_files.header())
    with pytest.raises(InputError, match="no particles yet"):
        write_view(tmp_path)
    assert not (tmp_path / "view.html").exists()


@pytest.mark.parametrize("kind", ["gif", "mp4"])
def test_videos_have_several_frames(finished, tmp_path, kind):
    file = write_video(finished, tmp_path / f"film.{kind}", seconds=2.0, width=200)
    if kind == "mp4":
        assert b"ftyp" in file.read_bytes()[:16]
        return
    from PIL import Image

    with Image.open(file) as image:
        assert image.n_frames > 3 and image.size[0] == 200


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"video": "film.avi"}, r"\.mp4"),
        ({"width": 3}, "width"),
        ({"seconds": 0}, "seconds"),
        ({"colour": "sped"}, "speed"),
    ],
)
def test_wrong_videos_are_refused(finished, tmp_path, options, message):
    arguments = {"video": "film.gif", **options}
    with pytest.raises(InputError, match=message):
        write_video(finished, tmp_path / arguments.pop("video"), **arguments)


def test_without_its_library_an_mp4_is_refused(finished, tmp_path, hide):
    hide("imageio_ffmpeg")
    with pytest.raises(InputError, match=r"snowshed\[video\]"):
        write_video(finished, tmp_path / "film.mp4")
