import doctest
import importlib
import pkgutil
import subprocess
import sys

import pytest

import snowshed

MODULES = sorted(
    f"snowshed.{module.name}"
    for module in pkgutil.iter_modules(snowshed.__path__)
    if module.name not in ("_core", "__main__")
)


@pytest.mark.parametrize("name", ["snowshed", *MODULES])
def test_examples_in_docstrings(name):
    module = importlib.import_module(name)
    assert doctest.testmod(module).failed == 0


def test_import_is_quick_and_leaves_the_heavy_libraries_out():
    code = (
        "import sys, time; start = time.perf_counter(); import snowshed; "
        "print(time.perf_counter() - start, *({'matplotlib', 'pandas', 'rich'} & set(sys.modules)))"
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        for _ in range(3)
    ]
    seconds, *heavy = min((run.stdout.split() for run in runs), key=lambda words: float(words[0]))
    assert not heavy
    assert float(seconds) < 0.3
