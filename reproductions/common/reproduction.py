"""The declaration of a reproduction."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, Optional, Protocol, TypeVar

import click

from reproductions.common.folder import ReproductionFolder
from reproductions.common.hypothesis_tests import Claim
from reproductions.common.section import Section
from reproductions.common.size import Size
from reproductions.common.stage import Stage


class Computation(Protocol):
    """The stages of a reproduction in its folder, and the data that its sections read from them."""

    @property
    def stages(self) -> Sequence[Stage]:
        """All stages, in order."""


Work = TypeVar("Work", bound=Computation)


@dataclass(frozen=True)
class Reproduction(Generic[Work]):
    """The declaration of a reproduction, from which its command and its report are made.

    Attributes
    ----------
    name, alias
        Name of the package and of its command; short name, which the report has, too.
    author
        Name of the publication in texts, such as "the paper".
    title, about, noise
        Title of the report, description of the publication and its reproduction, and origin of the
        noise of the numbers. The last two may hold HTML.
    help, stage_help
        Help texts of the command and of its option ``--stage``.
    sizes
        The sizes; the first is the default.
    stages
        ``stages(folder, settings, **options)`` returns the computation. It writes nothing, and
        raises InputError if an option is wrong.
    claims
        Every claim of the publication that a section may judge, in order.
    sections
        Sections of the report, in order.
    jobs_help
        Help text of ``--jobs``; None: the command has no such option.
    options
        Further options of the command.
    identity, former
        The options that decide the content of a folder, besides the size, and their values in
        folders that do not name them.
    """

    name: str
    alias: str
    author: str
    title: str
    about: str
    noise: str
    help: str
    stage_help: str
    sizes: Sequence[Size[Any]]
    stages: Callable[..., Work]
    claims: Sequence[Claim[Any]]
    sections: Sequence[Section[Work]]
    jobs_help: Optional[str] = None
    options: Sequence[click.Option] = ()
    identity: Sequence[str] = ()
    former: Mapping[str, str] = field(default_factory=dict)

    def size(self, name: str) -> Size[Any]:
        """Return the size with a name."""
        return next(size for size in self.sizes if size.name == name)

    def report(self, folder: Path) -> Path:
        """Return the file of the report."""
        return folder / f"{self.alias}.html"

    def prepare(self, folder: Path, size: str, options: Mapping[str, Any]) -> None:
        """Create a folder, or check it; raises InputError if it holds something else."""
        identity = {"publication": self.alias, "size": size}
        identity.update({name: str(options[name]) for name in self.identity})
        ReproductionFolder(folder).prepare(identity, self.former)
