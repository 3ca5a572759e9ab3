"""Faults, and the TOML files that contain them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

try:
    import tomllib
except ImportError:  # before Python 3.11
    import tomli as tomllib

FOLDER = Path(__file__).with_name("faults")
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
TEXTS = ("name", "file", "old", "new", "why")


class FaultError(ValueError):
    """Error for a fault that cannot be injected, with the reason and the file."""


@dataclass(frozen=True)
class Fault:
    """Fault: a wrong line of source.

    Attributes
    ----------
    name, area
        Name of the fault, and the area of the program to which it belongs.
    file
        Changed source, relative to the root of the project.
    old, new
        Text that occurs exactly once in the source, and its replacement.
    why
        Wrong behaviour of the program with the fault.
    tests
        Tests that should catch it: ``cpp:FILTER`` of GoogleTest, or a path for pytest.
    switch
        Whether both texts are C++ expressions. Such faults are compiled together, and one of them
        is turned on when the tests start.
    survives
        Reason why no test can catch the fault; empty if a test should catch it.
    """

    name: str
    area: str
    file: str
    old: str
    new: str
    why: str
    tests: tuple[str, ...]
    switch: bool = False
    survives: str = ""

    @property
    def is_cpp(self) -> bool:
        """Whether the fault is in C++."""
        return self.file.endswith((".cpp", ".hpp", ".cuh"))

    def place(self, text: str) -> tuple[int, int]:
        """Return the start and the end of the old text in the source.

        Raises
        ------
        FaultError
            If the old text does not occur exactly once.
        """
        count = text.count(self.old)
        if count != 1:
            times = "no longer there" if count == 0 else f"there {count} times"
            raise FaultError(f"{self.name}: the old text is {times} in {self.file}: {self.old!r}")
        start = text.index(self.old)
        return start, start + len(self.old)


def read_faults(folder: Path = FOLDER) -> list[Fault]:
    """Return the faults of all TOML files in a folder, sorted by file, in the order of each file.

    Raises
    ------
    FaultError
        If a file has a wrong format, or two faults have the same name.
    """
    faults = [fault for path in sorted(folder.glob("*.toml")) for fault in _faults_of(path)]
    names = [fault.name for fault in faults]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FaultError(f"two faults have the same name: {', '.join(twice)}")
    return faults


def check_places(faults: Sequence[Fault], root: Path) -> None:
    """Raise FaultError unless the old text of every fault occurs once in its source.

    The old text of a switch must be an expression: with the name of its namespace or object.
    """
    for fault in faults:
        path = root / fault.file
        if not path.is_file():
            raise FaultError(f"{fault.name}: there is no file {fault.file}")
        text = path.read_text(encoding="utf-8")
        start, _ = fault.place(text)
        if fault.switch and text[:start].endswith(("::", ".", "->")):
            raise FaultError(f"{fault.name}: the text before the old text belongs to it")


def _faults_of(path: Path) -> Iterator[Fault]:
    try:
        listed = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise FaultError(f"{path.name}: {error}") from None
    unknown = sorted(set(listed) - {"area", "tests", "fault"})
    if unknown:
        raise FaultError(f"{path.name}: unknown key {unknown[0]}; allowed: area, tests, fault")
    area, common = _text(listed, "area", path.name), _tests(listed, path.name)
    entries = listed.get("fault")
    if not isinstance(entries, list) or not entries:
        raise FaultError(f"{path.name}: lists no [[fault]]")
    for number, entry in enumerate(entries, 1):
        yield _fault(entry, area, common, f"{path.name}, fault {number}")


def _fault(entry: Mapping[str, object], area: str, common: tuple[str, ...], where: str) -> Fault:
    allowed = (*TEXTS, "tests", "switch", "survives")
    unknown = sorted(set(entry) - set(allowed))
    if unknown:
        raise FaultError(f"{where}: unknown key {unknown[0]}; allowed: {', '.join(allowed)}")
    texts = {key: _text(entry, key, where, empty=key == "new") for key in TEXTS}
    if not NAME.fullmatch(texts["name"]):
        raise FaultError(f"{where}: name {texts['name']!r}; allowed: a-z, 0-9, single hyphens")
    if texts["old"] == texts["new"]:
        raise FaultError(f"{where}: old and new are the same")
    own = _tests(entry, where)
    tests = (*own, *(test for test in common if test not in own))
    if not tests:
        raise FaultError(f"{where}: no tests")
    switch = entry.get("switch", False)
    if not isinstance(switch, bool):
        raise FaultError(f"{where}: switch is {switch!r}; allowed: true, false")
    survives = _text(entry, "survives", where) if "survives" in entry else ""
    fault = Fault(area=area, tests=tests, switch=switch, survives=survives, **texts)
    if switch and not fault.is_cpp:
        raise FaultError(f"{where}: only faults in C++ have a switch")
    for text in (fault.old, fault.new) if switch else ():
        if text[0] in "?:":  # the choice becomes an operand of another choice
            raise FaultError(f"{where}: {text!r} is no expression; a switch needs one")
    return fault


def _text(table: Mapping[str, object], key: str, where: str, empty: bool = False) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not (value or empty):
        raise FaultError(f"{where}: {key} is {value!r}; a text is needed")
    return value


def _tests(table: Mapping[str, object], where: str) -> tuple[str, ...]:
    value = table.get("tests", [])
    if not isinstance(value, list) or not all(isinstance(test, str) for test in value):
        raise FaultError(f"{where}: tests is {value!r}; a list of texts is needed")
    for test in value:
        if not test.startswith(("cpp:", "tests/")):
            raise FaultError(f"{where}: test {test!r}; allowed: cpp:FILTER, or a path below tests/")
    return tuple(value)
