import pytest

from snowshed.io.weather import read_station


@pytest.fixture
def written(tmp_path):
    """Return a function that writes a file and returns its path."""

    def write(content, name="station.txt"):
        file = tmp_path / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    return write


@pytest.fixture
def station(written):
    """Return a function that reads a station from the content of a file."""
    return lambda content, name="station.txt": read_station(written(content, name))
