"""The library in CMake projects of others: installed, and as a part of their build."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from helpers.paths import ROOT

from snowshed import _core

TREE = ROOT / "build" / "release"
EXAMPLE = ROOT / "examples" / "embed_mpm.cpp"
CMAKE = shutil.which("cmake", path=f"{sysconfig.get_path('scripts')}:{os.environ.get('PATH', '')}")
PROJECT = """\
cmake_minimum_required(VERSION 3.20)
project(embedding LANGUAGES CXX)
{library}
add_executable(embed_mpm {example})
target_link_libraries(embed_mpm PRIVATE snowshed::snowshed)
"""

pytestmark = pytest.mark.skipif(CMAKE is None, reason="cmake is not installed")


def cmake(*arguments):
    """Run cmake, and return its output."""
    command = [CMAKE, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def configure(folder: Path, library, *options):
    """Configure a project with the example, and return its build tree."""
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(PROJECT.format(library=library, example=EXAMPLE))
    cmake("-S", folder, "-B", folder / "build", *options)
    return folder / "build"


def install_rules():
    """Return the installation script of the tree in which `make build` builds the package."""
    script = TREE / "cmake_install.cmake"
    text = script.read_text(encoding="utf-8") if script.exists() else ""
    if "snowshedConfig.cmake" not in text or not (TREE / "libsnowshed.a").exists():
        pytest.skip(f"no library to install in {TREE}; `make build` makes it")
    return text


def test_an_installed_library_can_be_found_and_used(tmp_path):
    install_rules()
    prefix = tmp_path / "prefix"
    cmake("--install", TREE, "--component", "development", "--prefix", prefix)
    header = (prefix / "include" / "snowshed" / "core" / "version.hpp").read_text()
    assert f'SNOWSHED_VERSION "{_core.version}"' in header
    library = f"find_package(snowshed {_core.version} REQUIRED)"
    options = f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release"
    build = configure(tmp_path / "project", library, *options)
    cmake("--build", build)
    assert subprocess.run([build / "embed_mpm"], stdout=subprocess.DEVNULL).returncode == 0


def test_a_wheel_leaves_the_library_out():
    assert '"development" OR NOT' not in install_rules()


def test_a_parent_project_keeps_its_settings(tmp_path):
    library = f'add_subdirectory("{ROOT}" snowshed)'
    build = configure(tmp_path / "project", library, f"-DPython_EXECUTABLE={sys.executable}")
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    assert "CMAKE_BUILD_TYPE:STRING=\n" in cache
    assert "GTEST" not in cache
    assert "snowshed-run" not in cmake("--build", build, "--target", "help")
