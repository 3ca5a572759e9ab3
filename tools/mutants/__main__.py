"""Inject faults one at a time, and run tests until one fails: ``python -m tools.mutants``."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from tools.mutants.faults import Fault, FaultError, check_places, read_faults
from tools.mutants.results import FILE, Results, fault_list, summary, with_table
from tools.mutants.sources import SourceCopy
from tools.mutants.trial import BuildError, Workshop

ROOT = Path(__file__).parents[2]
#: Pages that contain tables of the results.
PAGES = {
    ROOT / "docs/develop/injected-faults.md": summary,
    ROOT / "docs/develop/list-of-faults.md": fault_list,
}
FOLDER = ROOT / "build/mutants"
TARGETS = ("snowshed_tests", "_core", "snowshed-run")


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if all faults were caught or are known to survive, 1 if not, 2 after an error."""
    options = _parser().parse_args(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # restore the copy, as after Ctrl-C
    try:
        faults = read_faults()
        check_places(faults, ROOT)
        results = Results.read()
        chosen = _select_faults(faults, options, results)
        if options.list:
            print("\n".join(f"{fault.area}: {fault.name}: {fault.why}" for fault in chosen))
            return 0
        if not options.table:
            _run(chosen, faults)
            results = Results.read()
        for page, table_of in PAGES.items():
            text = with_table(page.read_text(encoding="utf-8"), table_of(faults, results.caught_by))
            page.write_text(text, encoding="utf-8")
    except (FaultError, BuildError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    survivors = [f for f in chosen if not results.caught_by.get(f.name) and not f.survives]
    for fault in survivors:
        print(f"survives: {fault.name}: {fault.why}", file=sys.stderr)
    return 1 if survivors else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.mutants", description=__doc__)
    parser.add_argument("faults", nargs="*", help="names of faults or areas; default: all")
    parser.add_argument("--missing", action="store_true", help="only faults without a result")
    parser.add_argument("--survivors", action="store_true", help="only faults that survived")
    parser.add_argument("--list", action="store_true", help="list the faults and stop")
    parser.add_argument("--table", action="store_true", help="only write the tables")
    return parser


def _select_faults(
    faults: Sequence[Fault], options: argparse.Namespace, results: Results
) -> list[Fault]:
    known = {fault.name for fault in faults} | {fault.area for fault in faults}
    for name in options.faults:
        if name not in known:
            raise FaultError(f"there is no fault or area {name!r}")
    return [
        fault
        for fault in faults
        if (not options.faults or fault.name in options.faults or fault.area in options.faults)
        and not (options.missing and fault.name in results.caught_by)
        and not (options.survivors and results.caught_by.get(fault.name) != "")
    ]


def _run(chosen: Sequence[Fault], faults: Sequence[Fault]) -> None:
    """Try the faults; faults that need no compiler and faults with a switch come first."""
    copy = SourceCopy(ROOT, FOLDER / "source", faults)
    workshop = Workshop(FOLDER, FOLDER / "source")
    copy.update()
    workshop.prepare()
    print("Building without a fault", flush=True)
    workshop.build(*TARGETS)
    ordered = sorted(chosen, key=lambda fault: fault.is_cpp and not fault.switch)
    sound: set[str] = set()
    for number, fault in enumerate(ordered, 1):
        caught_by = _try(copy, workshop, fault)
        if fault.is_cpp and not fault.switch:
            workshop.build(*TARGETS)  # the program without faults
        if caught_by:
            _require_sound(workshop, caught_by, sound)
        results = Results.read()  # another run may have written meanwhile
        results.enter(fault.name, caught_by)
        results.write(FILE, faults)
        print(f"{number}/{len(ordered)} {fault.name}: {caught_by or 'SURVIVES'}", flush=True)


def _require_sound(workshop: Workshop, test: str, sound: set[str]) -> None:
    """Raise BuildError if a test fails without a fault, because such a test shows nothing."""
    test = test.partition(" (")[0]
    if test not in sound and workshop.first_failure([test]):
        raise BuildError(f"{test} fails without any fault")
    sound.add(test)


def _try(copy: SourceCopy, workshop: Workshop, fault: Fault) -> str:
    if fault.switch:
        return workshop.first_failure(fault.tests, copy.numbers[fault.name])
    with copy.inject(fault):
        if fault.is_cpp:
            workshop.build(*TARGETS)
        return workshop.first_failure(fault.tests)


if __name__ == "__main__":
    sys.exit(main())
