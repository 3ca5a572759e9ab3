"""Hostile maps cause no request, open no file outside, and raise no traceback or memory flood."""

from __future__ import annotations

import ctypes
import json
import os
import subprocess
import sys
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

import pytest
from helpers.listener import silence
from mutations.hostile_maps import MAKERS, SECRET

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")
pytest.importorskip("rasterio")

FEW, MANY = 2, 40  # inputs of each kind: in every test run, and in `make test-slow`
MEMORY_MB = 1024  # limit for each input
GOOD = {"accepted", "refused"}
IN_OPEN, IN_ACCESS, IN_MODIFY = 0x20, 0x1, 0x2


@contextmanager
def untouched(folder: Path):
    """Fail if any file of a folder is opened, by any means."""
    libc = ctypes.CDLL(None, use_errno=True)
    watch = libc.inotify_init1(os.O_NONBLOCK)
    assert watch >= 0
    libc.inotify_add_watch(watch, os.fsencode(folder), IN_OPEN | IN_ACCESS | IN_MODIFY)
    before = sorted(file.name for file in folder.iterdir())
    while _events(watch):
        pass  # the listing above caused these events
    try:
        yield
        opened = _events(watch)
    finally:
        os.close(watch)
    assert not opened, opened
    assert sorted(file.name for file in folder.iterdir()) == before


def _events(watch: int) -> bytes:
    try:
        return os.read(watch, 65536)
    except BlockingIOError:
        return b""


def outside_of(folder: Path) -> Path:
    """Write files that no reader may open."""
    outside = folder / "outside"
    outside.mkdir()
    for name in ("a.gpkg", "a.prj", "a.geojson", "a.shp", "a.asc"):
        (outside / name).write_bytes(SECRET)
    return outside


def outcomes(folder: Path, tries: int, address: str, outside: Path) -> dict[tuple[str, int], str]:
    """Return the outcome of each input, by its kind and seed."""
    results: dict[tuple[str, int], str] = {}
    child = Path(__file__).with_name("hostile_maps_child.py")
    while len(results) < tries * len(MAKERS):
        command = [sys.executable, child, folder, tries, len(results), MEMORY_MB, address, outside]
        done = subprocess.run(
            [str(word) for word in command],
            capture_output=True,
            text=True,
            stdin=subprocess.DEVNULL,
        )
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        ended = {(line["reader"], line["seed"]): line.get("outcome") for line in lines}
        assert ended, f"a good project is not read: {done.stderr[-2000:]}"
        results.update({key: outcome for key, outcome in ended.items() if outcome})
        if done.returncode != 0:  # at the input that it reported last
            results.setdefault([*ended][-1], f"DIED with {done.returncode}: {done.stderr[-500:]}")
    return results


def check(folder: Path, tries: int) -> dict[str, Counter[str]]:
    outside = outside_of(folder)
    with silence() as listener, untouched(outside):
        results = outcomes(folder / "inputs", tries, listener.address, outside)
    bad = {key: outcome for key, outcome in results.items() if outcome not in GOOD}
    assert not bad, bad
    counts: dict[str, Counter[str]] = {}
    for (name, _), outcome in results.items():
        counts.setdefault(name, Counter())[outcome] += 1
    return counts


def test_the_watch_reports_opened_files(tmp_path):
    outside = outside_of(tmp_path)
    with pytest.raises(AssertionError), untouched(outside):
        (outside / "a.prj").read_bytes()


def test_a_few_hostile_maps(tmp_path):
    check(tmp_path, FEW)


@pytest.mark.slow
def test_many_hostile_maps(tmp_path, capsys):
    counts = check(tmp_path, MANY)
    with capsys.disabled():
        print()
        for name, outcome in counts.items():
            print(f"{name}: {dict(outcome)}")
