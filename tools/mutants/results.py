"""Results of injected faults: the file that keeps them, and tables of pages in docs/trust."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tools.mutants.faults import Fault

FILE = Path(__file__).with_name("results.json")
BEGIN, END = "<!-- faults: begin -->", "<!-- faults: end -->"


@dataclass
class Results:
    """The test that caught each fault.

    Attributes
    ----------
    caught_by
        The first test that failed, by the name of the fault; empty if none did.
    date
        Day on which each fault was tried.
    """

    caught_by: dict[str, str] = field(default_factory=dict)
    date: dict[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path = FILE) -> Results:
        """Return the results in a file; none if there is no file."""
        if not path.is_file():
            return cls()
        data = json.loads(path.read_text(encoding="utf-8"))["faults"]
        return cls(
            {name: fault["caught_by"] for name, fault in data.items()},
            {name: fault["date"] for name, fault in data.items()},
        )

    def write(self, path: Path, faults: Sequence[Fault]) -> None:
        """Write the results of faults that still exist."""
        names = [fault.name for fault in faults if fault.name in self.caught_by]
        data = {n: {"caught_by": self.caught_by[n], "date": self.date[n]} for n in names}
        text = json.dumps({"about": ABOUT, "faults": data}, indent=1)
        path.write_text(text + "\n", encoding="utf-8")

    def enter(self, name: str, caught_by: str) -> None:
        """Enter the result of a fault."""
        self.caught_by[name] = caught_by
        self.date[name] = datetime.date.today().isoformat()


ABOUT = "Made by `make mutants`: the first test that failed with each fault; empty if none did."


def summary(faults: Sequence[Fault], caught_by: Mapping[str, str]) -> str:
    """Return the numbers of faults and of caught ones in each area, as Markdown.

    Parameters
    ----------
    faults
        All faults.
    caught_by
        The results; a fault without one is left out.
    """
    tried = [fault for fault in faults if fault.name in caught_by]
    caught = [fault for fault in tried if caught_by[fault.name]]
    share = len(caught) / max(len(tried), 1)
    lines = [
        f"{len(tried)} faults were injected, and {len(caught)} ({share:.1%}) were caught.",
        "",
        "| area | faults | caught |",
        "| --- | --- | --- |",
    ]
    for area in dict.fromkeys(fault.area for fault in tried):
        of_area = [fault for fault in tried if fault.area == area]
        lines.append(f"| {area} | {len(of_area)} | {sum(f in caught for f in of_area)} |")
    return "\n".join(lines)


def fault_list(faults: Sequence[Fault], caught_by: Mapping[str, str]) -> str:
    """Return every fault as Markdown, with the test that caught it; parameters as of `summary`."""
    lines = ["| area | fault | caught by |", "| --- | --- | --- |"]
    for fault in (fault for fault in faults if fault.name in caught_by):
        test = caught_by[fault.name]
        outcome = f"`{_short(test)}`" if test else f"survives. {fault.survives}".strip()
        lines.append(f"| {fault.area} | {fault.why} | {outcome} |")
    return "\n".join(lines)


def with_table(page: str, text: str) -> str:
    """Return a page with the table between its marks.

    Raises
    ------
    ValueError
        If the page has no marks.
    """
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the page lacks the marks {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{text}\n\n{END}{after}"


def _short(test: str) -> str:
    """Return a test without its folder and parameters."""
    if test.startswith("cpp:"):
        return test.removeprefix("cpp:")
    path, _, name = test.partition("::")
    return f"{path.rpartition('/')[2]}::{name.partition('[')[0]}" if name else path
