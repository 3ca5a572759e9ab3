"""The page ``docs/trust/thesis-schemes.md``: verdicts on the thesis with each scheme of the MPM.

Its numbers come from the folder ``data``, which holds the claims of the last ``--middle`` (3D) and
``--planar`` (2D) with each scheme; ``python -m reproductions.frischholz2023.schemes_page`` writes
it again. The claims of ``--middle`` with the scheme thesis are those of
`reproductions.frischholz2023.claims_page`.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import get_args

import click

from reproductions.common.claims_tables import VERDICTS, claims_csv, read_claims
from reproductions.common.folder import IDENTITY, ReproductionFolder
from reproductions.common.hypothesis_tests import JudgedClaim
from reproductions.common.markdown import markdown_table
from reproductions.frischholz2023.claims.scheme_reasons import REASONS
from reproductions.frischholz2023.claims_page import (
    CLAIMS_FILE,
    COMPUTED_FILE,
    DATA,
    DOCS,
    explanation,
    origin_of_runs,
)
from snowshed._core import InputError
from snowshed.cli.main import main as snowshed
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object
from snowshed.methods.mpm.settings import Scheme
from snowshed.plot.html_page import HtmlTable
from snowshed.study.store import Store

PAGE = DOCS / "thesis-schemes.md"
ORIGINS_FILE = "schemes-computed.json"
THESIS, OBJECTIVE = get_args(Scheme)
#: Dimension of the simulations by the size of the reproduction.
DIMENSIONS = {"middle": "3D", "planar": "2D"}
#: Size and scheme of the claims that `claims_page` keeps.
OF_CLAIMS_PAGE = ("middle", THESIS)
#: Beginnings of the sections whose simulations depend on the scheme.
CHAPTERS = ("2", "3", "4", "Table 4")
#: A claim with the finding of each scheme.
Pair = tuple[JudgedClaim, JudgedClaim]


def page(data: Path = DATA) -> str:
    """Return the page, from the results in a folder.

    Raises
    ------
    InputError
        If the results are damaged, two tables list different claims, or a changed verdict has no
        reason.
    """
    pairs = {size: _pairs(data, size) for size in DIMENSIONS}
    changed = {size: [pair for pair in pairs[size] if _is_changed(pair)] for size in pairs}
    counts = " and ".join(
        f"in {dimension} {len(changed[size])} of {len(pairs[size])}"
        for size, dimension in DIMENSIONS.items()
    )
    parts = [
        "# The thesis's claims with both schemes",
        "This page is for those who ask which verdicts on the thesis depend on the [scheme]"
        "(../methods/mpm-scheme.md). The simulations of chapters 2 to 4 were made with each: with "
        f"`{THESIS}`, which is the default, and with `{OBJECTIVE}`, whose stacks depend [less on "
        "the cells](stack-grid.md). They have the thesis's cells of 1 cm. The verdicts on chapter "
        f"5 are for `{THESIS}` only.",
        "```sh\n"
        f"snowshed reproduce frischholz2023 --middle --scheme {OBJECTIVE} \\\n"
        "  --stage lab --stage s-index --stage fixation --stage calibration -o spatial\n"
        f"snowshed reproduce frischholz2023 --planar --scheme {OBJECTIVE} \\\n"
        "  --stage lab --stage s-index --stage fixation --stage calibration -o planar\n"
        "```",
        f"Claims that have another verdict with `{OBJECTIVE}`: {counts}.",
        markdown_table(_counts_grid(pairs, _origins(data))),
        *_left_out(data, pairs),
    ]
    for size, dimension in DIMENSIONS.items():
        same = [pair for pair in pairs[size] if pair not in changed[size]]
        parts += [
            f"## Claims with another verdict in {dimension}",
            "\n".join(
                explanation(claim, REASONS[size], "reason", "scheme_reasons.py")
                for claim, _ in changed[size]
            ),
            markdown_table(_findings_grid(changed[size])),
            f"## Claims with the same verdict in {dimension}",
            markdown_table(_findings_grid(same)),
        ]
    parts.append(
        "`python -m reproductions.frischholz2023.schemes_page` writes this page from the results "
        "in `reproductions/frischholz2023/data`. Do not edit it by hand."
    )
    return "\n\n".join(parts) + "\n"


def keep(folder: Path, data: Path = DATA) -> None:
    """Copy the claims from the folder of a reproduction, with the origin of its simulations.

    Raises
    ------
    InputError
        If the folder holds another reproduction.
    """
    identity = read_object(folder / IDENTITY)
    size, scheme = str(identity.get("size")), str(identity.get("scheme"))
    if size not in DIMENSIONS or (size, scheme) == OF_CLAIMS_PAGE:
        raise InputError(
            f"{folder}: holds --{size} with the scheme {scheme}; allowed: --planar, and --middle "
            f"with the scheme {OBJECTIVE}"
        )
    reproduction = ReproductionFolder(folder)
    claims = read_claims(reproduction.claims)
    of_chapters = [claim for claim in claims if claim.source.startswith(CHAPTERS)]
    write_text(_file(data, size, scheme), claims_csv(of_chapters))
    file = data / ORIGINS_FILE
    origins = read_object(file) if file.is_file() else {}
    with Store.open(reproduction.runs) as store:
        origins[f"{size}-{scheme}"] = origin_of_runs(store)
    write_text(file, json.dumps(origins) + "\n")


def _file(data: Path, size: str, scheme: str) -> Path:
    if (size, scheme) == OF_CLAIMS_PAGE:
        return data / CLAIMS_FILE
    return data / f"claims-{size}-{scheme}.csv"


def _claims(data: Path, size: str, scheme: str) -> list[JudgedClaim]:
    """Return the claims of the chapters whose simulations depend on the scheme."""
    claims = read_claims(_file(data, size, scheme))
    return [claim for claim in claims if claim.source.startswith(CHAPTERS)]


def _pairs(data: Path, size: str) -> list[Pair]:
    """Return the claims that were judged with both schemes."""
    of_thesis = {(claim.source, claim.text): claim for claim in _claims(data, size, THESIS)}
    of_objective = _claims(data, size, OBJECTIVE)
    if not {(claim.source, claim.text) for claim in of_objective} <= set(of_thesis):
        raise InputError(f"{data}: the tables of the two schemes list different claims")
    return [(of_thesis[claim.source, claim.text], claim) for claim in of_objective]


def _is_changed(pair: Pair) -> bool:
    return pair[0].finding.verdict != pair[1].finding.verdict


def _left_out(data: Path, pairs: Mapping[str, Sequence[Pair]]) -> list[str]:
    """Return a paragraph for each dimension in which claims were not judged with both schemes."""
    paragraphs = []
    for size, dimension in DIMENSIONS.items():
        judged = [of_thesis for of_thesis, _ in pairs[size]]
        missing = [claim for claim in _claims(data, size, THESIS) if claim not in judged]
        if missing:
            texts = "; ".join(f"{claim.text} ({claim.source})" for claim in missing)
            paragraphs.append(f"Not computed in {dimension} with `{OBJECTIVE}`: {texts}")
    return paragraphs


def _origins(data: Path) -> Mapping[str, Mapping[str, object]]:
    of_thesis = read_object(data / COMPUTED_FILE)
    return {"-".join(OF_CLAIMS_PAGE): of_thesis, **read_object(data / ORIGINS_FILE)}


def _counts_grid(
    pairs: Mapping[str, Sequence[Pair]], origins: Mapping[str, Mapping[str, object]]
) -> HtmlTable:
    rows = []
    for size, dimension in DIMENSIONS.items():
        for k, scheme in enumerate((THESIS, OBJECTIVE)):
            count = Counter(pair[k].finding.verdict for pair in pairs[size])
            origin = origins[f"{size}-{scheme}"]
            rows.append(
                [f"`{scheme}`, {dimension}"]
                + [str(count[verdict]) for verdict in VERDICTS]
                + [str(origin[name]) for name in ("runs", "date", "cpu")]
            )
    return HtmlTable(["scheme", *VERDICTS, "simulations", "date", "processor"], rows, "lrrrrll")


def _findings_grid(pairs: Sequence[Pair]) -> HtmlTable:
    rows = [
        [claims[0].source, claims[0].text]
        + [f"{claim.finding.verdict}: {claim.finding.sentence}" for claim in claims]
        for claims in pairs
    ]
    return HtmlTable(["section", "the thesis", f"`{THESIS}`", f"`{OBJECTIVE}`"], rows, "llll")


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
def main(folders: tuple[Path, ...]) -> None:
    """Write docs/trust/thesis-schemes.md, after taking results, if FOLDERS are given."""
    for folder in folders:
        keep(folder)
    write_text(PAGE, page())


if __name__ == "__main__":
    sys.exit(snowshed(command=main, name="python -m reproductions.frischholz2023.schemes_page"))
