"""Fixtures, and scenes that run within a second or two."""

import importlib
import signal
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Optional

import pytest
from hypothesis import HealthCheck, settings

from snowshed import Scene, run_events
from snowshed.io import read_station, vdb_available

# The module that writes and reads OpenVDB files, if snowshed was built without it.
collect_ignore = [] if vdb_available() else ["io/vdb/test_vdb_files.py"]

# A shell in the background ignores interrupts, and commands under test would inherit that.
for _signal in (signal.SIGINT, signal.SIGHUP):
    if signal.getsignal(_signal) is signal.SIG_IGN:
        _default_handler = (
            signal.default_int_handler if _signal == signal.SIGINT else signal.SIG_DFL
        )
        signal.signal(_signal, _default_handler)

# The same examples in every run, however fast the machine is.
settings.register_profile(
    "snowshed",
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("snowshed")


def tiny_scene(**values: object) -> Scene:
    """The lab's 50 degree scene in 2D on a coarse grid: two events of about a hundred particles."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics": {"dx": 0.02}})
    scene.update({"events": {"count": 2, "max_time": 1.0}, "seeding.particles_per_voxel": 8})
    scene.set("numerics.threads", 1)  # the fastest for so few particles
    return scene.update(values)


def tiny_mps(**values: object) -> Scene:
    """A column of eighty MPS particles that slumps onto erodible snow."""
    column = {"shape": {"type": "box", "center": [0, 0.25], "size": [0.4, 0.5]}}
    scene = Scene.from_data(
        {"snowshed": 2, "method": "mps", "dimension": 2, "ground": {}, "bodies": [column]}
    )
    erosion = {"erosion": True, "erodible_thickness": 0.1, "cohesion": 20.0}
    scene.update({"numerics": {"spacing": 0.05, "threads": 1, **erosion}})
    return scene.update(values)


@pytest.fixture
def hide(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Return a function that hides an optional library, as if it were not installed."""
    real = importlib.import_module

    def hide_library(library: str) -> None:
        def without(name: str, package: Optional[str] = None) -> ModuleType:
            if name.partition(".")[0] == library:
                raise ImportError(f"No module named {name!r}")
            return real(name, package)

        monkeypatch.setattr(importlib, "import_module", without)

    return hide_library


@pytest.fixture
def drawn() -> None:
    """Draw pictures and pages in this test, in a file that leaves them out with `undrawn`."""


def leave_out_drawings(patch: pytest.MonkeyPatch) -> None:
    """Leave out the pictures and the page of slides, which take longer than a small slide."""
    patch.setattr("snowshed.methods.slide.run.SlideRun.draw", lambda _: None)


@pytest.fixture
def undrawn(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the pictures and the page of slides in a test that does not ask for `drawn`."""
    if "drawn" not in request.fixturenames:
        leave_out_drawings(monkeypatch)


@pytest.fixture
def tiny() -> Scene:
    return tiny_scene()


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results folder of a finished tiny scene."""
    folder = tmp_path_factory.mktemp("finished") / "results"
    run_events(tiny_scene(**{"output.energy": True}), folder)
    return folder


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
