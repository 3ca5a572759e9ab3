"""Scripts in files, and what their run costs."""

import resource

import pytest

from snowshed import InputError
from snowshed.lua import load_lua


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


def children_seconds():
    """Processor time of the processes that have been waited for, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
