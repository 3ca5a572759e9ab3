"""Rules for every HTML page, checked on the templates and the style that all pages share."""

import re

import pytest
from helpers.paths import ROOT
from plot.browser import faults_of

TEMPLATES = sorted(
    path
    for path in (*ROOT.glob("python/snowshed/**/*.j2"), *ROOT.glob("validation/**/*.j2"),
                 *ROOT.glob("reproductions/**/*.j2"))
    if ".venv" not in path.parts
)  # fmt: skip
SHARED = ROOT / "python/snowshed/plot/templates/page.html.j2"
VIEWER = ROOT / "python/snowshed/plot/viewer"
MIN_CONTRAST = 4.5  # WCAG 2.2, success criterion 1.4.3


def luminance(colour):
    """Return the relative luminance of #rgb or #rrggbb (WCAG 2.2)."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    parts = [int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(colour, ground):
    high, low = sorted((luminance(colour), luminance(ground)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def themes():
    """Yield each set of colours that a style sheet defines; the first set gives the defaults."""
    base = {}
    for sheet in (SHARED, VIEWER / "view.css"):
        for block in re.findall(r":root[^{]*\{([^}]*)\}", sheet.read_text(encoding="utf-8")):
            colours = dict(re.findall(r"(--[\w-]+):\s*(#[0-9a-fA-F]{3,6})\b", block))
            base = base or colours
            if "--paper" in colours:
                yield colours


@pytest.mark.parametrize("colours", [*themes()], ids=lambda colours: colours["--paper"])
def test_text_has_enough_contrast(colours):
    text = [name for name in ("--ink", "--faint", "--good", "--bad", "--link") if name in colours]
    for ground in ("--paper", "--back"):
        for name in text:
            assert contrast(colours[name], colours[ground]) >= MIN_CONTRAST, (name, ground)


def test_measures_have_enough_contrast():
    sheet = (VIEWER / "view.css").read_text(encoding="utf-8")
    for block in re.findall(r"\{([^{}]*--measure:[^{}]*)\}", sheet):
        colours = dict(re.findall(r"(--[\w-]+):\s*(#[0-9a-fA-F]{6})", block))
        assert contrast(colours["--measure"], colours["--sky"]) >= MIN_CONTRAST


def test_the_dark_colours_are_used():
    """Browsers silently ignore a media query that they do not understand."""
    queries = re.findall(r"@media([^{]*)\{", SHARED.read_text(encoding="utf-8"))
    assert any("prefers-color-scheme: dark" in query for query in queries)
    assert not [query for query in queries if re.search(r"\(\s*not (print|screen)", query)]


@pytest.mark.parametrize("page", TEMPLATES, ids=lambda path: path.name)
def test_pages_load_nothing_and_name_all_pictures(page):
    text = page.read_text(encoding="utf-8")
    loaded = (
        r"""(src|srcset|poster|data-src)\s*=\s*["']?https?:|<link\b|@import|url\(\s*["']?https?:"""
    )
    assert re.findall(loaded, text) == []
    for image in re.findall(r"<img\b[^>]*>", text):
        assert re.search(r'alt="[^"]+"', image), image
    for drawing in re.findall(r"<svg\b[^>]*>", text):
        assert "aria-label" in drawing or "aria-hidden" in drawing, drawing
    if "<html" in text:
        assert re.search(r'<html lang="\w+"', text) and 'name="viewport"' in text
        assert "<title>" in text


def test_scripts_make_no_requests():
    for script in VIEWER.glob("*.js"):
        text = script.read_text(encoding="utf-8")
        calls = re.findall(r"\b(fetch|XMLHttpRequest|WebSocket|import)\s*\(|https?:", text)
        assert [
            match for match in re.findall(r"https?://\S+", text) if "www.w3.org" not in match
        ] == []
        assert not [match for match in calls if match]


def test_the_audit_finds_faults(tmp_path):
    """The checks of `check_page` on a page that fails all of them."""
    bad = """<html><body style="background: white"><h2 id="a">A</h2><h4 id="a">B</h4>
      <p style="color: #999">pale</p><p style="font-size: 6px">small</p><img src="data:,">
      <button></button><a href="#nowhere">link</a><table><tr><td>1</td></tr></table>
      <div style="width: 3000px">wide</div><img alt="far" src="http://localhost:9/x.png">"""
    (tmp_path / "bad.html").write_text(bad)
    faults = "\n".join(faults_of(tmp_path / "bad.html"))
    for fault in (
        "contrast 2.85", "letters of 6 px", "a picture without alt", "without a name: <button>",
        "twice: id a", "leads nowhere: #nowhere", "a table without headings", "not one h1",
        "h4 below h2", "no language", "no title", "no viewport", "wider than the window",
        "http://localhost:9/x.png",
    ):  # fmt: skip
        assert fault in faults, fault
