"""The recipe of the conda package has the version and the requirements of the project."""

import re

import pytest
from helpers.paths import ROOT
from helpers.requirements import required

RECIPE = ROOT / "tools" / "release" / "conda" / "recipe.yaml"
#: Packages that have another name at conda-forge.
NAMES = {
    "matplotlib-base": "matplotlib",
    "eigen": "cmeel-eigen",
    "zlib": "cmeel-zlib",
    "nlohmann_json": "nlohmann-json",
}


@pytest.fixture(scope="module")
def recipe():
    return pytest.importorskip("yaml").safe_load(RECIPE.read_text(encoding="utf-8"))


def names(requirements):
    plain = [r["then"] if isinstance(r, dict) else r for r in requirements]
    listed = {re.match(r"[\w-]+", requirement)[0] for requirement in plain}
    return {NAMES.get(name, name) for name in listed}


def test_the_version_is_that_of_the_project(recipe):
    version = re.search(
        r"project\(snowshed VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()
    )
    assert recipe["context"]["version"] == version[1]


def test_the_c_library_is_that_of_the_wheels(recipe):
    variants = pytest.importorskip("yaml").safe_load(RECIPE.with_name("variants.yaml").read_text())
    assert any('stdlib("c")' in str(each) for each in recipe["requirements"]["build"])
    image = re.search(r'manylinux-x86_64-image = "manylinux_(\d+)_(\d+)"',
                      (ROOT / "pyproject.toml").read_text())  # fmt: skip
    assert variants["c_stdlib_version"] == [f"{image[1]}.{image[2]}"]


def test_the_requirements_are_those_of_the_project(recipe):
    assert names(recipe["requirements"]["run"]) - {"python"} == required()[0]
    built = re.search(r"requires = \[(.*)\]", (ROOT / "pyproject.toml").read_text())[1]
    needed = {re.match(r"[\w-]+", each)[0] for each in re.findall(r'"([^"]+)"', built)}
    assert names(recipe["requirements"]["host"]) - {"python", "pip"} == needed


def test_the_commands_are_those_of_the_project(recipe):
    scripts = (ROOT / "pyproject.toml").read_text().partition("[project.scripts]")[2]
    commands = dict(re.findall(r'^([\w-]+) = "([\w.:]+)"', scripts.partition("[tool")[0], re.M))
    listed = (entry.split(" = ") for entry in recipe["build"]["python"]["entry_points"])
    assert dict(listed) == commands
    assert (ROOT / recipe["about"]["license_file"]).is_file()
