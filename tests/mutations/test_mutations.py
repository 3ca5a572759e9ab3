"""Mutated files cause no traceback, signal, hang, memory flood or silent damage."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from mutations.readers import READERS, tries_of

FEW, MANY = 12, 440  # files of most readers: in every test run, and in `make test-slow`
MEMORY_MB, IMAGE_MB = 2048, 1024  # limits for reading; images may claim any size
CHILD = Path(__file__).with_name("child.py")
GOOD = {"accepted", "refused"}


def outcomes(
    names: list[str], folder: Path, tries: int, memory: int = MEMORY_MB
) -> dict[tuple[str, int], str]:
    """Return the outcome of each file, by its reader and seed."""
    results: dict[tuple[str, int], str] = {}
    count = sum(tries_of(name, tries) for name in names)
    while len(results) < count:
        command = [sys.executable, CHILD, folder, tries, len(results), memory, *names]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        ended = {(line["reader"], line["seed"]): line.get("outcome") for line in lines}
        assert ended, f"a good file is not read: {done.stderr[-2000:]}"
        results.update({key: outcome for key, outcome in ended.items() if outcome})
        if done.returncode != 0:  # at the file that it reported last
            results.setdefault([*ended][-1], f"DIED with {done.returncode}: {done.stderr[-500:]}")
    return results


def check(names: list[str], folder: Path, tries: int, memory: int = MEMORY_MB) -> Counter[str]:
    results = outcomes(names, folder, tries, memory)
    bad = {key: outcome for key, outcome in results.items() if outcome not in GOOD}
    assert not bad, bad
    return Counter(results.values())


def test_a_few_mutated_files(tmp_path):
    check([*READERS], tmp_path, FEW)


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_many_mutated_files(name, tmp_path, capsys):
    image = name.startswith(("hostile", "image", "slice"))
    counts = check([name], tmp_path, MANY, IMAGE_MB if image else MEMORY_MB)
    with capsys.disabled():
        print(f"\n{name}: {dict(counts)}")
