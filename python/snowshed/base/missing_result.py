"""The error for a result that does not exist."""

from snowshed._core import InputError


class MissingResultError(InputError, AttributeError):
    """A result that the method does not have, or that the run did not write.

    It is also an AttributeError, so that `hasattr`, and `getattr` with a default, work on the
    attributes of `snowshed.Results` and `snowshed.Simulation`.
    """
