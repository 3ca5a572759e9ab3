"""Results of injected faults: their file, and their tables on pages in docs/develop."""

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
    """Results: the test that caught each fault.

    Attributes
    ----------
    caught_by
        First test that failed, by the name of the fault; empty if no test failed.
    date
        Day on which each fault was tried, by name.
    """

    caught_by: dict[str, str] = field(default_factory=dict)
    date: dict[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path = FILE) -> Results:
        """Return the results in a file, or empty results if there is no file."""
        if not path.is_file():
            return cls()
        data = json.loads(path.read_text(encoding="utf-8"))["faults"]
        return cls(
            {name: fault["caught_by"] for name, fault in data.items()},
            {name: fault["date"] for name, fault in data.items()},
        )

    def write(self, path: Path, faults: Sequence[Fault]) -> None:
        """Write the results to a file, without faults that no longer exist."""
        names = [fault.name for fault in faults if fault.name in self.caught_by]
        data = {n: {"caught_by": self.caught_by[n], "date": self.date[n]} for n in names}
        text = json.dumps({"about": ABOUT, "faults": data}, indent=1)
        path.write_text(text + "\n", encoding="utf-8")

    def enter(self, name: str, caught_by: str) -> None:
        """Record the result of a fault."""
        self.caught_by[name] = caught_by
        self.date[name] = datetime.date.today().isoformat()


ABOUT = "Made by `make mutants`: the first test that failed with each fault; empty if none did."


def summary(faults: Sequence[Fault], caught_by: Mapping[str, str]) -> str:
    """Return a Markdown table of the numbers of all and of caught faults in each area.

    Parameters
    ----------
    faults
        All faults.
    caught_by
        Results; faults without a result are left out.
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
    """Return a Markdown table of faults and the tests that caught them; parameters: `summary`."""
    lines = ["| area | fault | caught by |", "| --- | --- | --- |"]
    for fault in (fault for fault in faults if fault.name in caught_by):
        test = caught_by[fault.name]
        outcome = f"`{_short(test)}`" if test else f"survives. {fault.survives}".strip()
        lines.append(f"| {fault.area} | {fault.why} | {outcome} |")
    return "\n".join(lines)


def with_table(page: str, text: str) -> str:
    """Return a page with a table between its marks.

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
    """Return the name of a test without its folder and parameters."""
    if test.startswith("cpp:"):
        return test.removeprefix("cpp:")
    path, _, name = test.partition("::")
    return f"{path.rpartition('/')[2]}::{name.partition('[')[0]}" if name else path
