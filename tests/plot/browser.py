"""A browser without a screen, where one is installed."""

import contextlib
import shutil

import pytest

PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "chrome")
#: A sandbox is not to be had for root, and without a graphics card WebGL is computed.
OPTIONS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]


@contextlib.contextmanager
def open_page(file, *, width=900, height=700, **context):
    """Yield a page that has been opened from disk, and what it told: errors and requests."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip(f"no browser is installed: none of {', '.join(PROGRAMS)}")
    interface = pytest.importorskip("playwright.sync_api")
    told = []
    with interface.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=OPTIONS)
        page = browser.new_page(viewport={"width": width, "height": height}, **context)
        page.on("console", lambda message: told.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: told.append(f"error: {error}"))
        page.on("request", lambda request: told.append(request.url))
        page.goto(file.as_uri())
        yield page, told
        browser.close()
