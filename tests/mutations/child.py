"""A process that reads mutated files: ``child.py FOLDER TRIES FIRST MEMORY_MB READER...``.

It prints a line of JSON before and after each file, from the FIRST of all readers' files on. A file
that takes too long or too much memory kills the process, and its caller continues after that file.
"""

from __future__ import annotations

import json
import resource
import shutil
import signal
import sys
import warnings
from pathlib import Path

HANG_S = 10.0  # of processor time, which does not depend on the load of the machine
MAX_LENGTH = 20_000  # characters of a message, which the command line cuts


def main() -> None:
    """Read the files."""
    folder, tries, first, memory = Path(sys.argv[1]), *map(int, sys.argv[2:5])
    sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
    from readers import tries_of

    warnings.simplefilter("ignore")
    cases = [(name, seed) for name in sys.argv[5:] for seed in range(tries_of(name, tries))]
    good = None
    for name, seed in cases[first:]:
        if good is None or good.name != name:
            limit_memory(resource.RLIM_INFINITY)
            good = GoodFile(name, folder / name.replace(" ", "-"))
            limit_memory(address_space() + (memory << 20))  # its modules are imported by now
        report(reader=name, seed=seed)
        signal.setitimer(signal.ITIMER_PROF, HANG_S)  # ends the process, also in the core
        outcome = good.outcome(seed)
        signal.setitimer(signal.ITIMER_PROF, 0)
        report(reader=name, seed=seed, outcome=outcome)


def report(**facts: object) -> None:
    print(json.dumps(facts), flush=True)


class GoodFile:
    """A reader with its good file, and the content of that file."""

    def __init__(self, name: str, folder: Path) -> None:
        from readers import READERS

        self.name = name
        self.reader = READERS[name]
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self.file = self.reader.make(folder)
        self.content = self.file.read_bytes()
        self.expected = self.reader.read(self.file)

    def outcome(self, seed: int) -> str:
        """Return the outcome of reading the file with the changes of a seed."""
        from mutate import mutated
        from readers import REFUSED

        content = (self.reader.change or mutated)(self.content, seed)
        self.file.write_bytes(content)
        try:
            content_read = self.reader.read(self.file)
        except REFUSED as error:
            return "refused" if len(str(error)) <= MAX_LENGTH else "LONG MESSAGE"
        except MemoryError:
            return "MEMORY"
        except BaseException as error:
            return f"TRACEBACK {type(error).__name__}: {error}"[:500]
        return "SILENT" if self.reader.exact and content_read != self.expected else "accepted"


def limit_memory(limit: int) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))


def address_space() -> int:
    """Return the address space of this process, bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * resource.getpagesize()


if __name__ == "__main__":
    main()
