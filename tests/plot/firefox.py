"""Firefox without a screen, where it is installed, driven by WebDriver BiDi.

WebGL needs a screen, if only that of Xvfb. Playwright drives only a Firefox of its own. The one
that people have listens on a socket: https://w3c.github.io/webdriver-bidi.
"""

import base64
import contextlib
import itertools
import json
import os
import re
import shutil
import signal
import subprocess
import time

import pytest

PROGRAMS = ("firefox", "firefox-esr")
TIME_LIMIT_S = 120.0  # s, for an answer


@contextlib.contextmanager
def open_in_firefox(file, folder):
    """Yield a page that has been opened from disk; the folder holds the browser's profile."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip(f"no Firefox is installed: none of {', '.join(PROGRAMS)}")
    sockets = pytest.importorskip("websockets.sync.client")
    profile = folder / "profile"
    profile.mkdir()
    (profile / "user.js").write_text('user_pref("webgl.force-enabled", true);\n')  # computed
    screen = ["xvfb-run", "-a", program] if shutil.which("xvfb-run") else [program, "--headless"]
    words = [*screen, "--no-remote", "--profile", profile]
    words += ["--remote-debugging-port", "0", "--window-size", "900,1000"]
    with (folder / "firefox.log").open("w+") as log:
        process = subprocess.Popen(
            list(map(str, words)), stdout=log, stderr=log, start_new_session=True
        )
        try:
            address = _address(process, folder / "firefox.log")
            with sockets.connect(f"{address}/session", max_size=None) as socket:
                yield FirefoxPage(socket, file)
        finally:
            os.killpg(process.pid, signal.SIGTERM)  # the screen, too
            process.wait()


def _address(process, log):
    for _ in range(600):
        found = re.search(r"ws://[\d.:]+", log.read_text(errors="replace"))
        if found:
            return found[0]
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.1)
            break
    raise RuntimeError(f"Firefox does not listen: {log.read_text(errors='replace')[-500:]}")


class FirefoxPage:
    """A page in Firefox, and what it told: errors of its console, and requests."""

    def __init__(self, socket, file):
        self.socket = socket
        self.numbers = itertools.count(1)
        self.errors, self.requests = [], []
        self.call("session.new", capabilities={})
        self.call("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])
        self.context = self.call("browsingContext.getTree")["contexts"][0]["context"]
        self.call(
            "browsingContext.navigate", context=self.context, url=file.as_uri(), wait="complete"
        )

    def call(self, method, **params):
        """Return the result of a command; events that come meanwhile are kept."""
        number = next(self.numbers)
        self.socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            message = json.loads(self.socket.recv(timeout=TIME_LIMIT_S))
            if message.get("id") == number:
                assert message["type"] == "success", message
                return message["result"]
            self._keep(message)

    def _keep(self, message):
        params = message.get("params", {})
        if message.get("method") == "network.beforeRequestSent":
            self.requests.append(params["request"]["url"])
        elif message.get("method") == "log.entryAdded" and params["level"] == "error":
            self.errors.append(params["text"])

    def evaluate(self, expression):
        """Return the value of an expression; a promise is waited for."""
        found = self.call(
            "script.evaluate",
            expression=expression,
            target={"context": self.context},
            awaitPromise=True,
        )
        assert found["type"] == "success", found
        return found["result"].get("value")

    def wait_for(self, condition):
        """Wait until an expression is true."""
        self.evaluate(
            "new Promise(done => { const look = () => "
            f"({condition}) ? done(true) : setTimeout(look, 50); look(); }})"
        )

    def press(self, key):
        """Press a key and let it go."""
        actions = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        keys = {"type": "key", "id": "keys", "actions": actions}
        self.call("input.performActions", context=self.context, actions=[keys])

    def drag(self, start, end):
        """Move the mouse from a point of the page to another one with its button down."""
        (x, y), (to_x, to_y) = start, end
        actions = [
            {"type": "pointerMove", "x": x, "y": y},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "x": to_x, "y": to_y, "duration": 50},
            {"type": "pointerUp", "button": 0},
        ]
        mouse = {"type": "pointer", "id": "mouse", "actions": actions}
        self.call("input.performActions", context=self.context, actions=[mouse])

    def picture(self):
        """Return what the page shows, as bytes of a PNG."""
        return base64.b64decode(
            self.call("browsingContext.captureScreenshot", context=self.context)["data"]
        )

    def changed_picture(self, before):
        """Return what the page shows as soon as it differs, or what it shows after some time."""
        shown = before
        for _ in range(60):
            shown = self.picture()
            if shown != before:
                break
            time.sleep(0.2)
        return shown
