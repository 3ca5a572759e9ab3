"""Builds of the copy, and runs of tests on it until the first one fails."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path

from tools.mutants.sources import SWITCH_HEADER

TIME_LIMIT = 900  # s; tests that take longer count as hanging
CPP_FAILED = re.compile(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", re.M)
PYTHON_FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.M)


class BuildError(RuntimeError):
    """Error if the copy does not compile, or if its tests cannot show a fault."""


class Workshop:
    """Build tree of the copy, and a Python environment that imports from it.

    Parameters
    ----------
    folder
        Folder of the build tree and the environment.
    source
        Copy of the project.
    """

    def __init__(self, folder: Path, source: Path) -> None:
        self.folder, self.source = folder, source
        self.tree, self.venv = folder / "tree", folder / "venv"

    def prepare(self) -> None:
        """Configure the build, and create the environment."""
        self.folder.mkdir(parents=True, exist_ok=True)
        header = self.folder / "fault_switch.hpp"
        if not header.is_file() or header.read_text() != SWITCH_HEADER:
            header.write_text(SWITCH_HEADER)
        pybind = self._output([sys.executable, "-m", "pybind11", "--cmakedir"])
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "CMAKE_CXX_FLAGS": f"-include {header}",
            "SNOWSHED_KERNEL_VARIANTS": "baseline",  # all of them come from the same templates
            "SNOWSHED_BUILD_TESTS": "ON",
            "SNOWSHED_BUILD_PYTHON": "ON",
            "SNOWSHED_WITH_OPENVDB": "OFF",
            "Python_EXECUTABLE": sys.executable,
            "pybind11_DIR": pybind,
        }
        defines = [f"-D{name}={value}" for name, value in options.items()]
        self._run(["cmake", "-S", self.source, "-B", self.tree, "-G", "Ninja", *defines])
        self._make_environment()

    def build(self, *targets: str) -> None:
        """Build targets of the tree, one job at a time."""
        self._run(["cmake", "--build", self.tree, "-j", "1", "--target", *targets])

    def first_failure(self, tests: Sequence[str], number: int = 0) -> str:
        """Return the first test that fails, or "" if all pass.

        Parameters
        ----------
        tests
            ``cpp:FILTER`` or paths for pytest, in the order in which they run.
        number
            Number of the fault that is turned on; 0: none.
        """
        for test in tests:
            failed = self._cpp(test[4:], number) if test.startswith("cpp:") else ""
            failed = failed if test.startswith("cpp:") else self._python(test, number)
            if failed:
                return failed
        return ""

    def _cpp(self, pattern: str, number: int) -> str:
        program = self.tree / "snowshed_tests"
        words = [program, f"--gtest_filter={pattern}", "--gtest_fail_fast", "--gtest_brief=1"]
        code, text = self._try(words, number)
        if "Running 0 tests" in text or "0 tests from 0 test" in text:
            raise BuildError(f"no test matches cpp:{pattern}")
        failures = CPP_FAILED.findall(text)
        return f"cpp:{failures[0]}" if failures else self._ended(code, f"cpp:{pattern}")

    def _python(self, path: str, number: int) -> str:
        words = [self.venv / "bin/python", "-m", "pytest", "-x", "-q", "-rfE", "--no-header"]
        code, text = self._try([*words, "-p", "no:cacheprovider", path], number)
        if code in (4, 5):
            raise BuildError(f"pytest finds no test in {path}:\n{text[-2000:]}")
        failures = PYTHON_FAILED.findall(text)
        return failures[0] if failures else self._ended(code, path)

    @staticmethod
    def _ended(code: int | None, test: str) -> str:
        if code is None:
            return f"{test} (hangs)"
        return f"{test} (exit code {code})" if code else ""

    def _try(self, words: Sequence[object], number: int) -> tuple[int | None, str]:
        """Return the exit code (None after the time limit) and the output of a command."""
        environment = {**os.environ, "SNOWSHED_FAULT": str(number)}
        environment.update(PYTHONDONTWRITEBYTECODE="1", GTEST_BRIEF="1")
        environment["PATH"] = f"{self.venv / 'bin'}{os.pathsep}{os.environ['PATH']}"
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
        try:
            ended = subprocess.run(
                list(map(str, words)),
                cwd=self.source,
                env=environment,
                timeout=TIME_LIMIT,
                **options,
            )
        except subprocess.TimeoutExpired as late:
            return None, str(late.stdout or "")
        return ended.returncode, ended.stdout

    def _make_environment(self) -> None:
        """Create an environment with the copy's snowshed and all other packages of this Python.

        Python ignores path files in the packages of another environment, so it does not find the
        snowshed that is installed there.
        """
        python = self.venv / "bin/python"
        if not python.exists():
            self._run([sys.executable, "-m", "venv", "--without-pip", self.venv])
        site = Path(
            self._output([python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"])
        )
        paths = [self.source / "python", sysconfig.get_path("purelib")]
        (site / "mutants.pth").write_text("".join(f"{path}\n" for path in paths))
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        self._link(self.source / f"python/snowshed/_core{suffix}", self.tree / f"_core{suffix}")
        self._link(self.venv / "bin/snowshed-run", self.tree / "snowshed-run")

    @staticmethod
    def _link(link: Path, target: Path) -> None:
        if not link.is_symlink():
            link.symlink_to(target)

    def _run(self, words: Sequence[object]) -> None:
        ended = subprocess.run(list(map(str, words)), capture_output=True, text=True)
        if ended.returncode:
            raise BuildError((ended.stdout + ended.stderr)[-4000:])

    def _output(self, words: Sequence[object]) -> str:
        return subprocess.run(
            list(map(str, words)), capture_output=True, text=True, check=True
        ).stdout.strip()
