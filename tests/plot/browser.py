"""A browser without a screen, if a browser is installed."""

import contextlib
import os
import shutil
from pathlib import Path

import pytest

PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "chrome")
AUDIT = Path(__file__).with_name("audit.js")
#: Root has no sandbox, and without a graphics card WebGL runs in software.
OPTIONS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]


@contextlib.contextmanager
def open_page(file, *, width=900, height=700, **context):
    """Yield a page that has been opened from disk, and its messages: errors and requests."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip(f"no browser is installed: none of {', '.join(PROGRAMS)}")
    interface = pytest.importorskip("playwright.sync_api")
    messages = []
    with interface.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=OPTIONS, env=_without_preloads()
        )
        page = browser.new_page(viewport={"width": width, "height": height}, **context)
        page.on("console", lambda message: messages.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: messages.append(f"error: {error}"))
        page.on("request", lambda request: messages.append(request.url))
        page.goto(file.as_uri())
        yield page, messages
        browser.close()


def _without_preloads():
    """Return the environment without the libraries of sanitizers, which break browsers."""
    return {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}


def faults_of(file, *, width=900, scheme="light"):
    """Return the faults of a page in a browser.

    Faults are elements that cannot be read, have no name or cannot be reached by keys (see
    audit.js), requests to other addresses, and errors of scripts.
    """
    with open_page(file, width=width, color_scheme=scheme, reduced_motion="reduce") as (
        page,
        messages,
    ):
        if page.evaluate("!!document.getElementById('data')"):  # an interactive view
            page.wait_for_function("document.body.dataset.ready === 'true'", timeout=120_000)
        faults = page.evaluate(AUDIT.read_text(encoding="utf-8"))
        own = (file.as_uri(), "data:", "blob:")
        return [*faults, *(message for message in messages if not message.startswith(own))]


def check_page(file):
    """Check a page on a telephone in light and on a screen in dark colours."""
    assert faults_of(file, width=390, scheme="light") == []
    assert faults_of(file, width=1280, scheme="dark") == []
