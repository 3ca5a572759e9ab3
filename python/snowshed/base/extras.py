"""Optional libraries, imported on first use."""

from __future__ import annotations

import importlib
from typing import Any

from snowshed._core import InputError


def require(module: str, extra: str, purpose: str) -> Any:
    """Import a module of an optional extra.

    Parameters
    ----------
    module
        Name of the module to import.
    extra
        The extra of snowshed that installs it.
    purpose
        Purpose of the import, for the message.

    Raises
    ------
    InputError
        If it is not installed; the message names the package to install.

    Examples
    --------
    >>> require("math", "study", "adding").fsum([1, 2])
    3.0
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        raise InputError(
            f"{purpose} needs {library}, which cannot be imported ({error}); "
            f'install it with: pip install "snowshed[{extra}]"'
        ) from None
