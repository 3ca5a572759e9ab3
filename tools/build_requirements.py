"""Print the requirements that pip must install before snowshed can be built, one per line.

These are the build requirements of pyproject.toml, and cmake and ninja if the system lacks them.
"""

import ast
import re
import shutil
import subprocess
from pathlib import Path

CMAKE_NEEDED = (3, 20)


def declared_requirements(pyproject: str) -> list:
    """Return the list `requires` of [build-system].

    A regular expression finds the list, because Python 3.9 has no TOML parser. The text of the list
    is also valid Python.
    """
    table = re.search(r"^\[build-system\]$(.*?)(?=^\[|\Z)", pyproject, re.M | re.S)
    requires = table and re.search(r"^requires\s*=\s*(\[.*?\])\s*$", table[1], re.M | re.S)
    if not requires:
        raise SystemExit("pyproject.toml: [build-system] has no `requires`")
    return list(ast.literal_eval(requires[1]))


def system_has_cmake() -> bool:
    """Return whether the path has a cmake that is new enough."""
    if not shutil.which("cmake"):
        return False
    answer = subprocess.run(["cmake", "--version"], capture_output=True, text=True).stdout
    version = re.search(r"version (\d+)\.(\d+)", answer)
    return version is not None and tuple(map(int, version.groups())) >= CMAKE_NEEDED


def main() -> None:
    """Print the requirements."""
    requirements = declared_requirements(Path("pyproject.toml").read_text(encoding="utf-8"))
    if not system_has_cmake():
        requirements.append("cmake>={}.{}".format(*CMAKE_NEEDED))
    if not shutil.which("ninja"):
        requirements.append("ninja")
    print("\n".join(requirements))


if __name__ == "__main__":
    main()
