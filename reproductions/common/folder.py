"""The folder of a reproduction, which names its publication so that no other uses it.

==================== ========================================================================
reproduction.json    the publication, the size and the options of the folder
claims.csv           one row per claim: source, claim, rule, verdict, finding
runs/                the store of all simulations, if the stages are studies
==================== ========================================================================

The report is named after the publication.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object

IDENTITY = "reproduction.json"


@dataclass(frozen=True)
class ReproductionFolder:
    """The files in a reproduction's folder."""

    path: Path

    @property
    def runs(self) -> Path:
        """The store."""
        return self.path / "runs"

    @property
    def claims(self) -> Path:
        """The claims as a table."""
        return self.path / "claims.csv"

    def of_stage(self, name: str) -> Path:
        """Return the folder of a stage's tables and figures."""
        return self.path / name

    def prepare(self, identity: Mapping[str, str], former: Mapping[str, str]) -> None:
        """Create the folder, or check that it belongs to this reproduction.

        Parameters
        ----------
        identity
            Names and values of the options that decide the content of the folder.
        former
            Values of options that older folders do not name.

        Raises
        ------
        InputError
            If the folder holds a reproduction with other options, or something else.
        """
        file = self.path / IDENTITY
        if file.is_file():
            present = {**former, **read_object(file)}
            for name, value in identity.items():
                other = present.get(name)
                if other != value:
                    raise InputError(
                        f"{self.path}: holds a reproduction with {option(name, str(other))}; "
                        f"take a new folder for {option(name, value)}"
                    )
        elif self.path.exists() and (not self.path.is_dir() or any(self.path.iterdir())):
            raise InputError(f"{self.path}: not empty, and holds no reproduction")
        else:
            self.path.mkdir(parents=True, exist_ok=True)
            write_text(file, json.dumps(dict(identity)) + "\n")


def option(name: str, value: str) -> str:
    """Return the spelling of an option; sizes and publications have no value.

    Examples
    --------
    >>> option("size", "full"), option("condition", "slip")
    ('--full', '--condition slip')
    """
    if name == "publication":
        return value
    return f"--{value}" if name == "size" else f"--{name} {value}"
