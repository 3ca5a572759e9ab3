"""Sizes of a reproduction: its extent and its resolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

Settings = TypeVar("Settings")


@dataclass(frozen=True)
class Size(Generic[Settings]):
    """A size that a command offers.

    Attributes
    ----------
    name
        The option without its dashes, such as "quick".
    help
        Help text of the option.
    settings
        Value that the publication's stages receive, such as a resolution.
    caution
        Limits of results of this size, for the report; may hold HTML, may be empty.
    """

    name: str
    help: str
    settings: Settings
    caution: str = ""
