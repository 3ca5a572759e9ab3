"""Firefox without a screen, if it is installed, driven by WebDriver BiDi.

WebGL needs a screen, such as that of Xvfb. Playwright drives only a Firefox of its own. An
ordinary Firefox listens on a socket: https://w3c.github.io/webdriver-bidi.
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
    (profile / "user.js").write_text('user_pref("webgl.force-enabled", true);\n')  # in software
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
        match = re.search(r"ws://[\d.:]+", log.read_text(errors="replace"))
        if match:
            return match[0]
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.1)
            break
    raise RuntimeError(f"Firefox does not listen: {log.read_text(errors='replace')[-500:]}")


class FirefoxPage:
    """A page in Firefox, with the errors of its console and its requests."""

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
        """Return the result of a command, and record the events that come meanwhile."""
        number = next(self.numbers)
        self.socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            message = json.loads(self.socket.recv(timeout=TIME_LIMIT_S))
            if message.get("id") == number:
                assert message["type"] == "success", message
                return message["result"]
            self._record(message)

    def _record(self, message):
        params = message.get("params", {})
        if message.get("method") == "network.beforeRequestSent":
            self.requests.append(params["request"]["url"])
        elif message.get("method") == "log.entryAdded" and params["level"] == "error":
            self.errors.append(params["text"])

    def evaluate(self, expression):
        """Return the value of an expression; wait if it is a promise."""
        reply = self.call(
            "script.evaluate",
            expression=expression,
            target={"context": self.context},
            awaitPromise=True,
        )
        assert reply["type"] == "success", reply
        return reply["result"].get("value")

    def wait_for(self, condition):
        """Wait until an expression is true."""
        self.evaluate(
            "new Promise(done => { const look = () => "
            f"({condition}) ? done(true) : setTimeout(look, 50); look(); }})"
        )

    def press(self, key):
        """Press and release a key."""
        actions = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        keys = {"type": "key", "id": "keys", "actions": actions}
        self.call("input.performActions", context=self.context, actions=[keys])

    def drag(self, start, end):
        """Drag the mouse from one point of the page to another."""
        (x, y), (end_x, end_y) = start, end
        actions = [
            {"type": "pointerMove", "x": x, "y": y},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "x": end_x, "y": end_y, "duration": 50},
            {"type": "pointerUp", "button": 0},
        ]
        mouse = {"type": "pointer", "id": "mouse", "actions": actions}
        self.call("input.performActions", context=self.context, actions=[mouse])

    def picture(self):
        """Return a screenshot of the page as bytes of a PNG."""
        return base64.b64decode(
            self.call("browsingContext.captureScreenshot", context=self.context)["data"]
        )

    def changed_picture(self, previous):
        """Return the first screenshot that differs, or the last after some time."""
        picture = previous
        for _ in range(60):
            picture = self.picture()
            if picture != previous:
                break
            time.sleep(0.2)
        return picture
