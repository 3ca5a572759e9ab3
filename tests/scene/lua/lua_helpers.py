"""Scripts in files, and the processor time of their runs."""

import resource

import pytest

from snowshed import InputError
from snowshed.scene import load_lua


def load(folder, init, update=None, **options):
    """Load the scenes of the given texts."""
    files = []
    for name, text in (("init.lua", init), ("update.lua", update)):
        if text is not None:
            (folder / name).write_text(text)
            files.append(folder / name)
    return load_lua(*files, **options)


def error_of(folder, init, update=None, **options):
    """Load, expect it to fail, and return the message without the folder."""
    with pytest.raises(InputError) as caught:
        load(folder, init, update, **options)
    return str(caught.value).replace(f"{folder}/", "")


def error_within(seconds, folder, init, update=None, **options):
    """Return the message of a load that takes less processor time, s, in one of three attempts."""
    for _ in range(3):
        before = children_seconds()
        error = error_of(folder, init, update, **options)
        if children_seconds() - before < seconds:
            return error
    raise AssertionError(f"took {seconds} s or more of processor time, three times")


def children_seconds():
    """Processor time of the processes that have been waited for, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
