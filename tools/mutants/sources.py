"""Copy of the project's sources, in which faults are injected.

The files of the project itself are never written; they stay unchanged even if a run is stopped.
"""

from __future__ import annotations

import filecmp
import re
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from tools.mutants.faults import Fault, FaultError

#: Header of every C++ source of the copy. An environment variable gives the number of the fault
#: that is on; without the variable no fault is on.
SWITCH_HEADER = """#pragma once
#include <cstdlib>
inline int snowshed_fault_from_environment() {
  const char* number = std::getenv("SNOWSHED_FAULT");
  return number ? std::atoi(number) : 0;
}
inline const int snowshed_fault = snowshed_fault_from_environment();
"""


#: Within the brackets of a switch, a comparison must have the whole of its right side.
COMPARISON, ARITHMETIC = re.compile(r"[<>]|[=!]="), ("+", "-", "*", "/", "%")


def with_faults(
    text: str, switched: Sequence[tuple[int, Fault]], fixed: Fault | None = None
) -> str:
    """Return a source with faults that have a switch, and with at most one fault that has none.

    Parameters
    ----------
    text
        Text of the source.
    switched
        Faults of this source with a switch, by numbers from 1. All switches are off. Faults that
        overlap `fixed` are left out.
    fixed
        Fault whose new text replaces the old one.

    Raises
    ------
    FaultError
        If two faults overlap and are not in the same place.
    """
    spans: dict[tuple[int, int], list[tuple[int, Fault]]] = {}
    taken = fixed.place(text) if fixed else (0, 0)
    for number, fault in switched:
        start, end = fault.place(text)
        if COMPARISON.search(fault.old) and text[end:].lstrip()[:1] in ARITHMETIC:
            raise FaultError(
                f"{fault.name}: its old text is a comparison whose right side goes on after it"
            )
        if end <= taken[0] or start >= taken[1]:
            spans.setdefault((start, end), []).append((number, fault))
    edits = [(start, end, _switch(group)) for (start, end), group in spans.items()]
    if fixed:
        edits.append((*taken, fixed.new))
    edits.sort()
    for before, after in zip(edits, edits[1:]):
        if before[1] > after[0]:
            names = [fault.name for group in spans.values() for _, fault in group]
            raise FaultError(f"faults overlap: {text[after[0] : after[1]]!r}; {', '.join(names)}")
    parts, at = [], 0
    for start, end, new in edits:
        parts += [text[at:start], new]
        at = end
    return "".join([*parts, text[at:]])


def _switch(group: Sequence[tuple[int, Fault]]) -> str:
    choices = [f"snowshed_fault == {number} ? ({fault.new}) : " for number, fault in group]
    return f"({''.join(choices)}({group[0][1].old}))"


class SourceCopy:
    """Copy of the project's sources.

    Parameters
    ----------
    root
        Root of the project.
    folder
        Folder of the copy.
    faults
        All faults; faults with a switch are in the copy from the beginning.
    """

    def __init__(self, root: Path, folder: Path, faults: Sequence[Fault]) -> None:
        self.root, self.folder = root, folder
        switched = [fault for fault in faults if fault.switch]
        self.numbers = {fault.name: number for number, fault in enumerate(switched, 1)}
        self._switched: dict[str, list[tuple[int, Fault]]] = {}
        for fault in switched:
            number = self.numbers[fault.name]
            self._switched.setdefault(fault.file, []).append((number, fault))

    def update(self, files: Sequence[str] | None = None) -> None:
        """Update the copy from the project; unchanged files keep their times.

        Parameters
        ----------
        files
            Files to copy, relative to the root; by default all files that Git knows or would add.
        """
        wanted = set(self.project_files() if files is None else files)
        for name in wanted:
            if name in self._switched:
                self._restore(name)
            else:
                self._copy(name)
        for path in list(self.folder.rglob("*")):
            name = path.relative_to(self.folder).as_posix()
            if path.is_file() and not path.is_symlink() and name not in wanted:
                path.unlink()

    def project_files(self) -> list[str]:
        """Return the files of the project, relative to its root."""
        command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, cwd=self.root, check=True, capture_output=True).stdout
        names = [name for name in listed.decode().split("\0") if name]
        return [name for name in names if (self.root / name).is_file()]

    @contextmanager
    def inject(self, fault: Fault) -> Iterator[None]:
        """Inject a fault without a switch, and remove it at the end, even after an error."""
        try:
            self._write(fault.file, fault)
            yield
        finally:
            self._restore(fault.file)

    def _copy(self, name: str) -> None:
        source, target = self.root / name, self.folder / name
        if not target.is_file() or not filecmp.cmp(source, target, shallow=False):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            shutil.copymode(source, target)

    def _restore(self, name: str) -> None:
        self._write(name, None)

    def _write(self, name: str, fixed: Fault | None) -> None:
        original = (self.root / name).read_text(encoding="utf-8")
        text = with_faults(original, self._switched.get(name, []), fixed)
        target = self.folder / name
        if not target.is_file() or target.read_text(encoding="utf-8") != text:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
            shutil.copymode(self.root / name, target)
