"""The page ``docs/trust/thesis-schemes.md``: verdicts on the thesis with each scheme of the MPM.

Its numbers come from the folder ``data``, which holds the claims of the last ``--planar`` with each
scheme; ``python -m reproductions.frischholz2023.schemes_page`` writes it again.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Optional, get_args

import click

from reproductions.common.claims_tables import VERDICTS, claims_csv, read_claims
from reproductions.common.folder import ReproductionFolder
from reproductions.common.hypothesis_tests import JudgedClaim
from reproductions.common.markdown import markdown_table
from reproductions.frischholz2023.claims.scheme_reasons import REASONS
from reproductions.frischholz2023.claims_page import DATA, DOCS, explanation, origin_of_runs
from snowshed._core import InputError
from snowshed.cli.main import main as snowshed
from snowshed.io.atomic import write_text
from snowshed.methods.mpm.settings import Scheme
from snowshed.plot.html_page import HtmlTable
from snowshed.study.store import Store

PAGE = DOCS / "thesis-schemes.md"
COMPUTED_FILE = "claims-planar-computed.json"
THESIS, OBJECTIVE = get_args(Scheme)
#: Beginnings of the sections whose simulations depend on the scheme.
CHAPTERS = ("2", "3", "4", "Table 4")


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder.

    Raises
    ------
    InputError
        If the results are damaged, the two tables list different claims, or a changed verdict has
        no reason.
    """
    pairs = _pairs(data)
    changed = [pair for pair in pairs if len({judged.finding.verdict for judged in pair}) > 1]
    parts = [
        "# The thesis's claims with both schemes",
        "This page is for those who ask which verdicts on the thesis depend on the [scheme]"
        "(../methods/mpm-scheme.md). The simulations of chapters 2 to 4 were made with each: with "
        f"`{THESIS}`, which is the default, and with `{OBJECTIVE}`, whose stacks depend [less on "
        "the cells](stack-grid.md). They are in 2D with the thesis's cells of 1 cm. "
        "[The verdicts in 3D](thesis-claims.md) and those on chapter 5 are for `thesis` only.",
        "```sh\n"
        f"snowshed reproduce frischholz2023 --planar --scheme {OBJECTIVE} \\\n"
        "  --stage lab --stage s-index --stage fixation --stage calibration -o planar\n"
        "```",
        f"Of {len(pairs)} claims, {len(changed)} have another verdict with `{OBJECTIVE}`:",
        markdown_table(_counts_grid(pairs, json.loads((data / COMPUTED_FILE).read_text("utf-8")))),
        "## Claims with another verdict",
        "\n".join(
            explanation(claim, REASONS, "reason", "scheme_reasons.py") for claim, _ in changed
        ),
        markdown_table(_findings_grid(changed)),
        "## Claims with the same verdict",
        markdown_table(_findings_grid([pair for pair in pairs if pair not in changed])),
        "`python -m reproductions.frischholz2023.schemes_page` writes this page from the results "
        "in `reproductions/frischholz2023/data`. Do not edit it by hand.",
    ]
    return "\n\n".join(parts) + "\n"


def keep(folders: Sequence[Path], data: Path = DATA) -> None:
    """Copy the claims from the folders of the two schemes, with the origin of their simulations."""
    origins = {}
    for scheme, folder in zip((THESIS, OBJECTIVE), folders):
        reproduction = ReproductionFolder(folder)
        claims = read_claims(reproduction.claims)
        of_chapters = [claim for claim in claims if claim.source.startswith(CHAPTERS)]
        write_text(_file(data, scheme), claims_csv(of_chapters))
        with Store.open(reproduction.runs) as store:
            origins[scheme] = origin_of_runs(store)
    write_text(data / COMPUTED_FILE, json.dumps(origins) + "\n")


def _file(data: Path, scheme: str) -> Path:
    return data / f"claims-planar-{scheme}.csv"


def _pairs(data: Path) -> list[tuple[JudgedClaim, JudgedClaim]]:
    tables = [read_claims(_file(data, scheme)) for scheme in (THESIS, OBJECTIVE)]
    of_thesis, of_objective = ([(claim.source, claim.text) for claim in table] for table in tables)
    if of_thesis != of_objective:
        raise InputError(f"{data}: the tables of the two schemes list different claims")
    return list(zip(*tables))


def _counts_grid(
    pairs: Sequence[tuple[JudgedClaim, JudgedClaim]], origins: Mapping[str, Mapping[str, object]]
) -> HtmlTable:
    counts = [Counter(judged.finding.verdict for judged in claims) for claims in zip(*pairs)]
    rows = [
        [
            f"`{scheme}`",
            *(str(count[verdict]) for verdict in VERDICTS),
            *(str(origins[scheme][name]) for name in ("runs", "date", "cpu")),
        ]
        for scheme, count in zip((THESIS, OBJECTIVE), counts)
    ]
    return HtmlTable(["scheme", *VERDICTS, "simulations", "date", "processor"], rows, "lrrrrll")


def _findings_grid(pairs: Sequence[tuple[JudgedClaim, JudgedClaim]]) -> HtmlTable:
    rows = [
        [claims[0].source, claims[0].text]
        + [f"{claim.finding.verdict}: {claim.finding.sentence}" for claim in claims]
        for claims in pairs
    ]
    return HtmlTable(["section", "the thesis", f"`{THESIS}`", f"`{OBJECTIVE}`"], rows, "llll")


@click.command()
@click.argument("folders", nargs=2, required=False, type=click.Path(path_type=Path))
def main(folders: Optional[tuple[Path, Path]]) -> None:
    """Write docs/trust/thesis-schemes.md, after taking results, if FOLDERS are given.

    The first folder is for the scheme thesis, the second for objective.
    """
    if folders:
        keep(folders)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(snowshed(command=main, name="python -m reproductions.frischholz2023.schemes_page"))
