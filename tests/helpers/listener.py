"""A listener on the loopback address, which files under test must not contact."""

import socket
import threading
from contextlib import contextmanager


class Listener:
    """A port, and the first bytes that were sent to it."""

    def __init__(self):
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.heard = []
        threading.Thread(target=self._listen, daemon=True).start()

    @property
    def address(self):
        """Return the address that files under test contain."""
        return f"http://127.0.0.1:{self.port}"

    def _listen(self):
        while True:
            try:
                connection, _ = self.socket.accept()
            except OSError:
                return
            connection.settimeout(1.0)
            try:
                self.heard.append(connection.recv(200))
                connection.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")
            except OSError:
                self.heard.append(b"(connected)")
            connection.close()


@contextmanager
def silence():
    """Yield a listener, and fail if it has received anything."""
    listener = Listener()
    try:
        yield listener
    finally:
        listener.socket.close()
    assert not listener.heard, listener.heard
